//! Answers for other tools and for people: formats, drawings, text.

pub(crate) mod export;
pub(crate) mod leg_table;
pub(crate) mod plot;
pub(crate) mod report;
