//! What several wheels can do together.

pub mod allocation;
pub mod array;
pub mod envelope;
