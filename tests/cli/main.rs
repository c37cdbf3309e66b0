//! The command line as a caller sees it: exit codes, documents, messages.

mod certify;
mod export;
mod files;
mod gallery;
mod importing;
mod invalid;
mod legs;
mod merging;
mod plot;
mod refusals;
mod run;
mod slew;
mod solve;
mod stopping;
mod study;
mod validate;
mod verify;
