//! What the documents look like, for the description of the interface.
//!
//! What callers write is declared where it is read ([`crate::documents`]). That the description fits
//! is tested from outside: the examples are posted, and a fuzzer generates requests from it.

mod examples;
mod inputs;
mod outcomes;
mod yaml;

pub(super) use examples::{
    authority_study, comparison_study, effort_sweep, envelope_study, experiment_a, flight_study,
    leg_file, leg_matrix, leg_pair, quarter_slew, spacecraft, two_targets, verify_request,
};
pub(super) use inputs::{
    AuthorityBody, ComparisonBody, EnvelopeBody, FlightBody, LegFileBody, LegQueryBody, Scenario,
    SlewBody, Spacecraft, VerifyBody,
};
pub(super) use outcomes::{
    BodyErrors, Conflict, NotFound, ParameterErrors, QuotaErrors, ServerErrors,
};
pub(super) use yaml::yaml;
