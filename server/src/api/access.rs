//! Authorization: the rule of every route, and the client behind a request.
//!
//! Where keys are required, a route without a rule is closed.

use super::error::{ApiError, ErrorCode};
use super::{App, page};
use crate::base::access::{Scope, digest_of};
use crate::base::clock::now_us;
use axum::extract::{FromRequestParts, MatchedPath, Request, State};
use axum::http::request::Parts;
use axum::http::{HeaderMap, Method, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether requests need keys. Once they do, they do until the service ends.
///
/// Without keys every request is allowed. With keys a request needs one, and sees only the jobs and
/// spacecraft of its client.
#[derive(Debug, Clone)]
pub(crate) struct Access(Arc<AtomicBool>);

impl Access {
    /// Access with or without keys.
    pub(crate) fn new(asks_for_keys: bool) -> Self {
        Self(Arc::new(AtomicBool::new(asks_for_keys)))
    }

    /// Whether requests need keys.
    pub(crate) fn asks_for_keys(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// Requires keys from now on.
    pub(crate) fn ask_for_keys(&self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

/// The requirement of a route.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// No key: the answer has no data of clients.
    Public,
    /// A key with this scope.
    Needs(Scope),
}

/// Where the jobs of a client are.
const JOBS: [&str; 2] = ["/v1/plans", "/v1/leg-tables"];

/// The rule of a route; `None` when there is no such route.
fn rule(method: &Method, route: &str) -> Option<Rule> {
    let reads = matches!(*method, Method::GET | Method::HEAD);
    match route {
        "/" | page::FILES => Some(Rule::Public),
        "/health/live" | "/health/ready" | "/openapi.yaml" | "/v1/version" | "/v1/limits" => {
            Some(Rule::Public)
        }
        _ if route.starts_with("/docs") => Some(Rule::Public),
        // Cached legs reveal the spacecraft of all clients, and the plans of all clients use them.
        "/metrics" | "/v1/legs" | "/v1/legs/import" | "/v1/legs/{key}" => {
            Some(Rule::Needs(Scope::Operate))
        }
        "/v1/legs/query" | "/v1/verify" | "/v1/slews" => Some(Rule::Needs(Scope::Write)),
        _ if route.starts_with("/v1/studies/") => Some(Rule::Needs(Scope::Write)),
        _ if JOBS.iter().any(|jobs| route.starts_with(jobs))
            || route == "/v1/spacecraft"
            || route.starts_with("/v1/spacecraft/") =>
        {
            Some(Rule::Needs(if reads { Scope::Read } else { Scope::Write }))
        }
        _ => None,
    }
}

/// The client behind a request; none where no keys are required.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Caller(Option<String>);

impl Caller {
    /// The client.
    pub(super) fn client(&self) -> Option<&str> {
        self.0.as_deref()
    }

    /// The stored form of a name, distinct for every client. Neither clients nor names contain
    /// spaces.
    pub(super) fn own(&self, name: &str) -> String {
        match &self.0 {
            Some(client) => format!("{client} {name}"),
            None => name.to_owned(),
        }
    }
}

impl FromRequestParts<App> for Caller {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &App) -> Result<Self, Infallible> {
        Ok(parts.extensions.get().cloned().unwrap_or(Self(None)))
    }
}

/// Passes allowed requests on, with their [`Caller`]. A job of another client is answered as not
/// found.
pub(super) async fn authorize(
    State(app): State<App>,
    route: Option<MatchedPath>,
    request: Request,
    next: Next,
) -> Response {
    if app.0.access.asks_for_keys() {
        let route = route.as_ref().map_or("", MatchedPath::as_str);
        let (mut parts, body) = request.into_parts();
        match examine(&app, route, &parts).await {
            Ok(caller) => parts.extensions.insert(caller),
            Err(error) => return error.into_response(),
        };
        return next.run(Request::from_parts(parts, body)).await;
    }
    next.run(request).await
}

async fn examine(app: &App, route: &str, request: &Parts) -> Result<Caller, ApiError> {
    let rule = rule(&request.method, route);
    if rule == Some(Rule::Public) {
        return Ok(Caller(None));
    }
    let unknown = |what: &str| ApiError::new(ErrorCode::Unauthorized, what);
    let key = bearer(&request.headers)
        .ok_or_else(|| unknown("send Authorization: Bearer with a key of this service"))?;
    let found = app.store().key(&digest_of(key)).await?;
    let key = found
        .filter(|key| key.is_valid(now_us()))
        .ok_or_else(|| unknown("the key is unknown or no longer valid"))?;
    let Some(Rule::Needs(scope)) = rule else {
        return Err(ApiError::new(ErrorCode::NotFound, "there is nothing here"));
    };
    if !key.scopes()?.contain(scope) {
        let detail = format!("the key does not have the scope {}", scope.into_str());
        return Err(ApiError::new(ErrorCode::ScopeMissing, detail));
    }
    // Compared without decoding: identifiers have no characters that need escaping.
    let path = request.uri.path();
    let job = JOBS
        .iter()
        .find_map(|jobs| path.strip_prefix(jobs)?.strip_prefix('/'));
    if let Some(id) = job.and_then(|rest| rest.split('/').next())
        && !app.store().owns(&key.client, id).await?
    {
        return Err(ApiError::not_found("job", id));
    }
    Ok(Caller(Some(key.client)))
}

/// The key of `Authorization: Bearer`.
fn bearer(headers: &HeaderMap) -> Option<&str> {
    let value = headers.get(header::AUTHORIZATION)?.to_str().ok()?;
    let (scheme, key) = value.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then_some(key.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_route_of_the_description_has_a_rule() {
        let description = super::super::router::openapi();
        let routes = description.lines().filter_map(|line| {
            let route = line.strip_prefix("  /")?.strip_suffix(':')?;
            Some(format!("/{route}"))
        });
        let mut count = 0;
        for route in routes {
            for method in [Method::GET, Method::POST, Method::PUT, Method::DELETE] {
                assert!(rule(&method, &route).is_some(), "{method} {route}");
            }
            count += 1;
        }
        assert!(count >= 17, "{count}");
        assert_eq!(rule(&Method::GET, ""), None);
        assert_eq!(rule(&Method::GET, "/v1/nothing"), None);
    }
}
