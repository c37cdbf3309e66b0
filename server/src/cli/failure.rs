//! Errors that end a command.

use super::Exit;
use crate::service::ServiceError;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::run::pool::PoolError;
use std::fmt::Write;
use std::io;
use std::net::SocketAddr;

/// An error that ends a command with a message on standard error.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// An input that cannot be opened or read.
    #[error("cannot read {name}: {source}")]
    Unreadable {
        /// The input as the caller named it.
        name: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// An input beyond the limit of its size.
    #[error("cannot read {name}: it is larger than {limit_mib} MiB")]
    TooLarge {
        /// The input as the caller named it.
        name: String,
        /// The limit, MiB.
        limit_mib: u64,
    },
    /// Two inputs from standard input.
    #[error("only one input can be - (standard input); name a file for the other")]
    StandardInputTwice,
    /// An input with problems.
    #[error("{}", listing(name, problems))]
    Invalid {
        /// The input as the caller named it.
        name: String,
        /// All its problems.
        problems: Vec<Problem>,
    },
    /// Inputs that do not fit together; problems of all of them as a whole have no name.
    #[error("{}", listings(problems))]
    Misfits {
        /// All problems, each with its input.
        problems: Vec<(Option<String>, Problem)>,
    },
    /// An output that cannot be written.
    #[error("cannot write {name}: {source}")]
    Unwritable {
        /// The output as the caller named it.
        name: String,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A setting with an invalid value.
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
    /// A service that does not answer or cannot take work.
    #[error("not healthy: http://{address}{route}: {what}")]
    Unhealthy {
        /// Address of the service.
        address: SocketAddr,
        /// Route of the request.
        route: &'static str,
        /// Its answer, or why there is none.
        what: String,
    },
    /// The operating system refused threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// The operating system refused signal handlers.
    #[error("cannot listen for signals: {0}")]
    Signals(io::Error),
    /// An answer with numbers that JSON cannot represent.
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

/// Problems of several inputs as text, grouped by input.
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

/// The head line of a list of problems.
pub(super) fn heading(name: &str, problems: &[Problem]) -> String {
    let plural = if problems.len() == 1 { "" } else { "s" };
    format!("{name} is not valid: {} problem{plural}", problems.len())
}

/// Problems as text: a head line and one paragraph each.
fn listing(name: &str, problems: &[Problem]) -> String {
    let mut text = heading(name, problems);
    for problem in problems {
        // Writing into a text cannot fail.
        let _ = write!(text, "\n{problem}");
    }
    text
}
