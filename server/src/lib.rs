//! The `slewplan` program: multi-target attitude scheduling as a command and as a service.
//!
//! A library, so that it compiles beside the solver and not after it; the program itself adds an
//! allocator and nothing else.

mod api;
mod base;
mod cli;
mod documents;
mod jobs;
mod render;
mod service;
mod store;

pub use cli::run;
