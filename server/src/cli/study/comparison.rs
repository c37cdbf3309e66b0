//! `slewplan study comparison`: compares reaction wheels with control moment gyroscopes.

use crate::cli::answer::AnswerOptions;
use crate::cli::failure::Failure;
use crate::cli::{Exit, input};
use crate::documents::study::comparison::{self, ComparisonAnswerDocument};
use crate::render::report;
use slewplan_studies::comparison::{ComparisonStudy, ComparisonStudySpec};
use std::path::PathBuf;

/// Arguments of `study comparison`.
#[derive(Debug, clap::Args)]
pub(super) struct ComparisonStudyArguments {
    /// Differences from the published study, - for standard input [default: none]
    study: Option<PathBuf>,
    #[command(flatten)]
    answer: AnswerOptions,
}

/// Runs the study and writes the answer.
pub(super) fn run(arguments: &ComparisonStudyArguments) -> Result<Exit, Failure> {
    let answer = arguments.answer.open()?;
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
    let document = ComparisonAnswerDocument::new(&study);
    answer.write(&document, || report::comparison(&study))?;
    Ok(Exit::Complete)
}

fn name(arguments: &ComparisonStudyArguments) -> String {
    let path = arguments.study.as_deref();
    path.map_or_else(|| "the study".to_owned(), input::name)
}
