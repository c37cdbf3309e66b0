//! `slewplan study comparison`: compares reaction wheels with control moment gyroscopes.

use crate::cli::failure::Failure;
use crate::cli::output::{self, Destination};
use crate::cli::{Exit, input};
use crate::documents::study::comparison::{self, ComparisonAnswerDocument};
use slewplan_studies::comparison::{ComparisonStudy, ComparisonStudySpec};
use std::path::PathBuf;

/// Arguments of `study comparison`.
#[derive(Debug, clap::Args)]
pub(super) struct ComparisonStudyArguments {
    /// Differences from the published study, - for standard input [default: none]
    study: Option<PathBuf>,
    /// Write the answer to this file instead of standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

/// Runs the study and writes the answer.
pub(super) fn run(arguments: &ComparisonStudyArguments) -> Result<Exit, Failure> {
    let destination = Destination::open(&arguments.output)?;
    let spec = arguments.study.as_deref().map_or_else(
        || Ok(ComparisonStudySpec::default()),
        |path| {
            comparison::read(&input::read(path)?).map_err(|problems| Failure::Invalid {
                name: input::name(path),
                problems,
            })
        },
    )?;
    let study = ComparisonStudy::of(spec).map_err(|problems| Failure::Invalid {
        name: name(arguments),
        problems,
    })?;
    let study = study.ok_or_else(|| Failure::Unspeakable("a table has no law".to_owned()))?;
    destination.write(&output::json(&ComparisonAnswerDocument::new(&study))?)?;
    Ok(Exit::Complete)
}

fn name(arguments: &ComparisonStudyArguments) -> String {
    let path = arguments.study.as_deref();
    path.map_or_else(|| "the study".to_owned(), input::name)
}
