//! `slewplan work`: solves the jobs of a shared database.

use super::Exit;
use super::failure::Failure;
use super::log::LogOptions;
use super::output;
use crate::service::working::{self, WorkSettings};
use crate::store::DatabaseAddress;

/// Arguments of `work`.
#[derive(Debug, clap::Args)]
pub(super) struct WorkArguments {
    /// Database on a Postgres server, the same as that of the services
    #[arg(long, env = "SLEWPLAN_DATABASE", value_name = "URL")]
    database: DatabaseAddress,
    /// Threads of the solver [default: one per core]
    #[arg(long, env = "SLEWPLAN_THREADS", value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Memory limit of one job, MiB
    #[arg(long, env = "SLEWPLAN_JOB_MEMORY", value_name = "MIB", default_value_t = 1024,
        value_parser = clap::value_parser!(u32).range(16..))]
    job_memory: u32,
    #[command(flatten)]
    log: LogOptions,
}

/// Solves until a signal ends it.
pub(super) fn run(arguments: &WorkArguments) -> Result<Exit, Failure> {
    if let DatabaseAddress::File(_) = &arguments.database {
        return Err(Failure::Setting {
            name: "--database",
            what: "a file is for one service, which solves its jobs itself; several processes \
                share postgres://user@host/name"
                .into(),
        });
    }
    arguments.log.start()?;
    let settings = WorkSettings {
        database: arguments.database.clone(),
        threads: arguments.threads.map(usize::from),
        job_memory: u64::from(arguments.job_memory) << 20,
    };
    working::run::<Failure>(&settings, || {
        output::print(&format!("working on {}\n", settings.database))
    })?;
    Ok(Exit::Complete)
}
