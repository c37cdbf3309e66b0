//! The page at `/`: the files of `server/page`, embedded in the binary, and the examples that it
//! offers.
//!
//! The address of every file but the first contains the digest of all of them, so that browsers may
//! cache files for ever and never mix two versions.

use super::error::ApiError;
use super::extract::{Named, header_text};
use super::respond;
use crate::base::digest;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use rust_embed::RustEmbed;
use std::borrow::Cow;
use std::sync::LazyLock;

/// The route of the files.
pub(super) const FILES: &str = "/page/{digest}/{*path}";

/// Content from this service only, no embedding in frames, nothing inline. Images may also be those
/// that the page itself has made: it turns drawings into PNG files so.
const CONTENT_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
    img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'none'";

const FIRST: &str = "index.html";
/// Placeholder in the first file for the folder of the others.
const FOLDER_MARK: &str = "{{files}}";

#[derive(RustEmbed)]
#[folder = "page/"]
struct Files;

/// The examples of the page, under `examples/`: scenarios, slews and studies.
const EXAMPLES: [(&str, &str); 14] = [
    (
        "examples/two-targets.json",
        include_str!("../../../tests/fixtures/two-targets.json"),
    ),
    (
        "examples/stars-and-sun.json",
        include_str!("../../../tests/fixtures/stars-and-sun.json"),
    ),
    (
        "examples/olivares-a.json",
        include_str!("../../../tests/fixtures/olivares-a.json"),
    ),
    (
        "examples/olivares-b.json",
        include_str!("../../../tests/fixtures/olivares-b.json"),
    ),
    (
        "examples/olivares-c.json",
        include_str!("../../../tests/fixtures/olivares-c.json"),
    ),
    (
        "examples/pyramid-momentum-bias.json",
        include_str!("../../../tests/fixtures/pyramid-momentum-bias.json"),
    ),
    (
        "examples/quarter-turn.json",
        include_str!("../../../tests/fixtures/slews/quarter-turn.json"),
    ),
    (
        "examples/olrac-four-wheels.json",
        include_str!("../../../tests/fixtures/slews/olrac-four-wheels.json"),
    ),
    (
        "examples/biros-sampled.json",
        include_str!("../../../tests/fixtures/slews/biros-sampled.json"),
    ),
    (
        "examples/lro-least-bill.json",
        include_str!("../../../tests/fixtures/slews/lro-least-bill.json"),
    ),
    (
        "examples/study-authority.json",
        include_str!("../../../tests/fixtures/studies/authority.json"),
    ),
    (
        "examples/study-envelopes.json",
        include_str!("../../../tests/fixtures/studies/pyramid-envelopes.json"),
    ),
    (
        "examples/study-comparison.json",
        include_str!("../../../tests/fixtures/studies/comparison.json"),
    ),
    (
        "examples/study-flight.json",
        include_str!("../../../tests/fixtures/studies/flight.json"),
    ),
];

/// SHA-256 over all files, hex.
static DIGEST: LazyLock<String> = LazyLock::new(|| {
    let mut names: Vec<_> = Files::iter().collect();
    names.extend(EXAMPLES.iter().map(|(name, _)| Cow::Borrowed(*name)));
    names.sort();
    let of_each: String = names
        .iter()
        .filter_map(|name| Some(format!("{name} {}\n", digest::hex(&content(name)?))))
        .collect();
    digest::hex(of_each.as_bytes())
});

fn content(name: &str) -> Option<Cow<'static, [u8]>> {
    let example = EXAMPLES.iter().find(|(example, _)| *example == name);
    match example {
        Some((_, text)) => Some(Cow::Borrowed(text.as_bytes())),
        None => Files::get(name).map(|file| file.data),
    }
}

/// Open the page
///
/// Everything that it loads comes from this service, under addresses that change with the content.
#[utoipa::path(
    get, path = "/", tag = "operations", operation_id = "get_page",
    params(("If-None-Match" = Option<String>, Header,
        description = "Entity tags of cached contents")),
    responses(
        (status = 200, description = "The page", body = String, content_type = "text/html",
            headers(("ETag" = String, description = "Hash of all its files"))),
        (status = 304, description = "Not changed"),
    ),
)]
pub(super) async fn handler(headers: HeaderMap) -> Result<Response, ApiError> {
    let first = Files::get(FIRST).ok_or_else(|| ApiError::not_found("file", FIRST))?;
    let folder = format!("/page/{}", *DIGEST);
    let text = String::from_utf8_lossy(&first.data).replace(FOLDER_MARK, &folder);
    let known = header_text(&headers, "if-none-match")?.unwrap_or("");
    let page = respond::tagged("text/html; charset=utf-8", &DIGEST, text.into());
    let mut response = respond::unless_known(known, page);
    let policy = HeaderValue::from_static(CONTENT_POLICY);
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    Ok(response)
}

/// A file of the page.
pub(super) async fn file(
    Named((digest, path)): Named<(String, String)>,
) -> Result<Response, ApiError> {
    let found = (digest == *DIGEST && path != FIRST).then(|| content(&path));
    let Some((form, body)) = found.flatten().and_then(|body| Some((form(&path)?, body))) else {
        return Err(ApiError::not_found("file", &path));
    };
    let headers = [
        (header::CONTENT_TYPE, form),
        (header::CONTENT_SECURITY_POLICY, CONTENT_POLICY),
        (header::CACHE_CONTROL, "public, max-age=31536000, immutable"),
    ];
    Ok((StatusCode::OK, headers, body).into_response())
}

/// The media type of a file; `None` for files that are not served.
fn form(path: &str) -> Option<&'static str> {
    let (_, ending) = path.rsplit_once('.')?;
    match ending {
        "css" => Some("text/css; charset=utf-8"),
        "js" => Some("text/javascript; charset=utf-8"),
        "json" => Some("application/json"),
        "svg" => Some("image/svg+xml"),
        "txt" => Some("text/plain; charset=utf-8"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name and text of every file of our own.
    fn sources() -> Vec<(String, String)> {
        let text = |name: &str| String::from_utf8(content(name)?.into_owned()).ok();
        let sources: Vec<_> = Files::iter()
            .filter(|name| !name.starts_with("vendor/"))
            .map(|name| (name.to_string(), text(&name).expect("sources are text")))
            .collect();
        assert!(sources.len() > 20, "{}", sources.len());
        sources
    }

    #[test]
    fn every_file_has_a_media_type() {
        for name in Files::iter().filter(|name| name != FIRST) {
            assert!(form(&name).is_some(), "{name}");
        }
    }

    #[test]
    fn every_vendored_file_has_a_licence_beside_it() {
        let foreign: Vec<_> = Files::iter()
            .filter(|name| name.starts_with("vendor/"))
            .collect();
        for name in &foreign {
            let library = name.split('-').next().expect("a name");
            let licence = format!("{library}-LICENSE.txt");
            assert!(foreign.iter().any(|name| *name == licence), "{name}");
        }
    }

    #[test]
    fn no_file_names_another_host_or_has_scripts_and_styles_inline() {
        for (name, text) in sources() {
            // The namespace of SVG is a name, not an address.
            let text = text.replace("http://www.w3.org/2000/svg", "");
            for forbidden in ["http://", "https://", "style=\"", "innerHTML", "eval("] {
                assert!(!text.contains(forbidden), "{name} has {forbidden}");
            }
        }
    }

    #[test]
    fn sources_of_the_page_are_short() {
        for (name, text) in sources() {
            let lines = text.lines().count();
            assert!(lines <= 300, "{name} has {lines} lines");
        }
    }
}
