//! Files and standard input.

use super::failure::Failure;
use crate::documents;
use crate::documents::document::Node;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::{Scenario, Validated};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Maximum size of an input, MiB: far above any real document, far below the memory of a small
/// machine.
const MAX_MIB: u64 = 256;

/// The name of an input in messages.
pub(super) fn name(path: &Path) -> String {
    if is_stream(path) {
        "standard input".into()
    } else {
        path.display().to_string()
    }
}

/// Whether a path stands for standard input or output.
pub(super) fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Refuses to read more than one input from standard input.
pub(super) fn one_stream_at_most(paths: &[&Path]) -> Result<(), Failure> {
    let streams = paths.iter().filter(|path| is_stream(path)).count();
    if streams > 1 {
        return Err(Failure::StandardInputTwice);
    }
    Ok(())
}

/// Reads all of a file or of standard input.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = read_limited(path).map_err(|source| Failure::Unreadable {
        name: name(path),
        source,
    })?;
    if bytes.len() as u64 > MAX_MIB << 20 {
        return Err(Failure::TooLarge {
            name: name(path),
            limit_mib: MAX_MIB,
        });
    }
    Ok(bytes)
}

fn read_limited(path: &Path) -> io::Result<Vec<u8>> {
    let source: Box<dyn Read> = if is_stream(path) {
        Box::new(io::stdin().lock())
    } else {
        Box::new(File::open(path)?)
    };
    let mut bytes = Vec::new();
    source.take((MAX_MIB << 20) + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a document of any kind.
pub(super) fn document(path: &Path) -> Result<Node, Failure> {
    documents::document::parse(&read(path)?).map_err(|problem| Failure::Invalid {
        name: name(path),
        problems: vec![problem],
    })
}

/// Reads a valid scenario; a time limit from the command line, s, replaces its own.
pub(super) fn scenario(path: &Path, time_limit_s: Option<f64>) -> Result<Validated, Failure> {
    documents::scenario::read(&read(path)?, time_limit_s).map_err(|problems| Failure::Invalid {
        name: name(path),
        problems,
    })
}

/// Reads the part of a plan that a command needs.
pub(super) fn of_plan<T>(
    path: &Path,
    scenario: &Scenario,
    read_for: impl FnOnce(&[u8], &Scenario) -> Result<T, Vec<Problem>>,
) -> Result<T, Failure> {
    read_for(&read(path)?, scenario).map_err(|problems| Failure::Invalid {
        name: name(path),
        problems,
    })
}
