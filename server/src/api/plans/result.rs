//! `GET /v1/plans/{id}/result`: the plan of a job.

use super::super::describe::{NotFound, ParameterErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode, ProblemDetails};
use super::super::extract::{Named, Parameters, header_text};
use super::super::jobs::{self, JOB_STATE};
use super::super::{App, computing, respond};
use super::forms::{self, accepted};
use crate::base::digest;
use crate::documents;
use crate::documents::plan::PlanDocument;
use crate::render::export::{self, ExportError, ExportOptions, Form, Format, Spacing};
use crate::store::{JobState, ResultRow};
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::Response;
use serde::Deserialize;
use slewplan_solver::model::problem::Problem;
use utoipa::IntoParams;

/// Maximum number of samples of an answer: about 80 MB of XML.
const MAX_SAMPLES: usize = 200_000;

/// Parameters of a result.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct ResultQuery {
    /// Form of the result; without it `Accept` decides.
    #[param(schema_with = forms::described)]
    format: Option<Form>,
    /// Not for `json` or `open-mct`: sample at multiples of this time, s, and at every switch; the
    /// period of `wheel-rpm` (0.1 by default).
    #[param(minimum = 0.001, maximum = 1e6)]
    step_s: Option<f64>,
    /// Not for `json`, `open-mct` or `wheel-rpm`: sample so that linear interpolation is within
    /// this angle, rad, and rates within the same, rad/s (1e-5 by default).
    #[param(minimum = 1e-9, maximum = 1)]
    tolerance: Option<f64>,
    /// `false` leaves body rates out of `aem-kvn`, `aem-xml` and `stk`.
    rates: Option<bool>,
    /// For `wheel-rpm`: commands of this wheel only, counted from 0.
    wheel: Option<u32>,
    /// For `aem-kvn` and `aem-xml`: name of the spacecraft.
    object_name: Option<String>,
    /// For `aem-kvn` and `aem-xml`: international designator of the spacecraft.
    object_id: Option<String>,
}

impl ResultQuery {
    fn options(&self) -> Result<ExportOptions, ApiError> {
        let wrong = |name: &str, what: &str| {
            ApiError::new(ErrorCode::InvalidParameter, format!("{name}: {what}"))
        };
        let spacing = match (self.step_s, self.tolerance) {
            (Some(_), Some(_)) => {
                return Err(wrong("step_s", "it and tolerance exclude each other"));
            }
            (Some(step), None) => {
                let step = Spacing::checked_step(step).map_err(|what| wrong("step_s", what))?;
                Some(Spacing::Step(step))
            }
            (None, Some(tolerance)) => {
                let tolerance = Spacing::checked_tolerance(tolerance)
                    .map_err(|what| wrong("tolerance", what))?;
                Some(Spacing::Tolerance(tolerance))
            }
            (None, None) => None,
        };
        Ok(ExportOptions {
            spacing,
            rates: self.rates.unwrap_or(true),
            wheel: self.wheel.map(|wheel| wheel as usize),
            object_name: self.object_name.clone(),
            object_id: self.object_id.clone(),
            ..ExportOptions::new(MAX_SAMPLES)
        })
    }

    fn chooses(&self) -> bool {
        self.step_s.is_some()
            || self.tolerance.is_some()
            || self.rates.is_some()
            || self.wheel.is_some()
            || self.object_name.is_some()
            || self.object_id.is_some()
    }
}

/// Read the plan of a job: the final one, or the best so far
///
/// While a job runs this is the best plan that it has found: complete, verified, `feasible`, with
/// the bound of the moment when it was found (the job has the newest). Every better plan has
/// another `ETag`, and so has the final one. `Job-State` is the state of the job. The best plan so
/// far survives a restart of the service until there is a better one. It stays when the job ends
/// without a plan (`failed`, `dead`), whose `detail` and `code` give the reason.
///
/// Exports to other tools sample the flight; all parameters but `format` are for these.
#[utoipa::path(
    get, path = "/v1/plans/{id}/result", tag = "plans", operation_id = "get_result",
    params(
        ("id" = String, Path, format = "uuid", description = "Identifier of the job"),
        ResultQuery,
        ("If-None-Match" = Option<String>, Header,
            description = "Entity tags that are known already"),
    ),
    responses(
        (status = 200, description = "The plan, or why there is none",
            content(
                (PlanDocument<'static> = "application/json"),
                (String = "text/csv"),
                (String = "text/x.ccsds.aem.kvn"),
                (String = "application/x.ccsds.aem+xml"),
                (String = "text/x.basilisk.waypoints"),
                (Object = "application/x.open-mct.plan+json"),
                (String = "text/x.stk.attitude"),
                (String = "text/tab-separated-values"),
            ),
            headers(
                ("ETag" = String, description = "Hash of the content"),
                ("Job-State" = inline(JobState),
                    description = "`queued` or `running`: not final, a better plan may follow"),
                ("Content-Disposition" = Option<String>,
                    description = "A name for the file, in the formats of other tools"),
            )),
        (status = 304, description = "Not changed"),
        (status = 406, description = "No accepted form", body = ProblemDetails<'static>,
            content_type = "application/problem+json"),
        (status = 422, description = "A form that cannot say what the scenario's epoch, time system \
            or frame is (`not_exportable`); the detail tells which", body = ProblemDetails<'static>,
            content_type = "application/problem+json"),
        (status = 409, description = "No plan yet (`result_not_ready`), or none at all (`no_result`)",
            body = ProblemDetails<'static>, content_type = "application/problem+json",
            headers(("Retry-After" = u32, description = "When to come again, s, if no plan yet"))),
        ParameterErrors, NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
    Parameters(query): Parameters<ResultQuery>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    let found = app.store().result(&id).await?;
    let (state, result) = found.ok_or_else(|| ApiError::not_found("plan", &id))?;
    let form = query.format.or_else(|| accepted(&headers)).ok_or_else(|| {
        let detail = format!("there is {}", Form::ALL.map(Form::media_type).join(", "));
        ApiError::new(ErrorCode::NotAcceptable, detail)
    })?;
    let options = query.options()?;
    if form == Form::Json && query.chooses() {
        let detail = "json leaves no choice of samples, rates, wheel or object";
        return Err(ApiError::new(ErrorCode::InvalidParameter, detail));
    }
    let Some(result) = result else {
        let not_ready = "no plan has been found so far; follow the events";
        return Err(jobs::no_result(state, not_ready));
    };
    let tag = match form {
        Form::Json => result.digest.clone(),
        Form::Export(format) => format!("{}-{}", result.digest, choices(format, &options)),
    };
    let known = header_text(&headers, "if-none-match")?.unwrap_or("");
    let mut response = match (respond::unless_made(known, &tag), form) {
        (Some(unchanged), _) => unchanged,
        (None, Form::Json) => json(&result),
        (None, Form::Export(format)) => exported(&app, &id, &tag, &result, format, options).await?,
    };
    let state = HeaderValue::from_static(state.into_str());
    response.headers_mut().insert(JOB_STATE, state);
    Ok(response)
}

/// The stored plan.
pub(super) fn json(result: &ResultRow) -> Response {
    respond::tagged("application/json", &result.digest, result.document.clone())
}

/// The plan in the format of another tool.
async fn exported(
    app: &App,
    id: &str,
    tag: &str,
    result: &ResultRow,
    format: Format,
    options: ExportOptions,
) -> Result<Response, ApiError> {
    let found = app.store().scenario(id).await?;
    let (scenario, created_us) = found.ok_or_else(|| ApiError::not_found("plan", id))?;
    // The time of the submission rather than of the request, so that the same plan has the same
    // bytes and tag.
    let options = ExportOptions {
        created_us,
        ..options
    };
    let document = result.document.clone();
    // On other threads, because a long flight takes long to integrate.
    let work = move || write(format, &scenario, &document, &options);
    let text = computing::integrated(&app.0.integrating, work).await??;
    let kind = format.media_type();
    // XML and JSON need no charset parameter.
    let kind = match format {
        Format::AemXml | Format::OpenMct => kind.to_owned(),
        _ => format!("{kind}; charset=utf-8"),
    };
    let mut response = respond::tagged(&kind, tag, text.into());
    let name = format!("attachment; filename=\"{id}.{}\"", format.extension());
    if let Ok(name) = HeaderValue::from_str(&name) {
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_DISPOSITION, name);
    }
    Ok(response)
}

/// Everything that an export depends on besides the plan, for its tag.
fn choices(format: Format, options: &ExportOptions) -> String {
    let said = format!(
        "{:?}",
        (
            options.spacing,
            options.rates,
            options.wheel,
            &options.object_name,
            &options.object_id
        )
    );
    format!("{}-{}", format.name(), &digest::hex(said.as_bytes())[..8])
}

fn write(
    format: Format,
    scenario: &[u8],
    plan: &[u8],
    options: &ExportOptions,
) -> Result<String, ApiError> {
    let valid = documents::scenario::read(scenario, None).map_err(outdated)?;
    let scenario = &valid.scenario;
    let Some(flight) =
        documents::flight::read_written(plan, scenario).map_err(|why| unreadable(&why))?
    else {
        let detail = "there is no plan and so no trajectory; see the JSON";
        return Err(ApiError::new(ErrorCode::NoResult, detail));
    };
    export::write(format, scenario, &flight, options).map_err(|error| match error {
        ExportError::Choice(what) => ApiError::new(ErrorCode::InvalidParameter, what),
        ExportError::Label { .. } => ApiError::new(ErrorCode::NotExportable, error.to_string()),
        ExportError::NotFlown(_) | ExportError::NotFinite => unreadable(&error),
    })
}

/// A stored scenario that was valid when it was accepted, but not for this version of the program.
fn outdated(problems: Vec<Problem>) -> ApiError {
    let detail = match problems.first() {
        Some(first) => format!("{} of the scenario: {}", first.pointer, first.message),
        None => "the scenario is not valid".to_owned(),
    };
    ApiError::new(ErrorCode::NotExportable, detail).with_problems(problems)
}

fn unreadable(error: &impl std::fmt::Debug) -> ApiError {
    tracing::error!(?error, "a stored plan cannot be exported");
    ApiError::new(ErrorCode::Internal, "the stored plan cannot be exported")
}
