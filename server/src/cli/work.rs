//! `slewplan work`: solves the jobs of a shared database.

use super::Exit;
use super::database::DatabaseOption;
use super::failure::Failure;
use super::log::LogOptions;
use super::output;
use super::worker::WorkerOptions;
use crate::service::working::{self, WorkSettings};
use crate::store::DatabaseAddress;
use std::net::SocketAddr;

/// Arguments of `work`.
#[derive(Debug, clap::Args)]
pub(super) struct WorkArguments {
    #[command(flatten)]
    database: DatabaseOption,
    #[command(flatten)]
    worker: WorkerOptions,
    /// Address that answers /metrics, /health/live and /health/ready [default: none]
    #[arg(long, env = "SLEWPLAN_METRICS", value_name = "ADDRESS")]
    metrics: Option<SocketAddr>,
    #[command(flatten)]
    log: LogOptions,
}

/// Solves until a signal ends it.
pub(super) fn run(arguments: &WorkArguments) -> Result<Exit, Failure> {
    if let DatabaseAddress::File(_) = &arguments.database.database {
        return Err(Failure::Setting {
            name: "--database",
            what: "a file is for one service, which solves its jobs itself; several processes \
                share postgres://user@host/name"
                .into(),
        });
    }
    arguments.log.start()?;
    let settings = WorkSettings {
        database: arguments.database.database.clone(),
        metrics: arguments.metrics,
        database_connections: arguments.worker.database_connections(),
        threads: arguments.worker.threads(),
        jobs: arguments.worker.jobs(),
        job_memory: arguments.worker.job_memory(),
        spread_legs: arguments.worker.spread_legs(),
    };
    working::run::<Failure>(&settings, |metrics| {
        let metrics = metrics.map(|address| format!("metrics on http://{address}\n"));
        let metrics = metrics.unwrap_or_default();
        output::print(&format!("working on {}\n{metrics}", settings.database))
    })?;
    Ok(Exit::Complete)
}
