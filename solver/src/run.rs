//! The environment of a solve: threads, stop signal, observer.

pub mod contradiction;
pub mod pool;
pub mod progress;
mod sharing;
pub mod stop;
