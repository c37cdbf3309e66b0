//! What the solver's work costs, part by part, on one thread: `cargo bench -p slewplan-solver`.
//!
//! An argument keeps the benchmarks whose names contain it. All spacecraft are that of the published
//! scheduling experiments.

mod bound;
mod checker;
mod legs;
mod orders;

fn main() {
    divan::main();
}
