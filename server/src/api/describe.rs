//! What the documents look like, for the description of the interface.
//!
//! Inputs are read by hand, so that every problem is found at once; the types here only describe
//! them. That they describe what is read is tested from outside: the examples are posted, and a
//! fuzzer generates requests from the description.

mod examples;
mod inputs;
mod leg_file;
mod outcomes;
mod slews;
mod studies;

pub(super) use examples::{
    authority_study, comparison_study, effort_sweep, envelope_study, experiment_a, flight_study,
    leg_file, leg_matrix, leg_pair, quarter_slew, spacecraft, two_targets, verify_request,
};
pub(super) use inputs::{LegQueryBody, Scenario, Spacecraft, VerifyBody};
pub(super) use leg_file::LegFileBody;
pub(super) use outcomes::{
    BodyErrors, Conflict, NotFound, ParameterErrors, QuotaErrors, ServerErrors,
};
pub(super) use slews::SlewBody;
pub(super) use studies::{AuthorityBody, ComparisonBody, EnvelopeBody, FlightBody};
