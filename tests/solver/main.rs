//! What the solver promises, through its public interface only.

mod arrays;
mod infeasible;
mod invariance;
mod oracle;
mod published;
mod stopping;
mod structure;
