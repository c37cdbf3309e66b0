//! Input and output of a study.

use crate::cli::answer::{Answer, AnswerOptions};
use crate::cli::failure::Failure;
use crate::cli::input;
use slewplan_solver::model::problem::Problem;
use std::path::PathBuf;

/// Arguments for input and output.
#[derive(Debug, clap::Args)]
pub(super) struct StudyFiles {
    /// The document of the study, - for standard input
    study: PathBuf,
    #[command(flatten)]
    answer: AnswerOptions,
}

impl StudyFiles {
    /// Opens the output, before anything is computed, and reads the document with `read`.
    pub(super) fn open<T>(
        &self,
        read: impl FnOnce(&[u8]) -> Result<T, Vec<Problem>>,
    ) -> Result<(Answer, T), Failure> {
        let answer = self.answer.open()?;
        let bytes = input::read(&self.study)?;
        let study = read(&bytes).map_err(|problems| self.invalid(problems))?;
        Ok((answer, study))
    }

    /// The error for problems of the document.
    pub(super) fn invalid(&self, problems: Vec<Problem>) -> Failure {
        Failure::Invalid {
            name: input::name(&self.study),
            problems,
        }
    }
}
