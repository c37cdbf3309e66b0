//! The command line as a caller sees it: exit codes, documents, messages.

mod certify;
mod files;
mod invalid;
mod legs;
mod refusals;
mod run;
mod solve;
mod stopping;
mod validate;
mod verify;
