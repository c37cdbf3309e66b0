//! Boresights by their names.
//!
//! They are looked up in the description, which has the name even if its axis is refused.

use super::findings::Findings;
use super::problem::{Code, quoted};
use super::spec::BoresightSpec;
use super::spelling::likely;

/// The boresight of a name that stands at a pointer; an unknown one is refused.
pub(crate) fn find<'a>(
    name: &str,
    boresights: &'a [BoresightSpec],
    pointer: &str,
    findings: &mut Findings,
) -> Option<&'a BoresightSpec> {
    let found = boresights.iter().find(|known| known.name == name);
    if found.is_none() {
        findings.refuse(
            pointer,
            Code::UnknownReference,
            format!("no boresight is named \"{name}\""),
            hint(name, boresights),
        );
    }
    found
}

fn hint(name: &str, boresights: &[BoresightSpec]) -> String {
    let names: Vec<&str> = boresights.iter().map(|known| known.name.as_str()).collect();
    let meant = likely(name, &names).map_or_else(String::new, |meant| {
        format!("did you mean {}? ", quoted([meant].into_iter()))
    });
    match quoted(names.into_iter()).as_str() {
        "" => "declare it in spacecraft.boresights".to_owned(),
        known => format!("{meant}declare it in spacecraft.boresights, or use {known}"),
    }
}
