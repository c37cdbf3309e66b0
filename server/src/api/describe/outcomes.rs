//! Errors that many routes can answer with.

use super::super::error::{PROBLEM_JSON, ProblemDetails};
use std::collections::BTreeMap;
use utoipa::openapi::{ContentBuilder, Ref, RefOr, Response, ResponseBuilder};
use utoipa::{IntoResponses, ToSchema};

fn problems(list: &[(&str, &str)]) -> BTreeMap<String, RefOr<Response>> {
    let response = |text: &str| {
        let schema = Ref::from_schema_name(ProblemDetails::name());
        ResponseBuilder::new()
            .description(text)
            .content(
                PROBLEM_JSON,
                ContentBuilder::new().schema(Some(schema)).build(),
            )
            .build()
    };
    list.iter()
        .map(|(status, text)| ((*status).to_owned(), response(text).into()))
        .collect()
}

macro_rules! outcomes {
    ($($(#[$doc:meta])+ $name:ident = [$(($status:literal, $text:literal)),+];)+) => {
        $(
            $(#[$doc])+
            pub(in crate::api) struct $name;

            impl IntoResponses for $name {
                fn responses() -> BTreeMap<String, RefOr<Response>> {
                    problems(&[$(($status, $text)),+])
                }
            }
        )+
    };
}

outcomes! {
    /// Whatever takes a body.
    BodyErrors = [
        ("400", "Malformed JSON, parameter or header"),
        ("404", "Not found"),
        ("408", "The body did not arrive in time"),
        ("413", "Too large; the detail names the limit"),
        ("415", "The body is not JSON, or is compressed"),
        ("422", "Not valid; errors lists everything that is wrong")
    ];
    /// Whatever takes parameters.
    ParameterErrors = [("400", "A parameter or header is not valid")];
    /// Whatever names one thing.
    NotFound = [("404", "Not found")];
    /// Whatever makes a job.
    QuotaErrors = [("429", "Too many jobs of this client wait; Retry-After says when to come again")];
    /// Whatever depends on the state of a job.
    Conflict = [("409", "The state of the job does not allow it")];
    /// Everything that needs the database, which is everything that needs a key.
    ServerErrors = [
        ("401", "A key is needed (where keys are asked for)"),
        ("403", "The key has not the scope, or the request comes under a foreign name or from a page of \
            another site"),
        ("500", "An internal error; the log has its cause"),
        ("503", "Busy or full; Retry-After says when to come again"),
        ("507", "The disk is full")
    ];
}
