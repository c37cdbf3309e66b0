//! Where the answer of a command goes: as a document for programs, as text for people.

use super::failure::Failure;
use super::output::{self, Destination};
use serde::Serialize;
use std::io::{IsTerminal, stdout};
use std::path::PathBuf;

/// Arguments for the answer.
#[derive(Debug, clap::Args)]
pub(super) struct AnswerOptions {
    /// Write the answer as JSON to this file; without it standard output has the JSON, or a summary
    /// if that is a terminal
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print a summary as text, as on a terminal
    #[arg(long)]
    summary: bool,
}

/// The destinations of document and summary.
pub(super) struct Answer {
    document: Option<Destination>,
    summary: Summary,
}

impl AnswerOptions {
    /// Opens the output, before anything is computed.
    pub(super) fn open(&self) -> Result<Answer, Failure> {
        let document = match &self.output {
            Some(path) => Some(Destination::open(path)?),
            None if self.summary || stdout().is_terminal() => None,
            None => Some(Destination::Stream),
        };
        Ok(Answer {
            summary: Summary::beside(document.as_ref(), self.summary),
            document,
        })
    }
}

impl Answer {
    /// Writes the document, and the summary that `text` makes.
    pub(super) fn write(
        &self,
        document: &impl Serialize,
        text: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        self.write_content(|| Ok(output::json(document)?.into()), text)
    }

    /// Writes the content of a file that `content` makes, and the summary that `text` makes.
    pub(super) fn write_content(
        &self,
        content: impl FnOnce() -> Result<Vec<u8>, Failure>,
        text: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        if let Some(destination) = &self.document {
            destination.write(&content()?)?;
        }
        match self.summary {
            Summary::None => Ok(()),
            place => place.print(&text()),
        }
    }
}

/// Where a summary goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Summary {
    /// Nowhere.
    None,
    /// To standard output.
    Output,
    /// To standard error, because the document goes to standard output.
    Error,
}

impl Summary {
    /// Beside a document: where it is requested, or on a terminal that has no document on it.
    pub(super) fn beside(document: Option<&Destination>, requested: bool) -> Self {
        let taken = matches!(document, Some(Destination::Stream));
        match (requested, taken) {
            (true, true) => Self::Error,
            (true, false) => Self::Output,
            (false, false) if stdout().is_terminal() => Self::Output,
            (false, _) => Self::None,
        }
    }

    /// Prints a text, unless it goes nowhere.
    pub(super) fn print(self, text: &str) -> Result<(), Failure> {
        match self {
            Self::None => Ok(()),
            Self::Output => output::print(text),
            Self::Error => {
                output::remark(text);
                Ok(())
            }
        }
    }
}
