//! Why a command could not do its work.

use super::Exit;
use crate::service::ServiceError;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::run::pool::PoolError;
use std::fmt::Write;
use std::io;
use std::net::SocketAddr;

/// Ends a command with a message on standard error.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// An input that cannot be opened or read.
    #[error("cannot read {name}: {source}")]
    Unreadable {
        /// The input as the caller named it.
        name: String,
        /// What the operating system says.
        source: io::Error,
    },
    /// An input of a size that cannot be meant.
    #[error("cannot read {name}: it is larger than {limit_mib} MiB")]
    TooLarge {
        /// The input as the caller named it.
        name: String,
        /// The limit, MiB.
        limit_mib: u64,
    },
    /// Two inputs from one stream.
    #[error("only one input can be - (standard input); name a file for the other")]
    StandardInputTwice,
    /// An input with problems.
    #[error("{}", listing(name, problems))]
    Invalid {
        /// The input as the caller named it.
        name: String,
        /// Everything that is wrong with it.
        problems: Vec<Problem>,
    },
    /// Inputs that do not fit together; problems of all of them together have no name.
    #[error("{}", listings(problems))]
    Misfits {
        /// Everything that is wrong, with the input that it is wrong with.
        problems: Vec<(Option<String>, Problem)>,
    },
    /// An output that cannot be written.
    #[error("cannot write {name}: {source}")]
    Unwritable {
        /// The output as the caller named it.
        name: String,
        /// What the operating system says.
        source: io::Error,
    },
    /// A setting that means nothing.
    #[error("{name}: {what}")]
    Setting {
        /// The setting.
        name: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// The service cannot run.
    #[error(transparent)]
    Service(#[from] ServiceError),
    /// A service that is not there or cannot take work.
    #[error("not well: http://{address}{route}: {what}")]
    Unhealthy {
        /// Where it was asked.
        address: SocketAddr,
        /// What it was asked for.
        route: &'static str,
        /// What it said, or why it said nothing.
        what: String,
    },
    /// The operating system refused threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The operating system refused signal handlers.
    #[error("cannot listen for signals: {0}")]
    Signals(io::Error),
    /// An answer that must not be given.
    #[error("internal error: the answer cannot be written: {0}")]
    Unspeakable(String),
}

impl Failure {
    /// The exit code.
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Unreadable { .. }
            | Self::TooLarge { .. }
            | Self::StandardInputTwice
            | Self::Setting { .. }
            | Self::Service(ServiceError::NoKeysOnPublicAddress(_))
            | Self::Invalid { .. }
            | Self::Misfits { .. } => Exit::Invalid,
            Self::Unwritable { .. }
            | Self::Service(_)
            | Self::Unhealthy { .. }
            | Self::Pool(_)
            | Self::Signals(_)
            | Self::Unspeakable(_) => Exit::Failed,
        }
    }
}

/// Problems of several inputs as text, those of one input in a row.
fn listings(problems: &[(Option<String>, Problem)]) -> String {
    let mut names: Vec<&Option<String>> = problems.iter().map(|(name, _)| name).collect();
    names.dedup();
    let part = |name: &&Option<String>| {
        let of_it = problems.iter().filter(|(other, _)| other == *name);
        let found: Vec<Problem> = of_it.map(|(_, problem)| problem.clone()).collect();
        listing(name.as_deref().unwrap_or("the table of all files"), &found)
    };
    let parts: Vec<String> = names.iter().map(part).collect();
    parts.join("\n")
}

/// Problems as text: a head line and one paragraph each.
pub(super) fn listing(name: &str, problems: &[Problem]) -> String {
    let plural = if problems.len() == 1 { "" } else { "s" };
    let mut text = format!("{name} is not valid: {} problem{plural}", problems.len());
    for problem in problems {
        // Writing into a text cannot fail.
        let _ = write!(text, "\n{problem}");
    }
    text
}
