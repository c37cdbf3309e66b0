//! `slewplan study comparison`: wheels against gyroscopes.

use crate::cli::failure::Failure;
use crate::cli::output::{self, Destination};
use crate::cli::{Exit, input};
use crate::documents::study::comparison::{self, ComparisonAnswerDocument};
use slewplan_studies::comparison::{ComparisonSpec, Study};
use std::path::PathBuf;

/// What `study comparison` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// What differs from the published study, - for standard input [default: nothing]
    study: Option<PathBuf>,
    /// Write the answer to this file instead of standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

/// Compares and writes the answer.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let destination = Destination::open(&arguments.output)?;
    let spec = arguments.study.as_deref().map_or_else(
        || Ok(ComparisonSpec::default()),
        |path| {
            comparison::read(&input::read(path)?).map_err(|problems| Failure::Invalid {
                name: input::name(path),
                problems,
            })
        },
    )?;
    let study = Study::of(spec).map_err(|problems| Failure::Invalid {
        name: name(arguments),
        problems,
    })?;
    let study = study.ok_or_else(|| Failure::Unspeakable("a table has no law".to_owned()))?;
    destination.write(&output::json(&ComparisonAnswerDocument::new(&study))?)?;
    Ok(Exit::Complete)
}

fn name(arguments: &Arguments) -> String {
    let path = arguments.study.as_deref();
    path.map_or_else(|| "the study".to_owned(), input::name)
}
