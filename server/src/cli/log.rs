//! The log of the service and of workers.

use super::failure::Failure;
use clap::ValueEnum;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::prelude::*;

/// Options of the log.
#[derive(Debug, clap::Args)]
pub(super) struct LogOptions {
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

impl LogOptions {
    /// Starts the log.
    pub(super) fn start(&self) -> Result<(), Failure> {
        let filter = log_filter(&self.log)?;
        let log = tracing_subscriber::fmt::layer()
            // A log that cannot be written, because its disk is full, must not become a panic.
            .log_internal_errors(false)
            .with_writer(std::io::stderr);
        let log = match self.log_format {
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
