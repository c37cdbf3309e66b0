//! `slewplan import`: imports legs that were solved elsewhere into a database.

use super::database::DatabaseOption;
use super::failure::Failure;
use super::solve::{Threads, start_pool};
use super::{Exit, input, output, runtime};
use crate::cli::signals;
use crate::documents::leg_import::LegImportDocument;
use crate::jobs::leg_import;
use crate::service::ServiceError;
use slewplan_solver::run::stop::StopSignal;
use std::path::PathBuf;

/// Arguments of `import`.
#[derive(Debug, clap::Args)]
pub(super) struct ImportArguments {
    /// A file of legs --trajectories, whole or a shard, - for standard input
    file: PathBuf,
    #[command(flatten)]
    database: DatabaseOption,
    #[command(flatten)]
    threads: Threads,
}

/// Checks every leg, stores those that pass, and prints the counts and the refused legs.
pub(super) fn run(arguments: &ImportArguments) -> Result<Exit, Failure> {
    let read = leg_import::read(&input::document(&arguments.file)?);
    let import = read.map_err(|problems| Failure::Invalid {
        name: input::name(&arguments.file),
        problems,
    })?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let Some(checked) = import.check(&pool, &stop) else {
        return Ok(received.exit_code().map_or(Exit::Failed, Exit::Signalled));
    };
    let counts = runtime::with_store(&arguments.database.database, async |store| {
        Ok(checked.store(store).await.map_err(ServiceError::from)?)
    })?;
    let document = LegImportDocument::new(counts, &checked.refused);
    output::print(&output::json(&document)?)?;
    if checked.refused.is_empty() {
        return Ok(Exit::Complete);
    }
    output::complain(&format!("{} legs are refused", checked.refused.len()));
    Ok(Exit::Negative)
}
