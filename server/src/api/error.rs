//! The one form of every error: RFC 9457 problem details.

use crate::documents::problems::ProblemDocument;
use crate::store::StoreError;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use slewplan_solver::model::problem::{Code, Problem};
use utoipa::ToSchema;

/// Maximum number of listed problems of an input.
const MAX_PROBLEMS: usize = 100;
/// `Retry-After` of errors that set no other, s.
const RETRY_S: u32 = 10;
/// The same where the database is away: about the time in which a server restarts.
const AWAY_S: u32 = 5;
/// The media type of every error.
pub(super) const PROBLEM_JSON: &str = "application/problem+json";

macro_rules! error_codes {
    ($($name:ident = $text:literal, $status:ident, $title:literal, $remedy:literal;)+) => {
        /// Stable codes of errors of requests; those of problems of an input are in `errors`.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(super) enum ErrorCode { $($name,)+ }

        impl ErrorCode {
            /// All codes, for the error index.
            pub(super) const ALL: &'static [Self] = &[$(Self::$name,)+];

            /// The stable text of the code.
            pub(super) const fn as_str(self) -> &'static str {
                match self { $(Self::$name => $text,)+ }
            }

            /// The HTTP status.
            pub(super) const fn status(self) -> StatusCode {
                match self { $(Self::$name => StatusCode::$status,)+ }
            }

            /// What it means.
            pub(super) const fn title(self) -> &'static str {
                match self { $(Self::$name => $title,)+ }
            }

            /// What to do about it.
            pub(super) const fn remedy(self) -> &'static str {
                match self { $(Self::$name => $remedy,)+ }
            }
        }
    };
}

error_codes! {
    MalformedJson = "malformed_json", BAD_REQUEST, "The body is not valid JSON",
        "Correct the syntax at the line and column of the entry in errors.";
    BadRequest = "bad_request", BAD_REQUEST, "The request cannot be understood",
        "Correct what the detail names.";
    InvalidParameter = "invalid_parameter", BAD_REQUEST, "A parameter or header is not valid",
        "Correct the parameter or header that the detail names.";
    Unauthorized = "unauthorized", UNAUTHORIZED, "A key is needed",
        "Send Authorization: Bearer with a key from slewplan keys create.";
    ScopeMissing = "scope_missing", FORBIDDEN, "The key does not open this",
        "Use a key with the scope that the detail names.";
    ForeignHost = "foreign_host", FORBIDDEN, "The service does not answer to this name",
        "Use localhost or the address of the service, or start it with --allowed-host NAME.";
    ForeignOrigin = "foreign_origin", FORBIDDEN, "Pages of other sites cannot use the service",
        "Use the service's own page, or a program outside of the browser; behind a proxy see \
         --allowed-host of slewplan serve.";
    NotFound = "not_found", NOT_FOUND, "There is nothing here",
        "Look for a mistake in the address; what belongs to another client is not there either.";
    MethodNotAllowed = "method_not_allowed", METHOD_NOT_ALLOWED, "The method does not exist here",
        "Take a method from the description of the interface.";
    NotAcceptable = "not_acceptable", NOT_ACCEPTABLE, "The answer has none of the accepted forms",
        "Accept application/json, or a format that the description names.";
    NotRunning = "not_running", CONFLICT, "The job has not begun yet",
        "Wait until the job runs, or cancel it.";
    JobHasEnded = "job_has_ended", CONFLICT, "The job has ended before",
        "Read its result; there is nothing to stop any more.";
    ResultNotReady = "result_not_ready", CONFLICT, "The job has no plan yet",
        "Ask again later, or follow the events of the job.";
    NoResult = "no_result", CONFLICT, "The job ended without such a result",
        "Read the job or its result as JSON for the reasons.";
    BodyTooSlow = "body_too_slow", REQUEST_TIMEOUT, "The body did not arrive in time",
        "Send the body without long pauses.";
    BodyTooLarge = "body_too_large", PAYLOAD_TOO_LARGE, "The body is too large",
        "Send less, or raise --max-body-bytes of the service; slewplan import takes larger files \
         of legs.";
    TooManyTargets = "too_many_targets", PAYLOAD_TOO_LARGE, "The scenario has too many targets",
        "Plan fewer targets at once, or raise --max-targets of the service.";
    TooMuchMemory = "too_much_memory", PAYLOAD_TOO_LARGE, "The job would need too much memory",
        "Plan fewer targets at once, or raise --job-memory of the service.";
    TooManyPairs = "too_many_pairs", PAYLOAD_TOO_LARGE, "The query asks for too many legs",
        "Ask for fewer legs at once.";
    UnsupportedMediaType = "unsupported_media_type", UNSUPPORTED_MEDIA_TYPE,
        "The body has a form that is not supported",
        "Send application/json without Content-Encoding.";
    InvalidInput = "invalid_input", UNPROCESSABLE_ENTITY, "The input is not valid",
        "Correct what errors lists, each entry with its pointer and hint.";
    NotExportable = "not_exportable", UNPROCESSABLE_ENTITY,
        "The plan cannot be written in this format",
        "Take another format, or plan again with a scenario whose epoch, time system and frame the \
         format has.";
    IdempotencyKeyReused = "idempotency_key_reused", UNPROCESSABLE_ENTITY,
        "The idempotency key belongs to another request",
        "Use a new key for another request.";
    QuotaExceeded = "quota_exceeded", TOO_MANY_REQUESTS, "The client has too many jobs waiting",
        "Try again after Retry-After, or cancel queued jobs.";
    QueueFull = "queue_full", SERVICE_UNAVAILABLE, "Too many jobs wait already",
        "Try again after Retry-After.";
    Busy = "busy", SERVICE_UNAVAILABLE, "The service is busy",
        "Try again after Retry-After.";
    DatabaseUnavailable = "database_unavailable", SERVICE_UNAVAILABLE,
        "The database cannot be used at present",
        "Try again after Retry-After; nothing acknowledged is lost.";
    NotReady = "not_ready", SERVICE_UNAVAILABLE, "The service cannot take work now",
        "Try again later; the log of the service has the cause.";
    DiskFull = "disk_full", INSUFFICIENT_STORAGE, "The disk of the service is full",
        "Make room on the disk of the service; slewplan serve --retain DAYS deletes old jobs.";
    Internal = "internal_error", INTERNAL_SERVER_ERROR, "Something went wrong inside",
        "Look into the log of the service for the X-Request-Id of the answer.";
}

/// An error of a request.
#[derive(Debug)]
pub(super) struct ApiError {
    code: ErrorCode,
    detail: String,
    problems: Vec<Problem>,
    warnings: Vec<Problem>,
    retry_after_s: Option<u32>,
}

/// RFC 9457 problem details.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Problem)]
pub(super) struct ProblemDetails<'a> {
    /// Where the code is explained.
    #[schema(format = "uri-reference")]
    r#type: String,
    title: &'static str,
    status: u16,
    /// What is wrong with this request.
    detail: &'a str,
    /// Stable code.
    code: &'static str,
    /// What is wrong with the input, each with its place; at most the first 100.
    errors: Vec<ProblemDocument<'a>>,
    /// Warnings about the submitted scenario.
    warnings: Vec<ProblemDocument<'a>>,
}

impl ApiError {
    /// An error with a detail.
    pub(super) fn new(code: ErrorCode, detail: impl Into<String>) -> Self {
        Self {
            code,
            detail: detail.into(),
            problems: Vec::new(),
            warnings: Vec::new(),
            retry_after_s: None,
        }
    }

    /// Sets `Retry-After`, s, instead of [`RETRY_S`].
    pub(super) fn retry_after(self, seconds: u32) -> Self {
        Self {
            retry_after_s: Some(seconds),
            ..self
        }
    }

    /// There is nothing with this identifier.
    pub(super) fn not_found(what: &str, id: &str) -> Self {
        Self::new(ErrorCode::NotFound, format!("there is no {what} {id:?}"))
    }

    /// An input with problems: malformed JSON, or an invalid document.
    pub(super) fn input(problems: Vec<Problem>) -> Self {
        let malformed = problems
            .iter()
            .any(|problem| problem.code == Code::MalformedJson);
        let detail = match problems.as_slice() {
            [only] => format!("{}: {}", place(only), only.message),
            more if more.len() > MAX_PROBLEMS => {
                let count = more.len();
                format!("{count} problems, the first {MAX_PROBLEMS} of them listed in errors")
            }
            more => format!("{} problems, listed in errors", more.len()),
        };
        let code = if malformed {
            ErrorCode::MalformedJson
        } else {
            ErrorCode::InvalidInput
        };
        Self {
            problems,
            ..Self::new(code, detail)
        }
    }

    /// Adds problems that the detail does not tell in full.
    pub(super) fn with_problems(self, problems: Vec<Problem>) -> Self {
        Self { problems, ..self }
    }

    /// Adds warnings about the input.
    pub(super) fn with_warnings(self, warnings: Vec<Problem>) -> Self {
        Self { warnings, ..self }
    }

    /// The error that stands for a bare status.
    pub(super) fn of_status(status: StatusCode) -> Self {
        let code = ErrorCode::ALL.iter().copied().find(|code| match status {
            StatusCode::BAD_REQUEST => *code == ErrorCode::BadRequest,
            _ => code.status() == status,
        });
        let code = code.unwrap_or(if status.is_client_error() {
            ErrorCode::BadRequest
        } else {
            ErrorCode::Internal
        });
        Self::new(code, code.title())
    }
}

fn listed(problems: &[Problem]) -> Vec<ProblemDocument<'_>> {
    let first = problems.iter().take(MAX_PROBLEMS);
    first.map(ProblemDocument::from).collect()
}

fn place(problem: &Problem) -> &str {
    if problem.pointer.is_empty() {
        "the document"
    } else {
        &problem.pointer
    }
}

impl From<StoreError> for ApiError {
    fn from(error: StoreError) -> Self {
        tracing::error!(%error, "the database failed");
        if error.is_disk_full() {
            Self::new(
                ErrorCode::DiskFull,
                "nothing more can be stored until space is made",
            )
        } else if error.is_busy() {
            Self::new(ErrorCode::Busy, "the database is busy").retry_after(1)
        } else if error.is_away() {
            let detail = "the server of the database does not answer";
            Self::new(ErrorCode::DatabaseUnavailable, detail).retry_after(AWAY_S)
        } else if error.is_read_only() {
            let detail = "the database can only be read at present";
            Self::new(ErrorCode::DatabaseUnavailable, detail).retry_after(AWAY_S)
        } else {
            Self::new(
                ErrorCode::Internal,
                "the cause is in the log, under the request's id",
            )
        }
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let status = self.code.status();
        let document = ProblemDetails {
            r#type: format!("/docs/errors#{}", self.code.as_str()),
            title: self.code.title(),
            status: status.as_u16(),
            detail: &self.detail,
            code: self.code.as_str(),
            errors: listed(&self.problems),
            warnings: listed(&self.warnings),
        };
        let body = serde_json::to_vec(&document).unwrap_or_default();
        let form = HeaderValue::from_static(PROBLEM_JSON);
        let mut response = (status, [(header::CONTENT_TYPE, form)], body).into_response();
        if self.code == ErrorCode::Unauthorized {
            let scheme = HeaderValue::from_static("Bearer");
            response
                .headers_mut()
                .insert(header::WWW_AUTHENTICATE, scheme);
        }
        let later = [
            StatusCode::TOO_MANY_REQUESTS,
            StatusCode::SERVICE_UNAVAILABLE,
        ];
        let retry = self.retry_after_s;
        if let Some(seconds) = retry.or_else(|| later.contains(&status).then_some(RETRY_S)) {
            response
                .headers_mut()
                .insert(header::RETRY_AFTER, seconds.into());
        }
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temporary_errors_have_retry_after() {
        for code in ErrorCode::ALL {
            let response = ApiError::new(*code, "").into_response();
            let told = response.headers().contains_key(header::RETRY_AFTER);
            let temporary = [429, 503].contains(&code.status().as_u16());
            assert_eq!(told, temporary, "{}", code.as_str());
        }
        let sooner = ApiError::new(ErrorCode::Busy, "").retry_after(1);
        let response = sooner.into_response();
        assert_eq!(response.headers()[header::RETRY_AFTER], "1");
    }
}
