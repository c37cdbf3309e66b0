//! `/openapi.yaml` and the index of errors.

use super::super::error::{ApiError, ErrorCode};
use super::super::extract::header_text;
use super::super::respond;
use crate::base::digest;
use crate::store::EndCode;
use axum::Extension;
use axum::body::Bytes;
use axum::http::HeaderMap;
use axum::response::Response;
use slewplan_solver::model::problem::Code;
use std::fmt::Write;
use std::sync::{Arc, LazyLock};
use strum::VariantArray as _;

/// A constant text with its entity tag.
struct Page {
    form: &'static str,
    tag: String,
    text: Bytes,
}

impl Page {
    fn new(form: &'static str, text: String) -> Self {
        Self {
            form,
            tag: digest::hex(text.as_bytes()),
            text: text.into(),
        }
    }

    fn answer(&self, headers: &HeaderMap) -> Result<Response, ApiError> {
        let known = header_text(headers, "if-none-match")?.unwrap_or("");
        let response = respond::tagged(self.form, &self.tag, self.text.clone());
        Ok(respond::unless_known(known, response))
    }
}

/// The description of the interface. The router, which lists the routes, provides it.
#[derive(Clone)]
pub(in crate::api) struct OpenApiPage(Arc<Page>);

impl OpenApiPage {
    /// The page of a description as YAML.
    pub(in crate::api) fn new(yaml: String) -> Self {
        Self(Arc::new(Page::new("application/yaml", yaml)))
    }
}

static ERRORS: LazyLock<Page> = LazyLock::new(|| Page::new("text/html; charset=utf-8", index()));

/// Read this description
#[utoipa::path(
    get, path = "/openapi.yaml", tag = "operations", operation_id = "get_openapi",
    params(("If-None-Match" = Option<String>, Header,
        description = "Entity tags of cached contents")),
    responses(
        (status = 200, description = "OpenAPI 3.1", body = serde_json::Value,
            content_type = "application/yaml",
            headers(("ETag" = String, description = "Hash of the content"))),
        (status = 304, description = "Not changed"),
    ),
)]
pub(in crate::api) async fn openapi(
    Extension(description): Extension<OpenApiPage>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    description.0.answer(&headers)
}

/// Read the index of errors
#[utoipa::path(
    get, path = "/docs/errors", tag = "operations", operation_id = "get_error_index",
    params(("If-None-Match" = Option<String>, Header,
        description = "Entity tags of cached contents")),
    responses(
        (status = 200, description = "Every code and what it means", body = String,
            content_type = "text/html",
            headers(("ETag" = String, description = "Hash of the content"))),
        (status = 304, description = "Not changed"),
    ),
)]
pub(in crate::api) async fn errors(headers: HeaderMap) -> Result<Response, ApiError> {
    ERRORS.answer(&headers)
}

/// Inline styles of the page, which loads nothing.
const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem auto;\
    padding:0 1rem;color-scheme:light dark}table{border-collapse:collapse;width:100%}\
    th,td{text-align:left;vertical-align:top;padding:.35rem .75rem .35rem 0;\
    border-bottom:1px solid #8886}:target{background:#fc04}";

fn index() -> String {
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>Errors of slewplan</title>\
         <style>{STYLE}</style>\
         <h1>Errors of slewplan</h1>\
         <p>Codes never change their meaning. <a href=\"#requests\">Errors of requests</a> are \
         the <code>code</code> of a problem document (RFC 9457); its <code>type</code> leads here. \
         <a href=\"#inputs\">Problems of inputs</a> are the <code>code</code> of an entry of \
         <code>errors</code>, <code>warnings</code>, <code>reasons</code> or <code>refused</code>, \
         and stand in brackets where a command lists them; each comes with a pointer to its place \
         (RFC 6901), a message and a hint. The <code>code</code> of a job that ended without a plan \
         is that of the first reason, or one of the <a href=\"#ends\">ends of jobs</a>.</p>\
         <h2 id=\"requests\">Errors of requests</h2>\
         <table><tr><th>Code<th>Status<th>Meaning<th>What to do"
    );
    for code in ErrorCode::ALL {
        let (name, status) = (code.as_str(), code.status().as_u16());
        let (title, remedy) = (code.title(), code.remedy());
        let _ = write!(
            page,
            "<tr id=\"{name}\"><td><code>{name}</code><td>{status}<td>{title}.<td>{remedy}"
        );
    }
    page.push_str(
        "</table><h2 id=\"inputs\">Problems of inputs</h2>\
         <table><tr><th>Code<th>Meaning<th>What to do",
    );
    for code in Code::VARIANTS {
        let (meaning, remedy) = (code.meaning(), code.remedy());
        let _ = write!(
            page,
            "<tr id=\"input-{code}\"><td><code>{code}</code><td>{meaning}<td>{remedy}"
        );
    }
    page.push_str(
        "</table><h2 id=\"ends\">Ends of jobs</h2>\
         <table><tr><th>Code<th>Meaning<th>What to do",
    );
    for code in EndCode::OWN {
        let (name, meaning, remedy) = (code.as_str(), code.meaning(), code.remedy());
        let _ = write!(
            page,
            "<tr id=\"end-{name}\"><td><code>{name}</code><td>{meaning}<td>{remedy}"
        );
    }
    page.push_str("</table></html>\n");
    page
}
