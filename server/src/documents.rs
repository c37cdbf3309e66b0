//! JSON at the border of the program: documents in, documents out, no decisions.
//!
//! Reading goes in two steps, so that every problem is found at once: [`document`] turns text
//! into a tree that loses nothing, and a [`reader`] walks the tree, knows where it is and
//! collects what is wrong. What stands in a document is declared once, with
//! [`slewplan_solver::model::input`]; [`schema`] makes its description of that. Writing is plain `serde` on structs whose fields carry their units.

#[cfg(test)]
mod attitude;
pub(crate) mod certification;
pub(crate) mod claims;
pub(crate) mod document;
pub(crate) mod field_page;
pub(crate) mod flight;
pub(crate) mod jobs;
pub(crate) mod kind;
pub(crate) mod leg_import;
pub(crate) mod leg_query;
pub(crate) mod leg_rows;
pub(crate) mod leg_table_jobs;
pub(crate) mod legs;
#[cfg(test)]
mod mutations;
pub(crate) mod number;
pub(crate) mod plan;
pub(crate) mod problems;
pub(crate) mod reader;
pub(crate) mod scenario;
pub(crate) mod schema;
pub(crate) mod shards;
pub(crate) mod slew;
pub(crate) mod spacecraft;
pub(crate) mod stored_legs;
pub(crate) mod study;
pub(crate) mod target_table;
#[cfg(test)]
mod unknown_members;
pub(crate) mod verification;
