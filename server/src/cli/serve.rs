//! `slewplan serve`: runs the service.

use super::Exit;
use super::database::DatabaseOption;
use super::failure::Failure;
use super::log::LogOptions;
use super::output;
use super::worker::WorkerOptions;
use crate::api::AllowedHost;
use crate::service::{self, ServiceSettings};
use crate::store::{DatabaseAddress, QueueLimits};
use std::net::SocketAddr;
use std::time::Duration;

const DAY: Duration = Duration::from_hours(24);

/// Arguments of `serve`.
#[derive(Debug, clap::Args)]
pub(super) struct ServeArguments {
    /// Address to listen on; port 0 stands for any free port
    #[arg(long, env = "SLEWPLAN_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    #[command(flatten)]
    database: DatabaseOption,
    #[command(flatten)]
    worker: WorkerOptions,
    /// Maximum size of a request body, bytes
    #[arg(long, env = "SLEWPLAN_MAX_BODY_BYTES", value_name = "BYTES", default_value_t = 4 << 20,
        value_parser = clap::value_parser!(u32).range(1024..))]
    max_body_bytes: u32,
    /// Maximum number of targets of a scenario
    #[arg(long, env = "SLEWPLAN_MAX_TARGETS", value_name = "N", default_value_t = 1000,
        value_parser = clap::value_parser!(u32).range(1..))]
    max_targets: u32,
    /// Maximum number of queued jobs
    #[arg(
        long,
        env = "SLEWPLAN_QUEUE_LIMIT",
        value_name = "N",
        default_value_t = 1000
    )]
    queue_limit: u32,
    /// Maximum number of queued jobs of one client, where keys are required
    #[arg(
        long,
        env = "SLEWPLAN_CLIENT_QUEUE_LIMIT",
        value_name = "N",
        default_value_t = 100
    )]
    client_queue_limit: u32,
    /// Require no keys, at any address and even if there are some
    #[arg(long, env = "SLEWPLAN_NO_KEYS")]
    no_keys: bool,
    /// Name or address by which the service is reached, beside localhost and the one it listens on;
    /// repeatable. Pages of that name may use it, at a port other than 80 and 443 only with NAME:PORT
    #[arg(
        long,
        env = "SLEWPLAN_ALLOWED_HOST",
        value_name = "NAME",
        value_delimiter = ','
    )]
    allowed_host: Vec<AllowedHost>,
    /// Days for which ended jobs are kept, with their plans and idempotency keys [default: without
    /// end]
    #[arg(long, env = "SLEWPLAN_RETAIN", value_name = "DAYS",
        value_parser = clap::value_parser!(u32).range(1..=36_500))]
    retain: Option<u32>,
    /// Maximum number of cached legs; the oldest are deleted first
    #[arg(long, env = "SLEWPLAN_LEG_CACHE", value_name = "N", default_value_t = 1_000_000,
        value_parser = clap::value_parser!(u32).range(1..))]
    leg_cache: u32,
    /// Maximum number of connections
    #[arg(long, env = "SLEWPLAN_MAX_CONNECTIONS", value_name = "N", default_value_t = 512,
        value_parser = clap::value_parser!(u16).range(1..))]
    max_connections: u16,
    /// Solve no jobs in this process: slewplan work does, on the same database of Postgres
    #[arg(long, env = "SLEWPLAN_NO_WORKER")]
    no_worker: bool,
    #[command(flatten)]
    log: LogOptions,
}

/// Serves until a signal ends it.
pub(super) fn run(arguments: &ServeArguments) -> Result<Exit, Failure> {
    let shared = matches!(arguments.database.database, DatabaseAddress::Postgres(_));
    if arguments.no_worker && !shared {
        return Err(Failure::Setting {
            name: "--no-worker",
            what: "nobody else could solve the jobs of a file".into(),
        });
    }
    arguments.log.start()?;
    let settings = ServiceSettings {
        listen: arguments.listen,
        database: arguments.database.database.clone(),
        database_connections: arguments.worker.database_connections(),
        threads: arguments.worker.threads(),
        jobs: if arguments.no_worker {
            0
        } else {
            arguments.worker.jobs()
        },
        max_body_bytes: arguments.max_body_bytes as usize,
        max_targets: arguments.max_targets as usize,
        queue: QueueLimits {
            all: arguments.queue_limit.into(),
            client: arguments.client_queue_limit.into(),
        },
        retain: arguments.retain.map(|days| DAY * days),
        job_memory: arguments.worker.job_memory(),
        spread_legs: arguments.worker.spread_legs(),
        no_keys: arguments.no_keys,
        allowed_hosts: arguments.allowed_host.clone(),
        legs: arguments.leg_cache.into(),
        connections: arguments.max_connections.into(),
    };
    service::run::<Failure>(&settings, |address| {
        output::print(&format!("listening on http://{address}\n"))
    })?;
    Ok(Exit::Complete)
}
