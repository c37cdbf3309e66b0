//! `slewplan serve`: runs the service.

use super::Exit;
use super::failure::Failure;
use super::output;
use crate::api::AllowedHost;
use crate::service::{self, ServiceSettings};
use crate::store::{DatabaseAddress, QueueLimits};
use clap::ValueEnum;
use std::net::SocketAddr;
use std::time::Duration;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::prelude::*;

const DAY: Duration = Duration::from_hours(24);

/// Arguments of `serve`.
#[derive(Debug, clap::Args)]
pub(super) struct ServeArguments {
    /// Address to listen on; port 0 stands for any free port
    #[arg(long, env = "SLEWPLAN_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Database: a file, created when it does not exist, or the URL of one on a Postgres server
    #[arg(
        long,
        env = "SLEWPLAN_DATABASE",
        value_name = "FILE|URL",
        default_value = "slewplan.db"
    )]
    database: DatabaseAddress,
    /// Threads of the solver [default: one per core]
    #[arg(long, env = "SLEWPLAN_THREADS", value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
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
    /// Memory limit of one job, MiB
    #[arg(long, env = "SLEWPLAN_JOB_MEMORY", value_name = "MIB", default_value_t = 1024,
        value_parser = clap::value_parser!(u32).range(16..))]
    job_memory: u32,
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
    /// Format of the log on standard error
    #[arg(long, env = "SLEWPLAN_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    log_format: LogFormat,
    /// Level of the log, or levels by module
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
    /// Plain text
    Text,
    /// One JSON object per line
    Json,
}

/// Serves until a signal ends it.
pub(super) fn run(arguments: &ServeArguments) -> Result<Exit, Failure> {
    start_log(arguments)?;
    let settings = ServiceSettings {
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
        allowed_hosts: arguments.allowed_host.clone(),
        legs: arguments.leg_cache.into(),
        connections: arguments.max_connections.into(),
    };
    service::run::<Failure>(&settings, |address| {
        output::print(&format!("listening on http://{address}\n"))
    })?;
    Ok(Exit::Complete)
}

fn start_log(arguments: &ServeArguments) -> Result<(), Failure> {
    let filter = log_filter(&arguments.log)?;
    let log = tracing_subscriber::fmt::layer()
        // A log that cannot be written, because its disk is full, must not become a panic.
        .log_internal_errors(false)
        .with_writer(std::io::stderr);
    let log = match arguments.log_format {
        LogFormat::Text => log.with_ansi(false).boxed(),
        LogFormat::Json => log.json().boxed(),
    };
    tracing_subscriber::registry()
        .with(log.with_filter(filter))
        .init();
    // A panic ends one job or request only and is logged.
    std::panic::set_hook(Box::new(|info| {
        let message = info.payload_as_str().unwrap_or("no message");
        let place = info.location().map(ToString::to_string).unwrap_or_default();
        tracing::error!(message, place, "panic");
    }));
    Ok(())
}

/// An empty filter, as of a variable that is set to nothing, must not hide errors.
fn log_filter(filter: &str) -> Result<Targets, Failure> {
    let filter = if filter.trim().is_empty() {
        "error"
    } else {
        filter
    };
    filter.parse().map_err(|error| Failure::Setting {
        name: "--log",
        what: format!("{error}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracing::Level;

    #[test]
    fn an_empty_log_filter_shows_errors() {
        for empty in ["", " "] {
            let filter = log_filter(empty).unwrap();
            assert!(filter.would_enable("slewplan_server", &Level::ERROR));
            assert!(!filter.would_enable("slewplan_server", &Level::WARN));
        }
        let filter = log_filter("warn,slewplan_server::store=debug").unwrap();
        assert!(filter.would_enable("slewplan_server::store", &Level::DEBUG));
        assert!(!filter.would_enable("slewplan_server::api", &Level::INFO));
        assert!(log_filter("loudly=often").is_err());
    }
}
