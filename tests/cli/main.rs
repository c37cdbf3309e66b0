//! The command line from outside: exit codes, documents, messages.

mod certify;
mod clock;
mod convert;
mod export;
mod files;
mod gallery;
mod importing;
mod init;
mod invalid;
mod keep_out;
mod keys;
mod kinds;
mod labels;
mod legs;
mod merging;
mod plot;
mod pointing;
mod refusals;
mod run;
mod slew;
mod solve;
mod stopping;
mod study;
mod texts;
mod validate;
mod verify;
