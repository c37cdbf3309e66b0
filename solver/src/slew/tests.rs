//! Slews with published results, combinations without any, and the derivatives of their programs.

mod allocation;
mod cones;
mod craft;
mod derivatives;
mod drifting;
mod effort;
mod energy;
mod evidence;
mod sampled;
mod variety;
