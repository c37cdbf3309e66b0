//! What accompanies a solve: threads, the signal to stop, the observer.

pub mod contradiction;
pub mod pool;
pub mod progress;
pub mod stop;
