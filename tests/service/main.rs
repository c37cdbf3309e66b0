//! The service from outside: every route with its success and its errors.

mod best_so_far;
mod client;
mod connections;
mod copies;
mod durability;
mod events;
mod examples;
mod export;
#[cfg(feature = "faults")]
mod faults;
mod health;
mod idempotency;
mod imports;
mod keys;
mod leg_tables;
mod legs;
mod operations;
mod origins;
mod page;
mod plans;
mod pointing;
#[path = "../postgres.rs"]
mod postgres;
mod priorities;
mod refusals;
mod roles;
mod running;
mod scenario;
mod several;
mod side_by_side;
mod slews;
mod spacecraft;
mod spreading;
mod studies;
mod tls;
mod verify;
