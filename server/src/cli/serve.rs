//! `slewplan serve`: the service.

use super::Exit;
use super::failure::Failure;
use super::output;
use crate::service::{self, Settings};
use crate::store::QueueLimits;
use clap::ValueEnum;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;
use tracing_subscriber::EnvFilter;

const DAY: Duration = Duration::from_hours(24);

/// What `serve` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Address to listen on; port 0 takes any free one
    #[arg(long, env = "SLEWPLAN_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// The database; created when there is none
    #[arg(
        long,
        env = "SLEWPLAN_DATABASE",
        value_name = "FILE",
        default_value = "slewplan.db"
    )]
    database: PathBuf,
    /// Threads of the solver [default: one per core]
    #[arg(long, env = "SLEWPLAN_THREADS", value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Largest body of a request, bytes
    #[arg(long, env = "SLEWPLAN_MAX_BODY_BYTES", value_name = "BYTES", default_value_t = 4 << 20,
        value_parser = clap::value_parser!(u32).range(1024..))]
    max_body_bytes: u32,
    /// Most targets of a scenario
    #[arg(long, env = "SLEWPLAN_MAX_TARGETS", value_name = "N", default_value_t = 200,
        value_parser = clap::value_parser!(u32).range(1..))]
    max_targets: u32,
    /// Most jobs that wait
    #[arg(
        long,
        env = "SLEWPLAN_QUEUE_LIMIT",
        value_name = "N",
        default_value_t = 1000
    )]
    queue_limit: u32,
    /// Memory that one job may take, MiB
    #[arg(long, env = "SLEWPLAN_JOB_MEMORY", value_name = "MIB", default_value_t = 1024,
        value_parser = clap::value_parser!(u32).range(16..))]
    job_memory: u32,
    /// Most jobs of one client that wait, where keys are asked for
    #[arg(
        long,
        env = "SLEWPLAN_CLIENT_QUEUE_LIMIT",
        value_name = "N",
        default_value_t = 100
    )]
    client_queue_limit: u32,
    /// Let everybody in, at any address and whatever keys there are
    #[arg(long, env = "SLEWPLAN_NO_KEYS")]
    no_keys: bool,
    /// Days for which ended jobs are kept, with their plans and idempotency keys [default: for ever]
    #[arg(long, env = "SLEWPLAN_RETAIN", value_name = "DAYS",
        value_parser = clap::value_parser!(u32).range(1..=36_500))]
    retain: Option<u32>,
    /// Most solved legs that are remembered for other jobs; those that were stored first go first
    #[arg(long, env = "SLEWPLAN_LEG_CACHE", value_name = "N", default_value_t = 1_000_000,
        value_parser = clap::value_parser!(u32).range(1..))]
    leg_cache: u32,
    /// Most connections at once
    #[arg(long, env = "SLEWPLAN_MAX_CONNECTIONS", value_name = "N", default_value_t = 512,
        value_parser = clap::value_parser!(u16).range(1..))]
    max_connections: u16,
    /// Form of the log on standard error
    #[arg(long, env = "SLEWPLAN_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    log_format: LogFormat,
    /// What is logged: a level, or levels by module
    #[arg(
        long,
        env = "SLEWPLAN_LOG",
        value_name = "FILTER",
        default_value = "info"
    )]
    log: String,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum LogFormat {
    /// Lines for people
    Text,
    /// One JSON object per line
    Json,
}

/// Serves until a signal ends it.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    start_log(arguments)?;
    let settings = Settings {
        listen: arguments.listen,
        database: arguments.database.clone(),
        threads: arguments.threads.map(usize::from),
        max_body_bytes: arguments.max_body_bytes as usize,
        max_targets: arguments.max_targets as usize,
        queue: QueueLimits {
            all: arguments.queue_limit.into(),
            client: arguments.client_queue_limit.into(),
        },
        retain: arguments.retain.map(|days| DAY * days),
        job_memory: u64::from(arguments.job_memory) << 20,
        no_keys: arguments.no_keys,
        legs: arguments.leg_cache.into(),
        connections: arguments.max_connections.into(),
    };
    service::run::<Failure>(&settings, |address| {
        output::print(&format!("listening on http://{address}\n"))
    })?;
    Ok(Exit::Complete)
}

fn start_log(arguments: &Arguments) -> Result<(), Failure> {
    let filter = EnvFilter::try_new(&arguments.log).map_err(|error| Failure::Setting {
        name: "--log",
        what: error.to_string(),
    })?;
    let log = tracing_subscriber::fmt()
        .with_env_filter(filter)
        // A log that cannot be written, because its disk is full, must not become a panic.
        .log_internal_errors(false)
        .with_writer(std::io::stderr);
    match arguments.log_format {
        LogFormat::Text => log.with_ansi(false).init(),
        LogFormat::Json => log.json().init(),
    }
    // A panic costs one job or request; the log keeps what it was.
    std::panic::set_hook(Box::new(|info| {
        let message = info.payload_as_str().unwrap_or("no message");
        let place = info.location().map(ToString::to_string).unwrap_or_default();
        tracing::error!(message, place, "panic");
    }));
    Ok(())
}
