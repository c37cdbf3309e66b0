//! `GET /v1/plans/{id}/result`: the plan.

use super::super::App;
use super::super::describe::{NotFound, ParameterErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode, ErrorDocument};
use super::super::extract::{Named, Parameters, header_text};
use super::super::respond;
use crate::store::{JobState, ResultRow};
use crate::wire::csv;
use crate::wire::plan::PlanDocument;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderName, HeaderValue, header};
use axum::response::Response;
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};

const JOB_STATE: HeaderName = HeaderName::from_static("job-state");
/// Time after which a first plan is worth asking for again, s.
const RETRY_S: u32 = 1;

/// Parameters of a result.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::http) struct Query {
    /// Form of the result; without it `Accept` decides.
    #[param(inline)]
    format: Option<Format>,
}

/// The form of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub(in crate::http) enum Format {
    /// The whole plan.
    Json,
    /// The sampled trajectory, one row per state.
    Csv,
}

/// Read the plan of a job: the final one, or the best so far
///
/// While a job goes on this is the best plan that it has found: complete, verified, `feasible`,
/// with the bound of the moment when it was found (the job has the newest). Every better plan has
/// another `ETag`, and so has the one that the job ends with. `Job-State` tells whether it has
/// ended. After a restart of the service the best plan so far stays until there is a better one.
#[utoipa::path(
    get, path = "/v1/plans/{id}/result", tag = "plans", operation_id = "get_result",
    params(
        ("id" = String, Path, format = "uuid", description = "Identifier of the job"),
        Query,
        ("If-None-Match" = Option<String>, Header,
            description = "Entity tags that are known already"),
    ),
    responses(
        (status = 200, description = "The plan, or why there is none",
            content((PlanDocument<'static> = "application/json"), (String = "text/csv")),
            headers(
                ("ETag" = String, description = "Hash of the content"),
                ("Job-State" = inline(JobState),
                    description = "`queued` or `running`: not final, a better plan may follow"),
            )),
        (status = 304, description = "Not changed"),
        (status = 406, description = "No accepted form", body = ErrorDocument<'static>,
            content_type = "application/problem+json"),
        (status = 409, description = "No plan yet (`result_not_ready`), or none at all (`no_result`)",
            body = ErrorDocument<'static>, content_type = "application/problem+json",
            headers(("Retry-After" = u32, description = "When to come again, s, if no plan yet"))),
        ParameterErrors, NotFound, ServerErrors,
    ),
)]
pub(in crate::http) async fn handler(
    State(app): State<App>,
    Named(id): Named,
    Parameters(query): Parameters<Query>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    let found = app.store().result(&id).await?;
    let (state, result) = found.ok_or_else(|| ApiError::not_found("plan", &id))?;
    let format = query.format.or_else(|| accepted(&headers)).ok_or_else(|| {
        ApiError::new(
            ErrorCode::NotAcceptable,
            "there is application/json and text/csv",
        )
    })?;
    let Some(result) = result else {
        return Err(if state.is_final() {
            let detail = format!("the job ended {}", state.as_str());
            ApiError::new(ErrorCode::NoResult, detail)
        } else {
            let detail = "no plan has been found so far; follow the events";
            ApiError::new(ErrorCode::ResultNotReady, detail).retry_after(RETRY_S)
        });
    };
    let mut response = match format {
        Format::Json => json(&result),
        Format::Csv => table(&result)?,
    };
    let known = header_text(&headers, "if-none-match")?.unwrap_or("");
    response = respond::unless_known(known, response);
    let state = HeaderValue::from_static(state.as_str());
    response.headers_mut().insert(JOB_STATE, state);
    Ok(response)
}

/// The plan as it was stored.
pub(super) fn json(result: &ResultRow) -> Response {
    respond::tagged("application/json", &result.digest, result.document.clone())
}

fn table(result: &ResultRow) -> Result<Response, ApiError> {
    let table = csv::table_of_document(&result.document).map_err(|error| {
        tracing::error!(%error, "a stored plan cannot be read");
        ApiError::new(ErrorCode::Internal, "the stored plan cannot be read")
    })?;
    let text = table.ok_or_else(|| {
        ApiError::new(
            ErrorCode::NoResult,
            "there is no plan and so no trajectory; see the JSON",
        )
    })?;
    Ok(respond::tagged(
        "text/csv; charset=utf-8",
        &format!("{}-csv", result.digest),
        text.into(),
    ))
}

/// The form that `Accept` likes best, JSON among equals; `None` when it likes neither.
fn accepted(headers: &HeaderMap) -> Option<Format> {
    let mut ranges = headers
        .get_all(header::ACCEPT)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .map(range)
        .peekable();
    if ranges.peek().is_none() {
        return Some(Format::Json);
    }
    let ranges: Vec<(String, f64)> = ranges.collect();
    let liking = |form: &str, group: &str| {
        // The most specific range that matches decides.
        [form, group, "*/*"]
            .iter()
            .find_map(|name| ranges.iter().find(|(range, _)| range == name))
            .map_or(0.0, |(_, weight)| *weight)
    };
    let (json, csv) = (
        liking("application/json", "application/*"),
        liking("text/csv", "text/*"),
    );
    match (json > 0.0 || csv > 0.0, csv > json) {
        (false, _) => None,
        (true, false) => Some(Format::Json),
        (true, true) => Some(Format::Csv),
    }
}

fn range(text: &str) -> (String, f64) {
    let mut parts = text.split(';').map(str::trim);
    let name = parts.next().unwrap_or("").to_ascii_lowercase();
    let weight = parts
        .find_map(|part| part.strip_prefix("q="))
        .map_or(1.0, |weight| weight.parse().unwrap_or(0.0));
    (name, weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_form_that_is_liked_best_is_chosen() {
        let cases = [
            ("*/*", Some(Format::Json)),
            ("text/csv", Some(Format::Csv)),
            ("text/*;q=0.5, application/json;q=0.4", Some(Format::Csv)),
            ("text/csv;q=0, */*", Some(Format::Json)),
            ("image/png", None),
        ];
        for (accept, expected) in cases {
            let mut headers = HeaderMap::new();
            headers.insert(header::ACCEPT, HeaderValue::from_static(accept));
            assert_eq!(accepted(&headers), expected, "{accept}");
        }
        assert_eq!(accepted(&HeaderMap::new()), Some(Format::Json));
    }
}
