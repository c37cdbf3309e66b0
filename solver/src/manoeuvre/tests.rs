//! Manoeuvres with published answers, and the derivatives of their programs.

mod craft;
mod derivatives;
mod effort;
mod energy;
mod evidence;
mod sampled;
mod variety;
