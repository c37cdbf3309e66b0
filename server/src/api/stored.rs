//! Replaces references to stored spacecraft by their documents.

use super::App;
use super::access::Caller;
use super::error::ApiError;
use crate::documents::document::{self, Node};
use crate::documents::reader::{Cursor, Sink};
use crate::store::StoreError;
use slewplan_solver::model::problem::{Code, Problem};

/// Replaces `{"ref": name}` or `{"ref": name, "version": n}` under `spacecraft` by the stored
/// document. Returns the tree and whether it had a reference. Pointers of problems begin with the
/// place of the tree in the request.
pub(super) async fn write_out(
    app: &App,
    caller: &Caller,
    mut node: Node,
    place: &str,
) -> Result<(Node, bool), ApiError> {
    let Some((name, version)) = reference(&node, place)? else {
        return Ok((node, false));
    };
    let found = app.store().spacecraft(&caller.own(&name), version).await?;
    let Some(row) = found else {
        let what = match version {
            Some(version) => format!("version {version} of the spacecraft {name:?}"),
            None => format!("the spacecraft {name:?}"),
        };
        return Err(ApiError::input(vec![Problem::new(
            format!("{place}/spacecraft/ref"),
            Code::UnknownReference,
            format!("{what} is not stored here"),
            "store it with PUT /v1/spacecraft/{name}, or write it out in the scenario",
        )]));
    };
    // Only valid JSON is stored, so that an error here is not an error of the request.
    let damaged = |_| StoreError::Damaged { what: "spacecraft" };
    let stored = document::parse(row.document.as_bytes()).map_err(damaged)?;
    if let Some(spacecraft) = node.member_mut("spacecraft") {
        *spacecraft = stored;
    }
    Ok((node, true))
}

fn reference(node: &Node, place: &str) -> Result<Option<(String, Option<i64>)>, ApiError> {
    let sink = Sink::default();
    let found = Cursor::at(node, place, &sink)
        .member("spacecraft")
        .filter(|spacecraft| spacecraft.member("ref").is_some())
        .and_then(|spacecraft| {
            let fields = spacecraft.object(&["ref", "version"])?;
            let name = fields.required("ref")?.text()?.to_owned();
            let version = match fields.optional("version") {
                Some(version) => Some(i64::try_from(version.integer()?).unwrap_or(i64::MAX)),
                None => None,
            };
            Some((name, version))
        });
    let problems = sink.into_problems();
    if problems.is_empty() {
        Ok(found)
    } else {
        Err(ApiError::input(problems))
    }
}
