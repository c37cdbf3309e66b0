//! `slewplan legs --merge`: merges the files of shards.

use super::super::failure::Failure;
use super::super::input;
use crate::documents;
use crate::documents::legs::LegTable;
use crate::documents::shards;
use std::path::{Path, PathBuf};

/// The whole table of the shards in some files.
pub(super) fn table(files: &[PathBuf]) -> Result<LegTable, Failure> {
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    input::one_stream_at_most(&paths)?;
    let (mut parts, mut problems) = (Vec::new(), Vec::new());
    for path in &paths {
        let name = || Some(input::name(path));
        match documents::legs::read::read(&input::document(path)?) {
            Ok(part) => parts.push(part),
            Err(found) => problems.extend(found.into_iter().map(|problem| (name(), problem))),
        }
    }
    if !problems.is_empty() {
        return Err(Failure::Misfits { problems });
    }
    shards::join(parts).map_err(|misfits| {
        let named = misfits
            .into_iter()
            .map(|(part, problem)| (part.map(|part| input::name(paths[part])), problem));
        Failure::Misfits {
            problems: named.collect(),
        }
    })
}
