//! Who may do what: the rule of every route, and the caller behind a request.
//!
//! A route without a rule is open to nobody where keys are asked for.

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

/// Whether keys are asked for: of everybody alike, and once they are, for good.
///
/// Without keys everybody may do everything; with them only who has one, and only with what is the
/// client's own.
#[derive(Debug, Clone)]
pub(crate) struct Access(Arc<AtomicBool>);

impl Access {
    /// With keys or without.
    pub(crate) fn new(asks_for_keys: bool) -> Self {
        Self(Arc::new(AtomicBool::new(asks_for_keys)))
    }

    /// Whether keys are asked for.
    pub(crate) fn asks_for_keys(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// Lets nobody in without a key from now on.
    pub(crate) fn ask_for_keys(&self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

/// What a route asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// Nothing: the answer tells nothing about anybody.
    Public,
    /// A key with this scope.
    Needs(Scope),
}

/// The rule of a route; `None` when there is no such route.
fn rule(method: &Method, route: &str) -> Option<Rule> {
    let reads = matches!(*method, Method::GET | Method::HEAD);
    match route {
        "/" | page::FILES => Some(Rule::Public),
        "/health/live" | "/health/ready" | "/openapi.yaml" | "/v1/version" | "/v1/limits" => {
            Some(Rule::Public)
        }
        _ if route.starts_with("/docs") => Some(Rule::Public),
        // Cached legs tell about the spacecraft of all clients, and the plans of all rest on them.
        "/metrics" | "/v1/legs" | "/v1/legs/import" | "/v1/legs/{key}" => {
            Some(Rule::Needs(Scope::Operate))
        }
        "/v1/legs/query" | "/v1/verify" | "/v1/slews" => Some(Rule::Needs(Scope::Write)),
        _ if route.starts_with("/v1/studies/") => Some(Rule::Needs(Scope::Write)),
        _ if route.starts_with("/v1/plans") || route.starts_with("/v1/spacecraft/") => {
            Some(Rule::Needs(if reads { Scope::Read } else { Scope::Write }))
        }
        _ => None,
    }
}

/// On whose behalf a request is made: a client, or nobody in particular where no keys are asked
/// for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Caller(Option<String>);

impl Caller {
    /// The client.
    pub(super) fn client(&self) -> Option<&str> {
        self.0.as_deref()
    }

    /// A name as it is stored, so that every client has names of its own. Neither clients nor names
    /// contain the space.
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

/// Lets a request pass that is allowed, and tells the handler who makes it. The job of another
/// client is not there.
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
        .ok_or_else(|| unknown("the key is not one of this service, or is no longer valid"))?;
    let Some(Rule::Needs(scope)) = rule else {
        return Err(ApiError::new(ErrorCode::NotFound, "there is nothing here"));
    };
    if !key.scopes()?.contain(scope) {
        let detail = format!("the key has not the scope {}", scope.into_str());
        return Err(ApiError::new(ErrorCode::ScopeMissing, detail));
    }
    // As it stands in the path: an identifier has nothing that must be escaped.
    let job = request.uri.path().strip_prefix("/v1/plans/");
    if let Some(id) = job.and_then(|rest| rest.split('/').next())
        && !app.store().owns(&key.client, id).await?
    {
        return Err(ApiError::not_found("plan", id));
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
