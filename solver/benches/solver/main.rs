//! Time of the solver's parts on one thread: `cargo bench -p slewplan-solver`.
//!
//! An argument selects the benchmarks whose names contain it. The spacecraft is always that of the
//! published scheduling experiments.

mod bound;
mod checker;
mod legs;
mod orders;

fn main() {
    divan::main();
}
