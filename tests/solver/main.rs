//! Behaviour of the solver through its public interface.

mod arrays;
mod boundaries;
mod certified;
mod closed_loop;
mod envelopes;
mod fixed_order;
mod imported;
mod infeasible;
mod invariance;
mod leg_minima;
mod memory;
mod oracle;
mod order_rules;
mod ordinary;
mod orienteering;
mod pointing;
mod published;
mod pyramid;
mod random_suite;
mod resumed;
mod standing;
mod stopping;
mod tight;
mod tolerances;
mod windows;
