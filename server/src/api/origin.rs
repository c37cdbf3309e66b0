//! The names that the service answers to, and the pages that may use it.
//!
//! A browser sends requests for every page that is open in it, so that any site can reach a service
//! on the user's machine. What tells such requests apart are three headers that scripts cannot set:
//! `Host` has the name of a site whose address was changed to that of the service (DNS rebinding),
//! `Origin` and `Sec-Fetch-Site` show a page from elsewhere. Programs that are not browsers send no
//! `Origin` and no `Sec-Fetch-Site`.

use super::App;
use super::error::{ApiError, ErrorCode};
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, Method, Version, header, uri};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::fmt::{self, Display};
use std::net::{IpAddr, Ipv6Addr, SocketAddr};
use std::str::FromStr;

const FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const FETCH_MODE: HeaderName = HeaderName::from_static("sec-fetch-mode");
const FETCH_DESTINATION: HeaderName = HeaderName::from_static("sec-fetch-dest");

/// Routes at any address: orchestrators ask at that of a pod, and the answers have no data.
const PROBES: [&str; 2] = ["/health/live", "/health/ready"];

/// A host of a URL in its canonical form, so that equal hosts compare equal.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Host {
    /// An address; those of IPv4 within IPv6 as IPv4.
    Address(IpAddr),
    /// A name in lower case, without the dot at its end.
    Name(String),
}

impl Host {
    fn parse(text: &str) -> Option<Self> {
        if let Some(inner) = text.strip_prefix('[') {
            let address: Ipv6Addr = inner.strip_suffix(']')?.parse().ok()?;
            return Some(Self::Address(IpAddr::V6(address).to_canonical()));
        }
        if let Ok(address) = text.parse::<IpAddr>() {
            return Some(Self::Address(address.to_canonical()));
        }
        let name = text.strip_suffix('.').unwrap_or(text).to_ascii_lowercase();
        let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._".contains(&byte);
        (!name.is_empty() && name.bytes().all(plain)).then_some(Self::Name(name))
    }

    /// Whether it is this machine for every client. Browsers resolve `localhost` and the names below
    /// it without asking a server, so that nobody can point them elsewhere.
    fn is_loopback(&self) -> bool {
        match self {
            Self::Address(address) => address.is_loopback(),
            Self::Name(name) => name == "localhost" || name.ends_with(".localhost"),
        }
    }
}

impl Display for Host {
    fn fmt(&self, form: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Address(IpAddr::V6(address)) => write!(form, "[{address}]"),
            Self::Address(address) => address.fmt(form),
            Self::Name(name) => name.fmt(form),
        }
    }
}

/// A host with or without a port.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Authority {
    host: Host,
    port: Option<u16>,
}

impl Authority {
    fn parse(text: &str) -> Option<Self> {
        let parsed: uri::Authority = text.parse().ok()?;
        // A user name before the host leaves a rest that is no port.
        let port = match text.strip_prefix(parsed.host())? {
            "" | ":" => None,
            rest => Some(rest.strip_prefix(':')?.parse().ok()?),
        };
        let host = Host::parse(parsed.host())?;
        Some(Self { host, port })
    }
}

/// A host that was named as one of the service's own.
#[derive(Debug, Clone)]
pub(crate) struct AllowedHost(Authority);

impl FromStr for AllowedHost {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let address = text.parse::<IpAddr>().ok().map(|address| Authority {
            host: Host::Address(address.to_canonical()),
            port: None,
        });
        let authority = address.or_else(|| Authority::parse(text));
        authority.map(Self).ok_or_else(|| {
            "expected a name or an address, with or without a port, such as plan.example".to_owned()
        })
    }
}

/// The names and addresses of the service.
#[derive(Debug)]
pub(crate) struct OwnHosts {
    bound: IpAddr,
    allowed: Vec<AllowedHost>,
}

impl OwnHosts {
    /// The address that the service listens on, and the hosts that were named as its own.
    pub(crate) fn new(bound: SocketAddr, allowed: Vec<AllowedHost>) -> Self {
        Self {
            bound: bound.ip().to_canonical(),
            allowed,
        }
    }

    /// Whether requests to a host are served. A service with keys is reached by names that it does
    /// not know, and a rebound page has no key.
    fn serve(&self, host: &Host, asks_for_keys: bool) -> bool {
        host.is_loopback()
            || *host == Host::Address(self.bound)
            || self
                .allowed
                .iter()
                .any(|AllowedHost(own)| own.host == *host)
            || (asks_for_keys && self.allowed.is_empty())
    }

    /// Whether pages of an origin were allowed: at the port that was named, or at that of its scheme.
    fn allow(&self, origin: &Origin) -> bool {
        self.allowed.iter().any(|AllowedHost(own)| {
            own.host == origin.host && own.port.unwrap_or(origin.default_port) == origin.port
        })
    }
}

/// The origin of a page.
#[derive(Debug)]
struct Origin {
    host: Host,
    port: u16,
    /// The port of its scheme.
    default_port: u16,
}

impl Origin {
    /// `None` for origins that are no sites, such as `null`.
    fn parse(text: &str) -> Option<Self> {
        let schemes = [("http://", 80), ("https://", 443)];
        let (rest, default_port) = schemes
            .into_iter()
            .find_map(|(scheme, port)| Some((text.strip_prefix(scheme)?, port)))?;
        let Authority { host, port } = Authority::parse(rest)?;
        let port = port.unwrap_or(default_port);
        Some(Self {
            host,
            port,
            default_port,
        })
    }

    /// Whether a request to a host from this origin is one from the service's own page. The scheme
    /// of the request is not known behind a proxy that ends TLS.
    fn is_of(&self, target: &Authority) -> bool {
        self.host == target.host && self.port == target.port.unwrap_or(self.default_port)
    }
}

/// Refuses requests to hosts that are not the service's, and from pages that are not.
pub(super) async fn guard(State(app): State<App>, request: Request, next: Next) -> Response {
    let asks_for_keys = app.0.access.asks_for_keys();
    match examine(&app.0.hosts, asks_for_keys, &request) {
        Ok(()) => next.run(request).await,
        Err(error) => error.into_response(),
    }
}

fn examine(own: &OwnHosts, asks_for_keys: bool, request: &Request) -> Result<(), ApiError> {
    let targets = targets(request)?;
    // A rebound page has a name.
    let is_probe = PROBES.contains(&request.uri().path());
    let is_served = |host: &Host| {
        own.serve(host, asks_for_keys) || (is_probe && matches!(host, Host::Address(_)))
    };
    if let Some(foreign) = targets.iter().find(|target| !is_served(&target.host)) {
        return Err(foreign_host(&foreign.host));
    }
    check_page(own, targets.first(), request)
}

/// Refuses requests that a browser sends for a page from elsewhere.
fn check_page(
    own: &OwnHosts,
    target: Option<&Authority>,
    request: &Request,
) -> Result<(), ApiError> {
    let origins = request.headers().get_all(header::ORIGIN).iter();
    let mut is_allowed = false;
    for text in origins {
        let text = String::from_utf8_lossy(text.as_bytes());
        let origin = Origin::parse(&text);
        let is_own = origin
            .as_ref()
            .zip(target)
            .is_some_and(|(origin, target)| origin.is_of(target));
        is_allowed = origin.is_some_and(|origin| own.allow(&origin));
        if !is_allowed && !is_own {
            return Err(foreign_origin(&text, target));
        }
    }
    if !is_allowed && is_from_elsewhere(request.method(), request.headers()) {
        let detail = "the browser says that a page of another site sends this request";
        return Err(ApiError::new(ErrorCode::ForeignOrigin, detail));
    }
    Ok(())
}

/// The hosts that a request names: that of its target before that of `Host` (RFC 9112, section 3.2).
fn targets(request: &Request) -> Result<Vec<Authority>, ApiError> {
    let bad = |detail| Err(ApiError::new(ErrorCode::BadRequest, detail));
    let hosts: Vec<_> = request.headers().get_all(header::HOST).iter().collect();
    match hosts.len() {
        // Every browser sends the header; HTTP/1.0 does not have it.
        0 if request.version() > Version::HTTP_10 => return bad("the Host header is missing"),
        0 | 1 => {}
        _ => return bad("there is more than one Host header"),
    }
    let target = request.uri().authority().map(uri::Authority::as_str);
    let named = hosts.iter().map(|host| host.to_str().unwrap_or_default());
    let parsed = target.into_iter().chain(named).map(Authority::parse);
    match parsed.collect() {
        Some(targets) => Ok(targets),
        None => bad("the Host header is not a name or address with an optional port"),
    }
}

/// Whether a browser tells that a page from elsewhere sends the request. The user may follow a link
/// from there: the page that sends the user here cannot read what opens.
fn is_from_elsewhere(method: &Method, headers: &HeaderMap) -> bool {
    let is = |name, text| headers.get_all(name).iter().any(|value| value == text);
    let is_link = (method == Method::GET || method == Method::HEAD)
        && is(FETCH_MODE, "navigate")
        && is(FETCH_DESTINATION, "document");
    // Another port of this machine is the same site, and another program.
    !is_link && (is(FETCH_SITE, "cross-site") || is(FETCH_SITE, "same-site"))
}

fn foreign_host(host: &Host) -> ApiError {
    let detail = format!(
        "the service does not answer to {host}; if that is how it shall be reached, start it with \
         --allowed-host {host}"
    );
    ApiError::new(ErrorCode::ForeignHost, detail)
}

fn foreign_origin(origin: &str, target: Option<&Authority>) -> ApiError {
    let name = Origin::parse(origin).map(|origin| match origin.port {
        port if port == origin.default_port => origin.host.to_string(),
        port => format!("{}:{port}", origin.host),
    });
    let advice = match (name, target) {
        (Some(name), Some(target)) => format!(
            "; if a proxy makes its page arrive as {}, let the proxy pass Host on, or start the \
             service with --allowed-host {name}",
            target.host
        ),
        _ => String::new(),
    };
    let detail = format!("the page of {origin:?} is not the service's own{advice}");
    ApiError::new(ErrorCode::ForeignOrigin, detail)
}
