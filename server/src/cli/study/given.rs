//! Input and output of a study.

use crate::cli::failure::Failure;
use crate::cli::input;
use crate::cli::output::Destination;
use slewplan_solver::model::problem::Problem;
use std::path::PathBuf;

/// Arguments for input and output.
#[derive(Debug, clap::Args)]
pub(super) struct StudyFiles {
    /// The document of the study, - for standard input
    study: PathBuf,
    /// Write the answer to this file instead of standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

impl StudyFiles {
    /// Opens the output, before anything is computed, and reads the document with `read`.
    pub(super) fn open<T>(
        &self,
        read: impl FnOnce(&[u8]) -> Result<T, Vec<Problem>>,
    ) -> Result<(Destination, T), Failure> {
        let destination = Destination::open(&self.output)?;
        let bytes = input::read(&self.study)?;
        let study = read(&bytes).map_err(|problems| self.invalid(problems))?;
        Ok((destination, study))
    }

    /// The error for problems of the document.
    pub(super) fn invalid(&self, problems: Vec<Problem>) -> Failure {
        Failure::Invalid {
            name: input::name(&self.study),
            problems,
        }
    }
}
