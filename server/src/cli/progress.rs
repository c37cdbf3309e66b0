//! Progress on standard error: a bar for terminals, JSON lines for programs.

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use slewplan_solver::run::contradiction::Contradiction;
use slewplan_solver::run::progress::{Observer, Progress, Stage};
use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProgressMode {
    /// A bar when standard error is a terminal, nothing otherwise
    Auto,
    /// One JSON object per line
    Json,
    /// Nothing
    None,
}

/// The observer for a mode.
pub(crate) fn observer(mode: ProgressMode) -> Box<dyn Observer> {
    match mode {
        ProgressMode::Auto if std::io::stderr().is_terminal() => Box::new(Bar::new()),
        ProgressMode::Json => Box::new(JsonLines::new()),
        ProgressMode::Auto | ProgressMode::None => Box::new(Quiet),
    }
}

/// Reports contradictions only.
struct Quiet;

impl Observer for Quiet {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, contradiction: &Contradiction) {
        complain(&format!("error: {contradiction}"));
    }
}

/// Writes a line to standard error. A failure of this does not stop the solve.
fn complain(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A progress bar with incumbent, bound, gap and elapsed time.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        // Hidden counters until the first report.
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }
}

impl Observer for Bar {
    fn progress(&self, progress: Progress) {
        let bar = &self.0;
        let template = match progress.total {
            Some(_) => "{prefix:<6} [{bar:24}] {pos}/{len} {elapsed} {msg}",
            None => "{prefix:<6} {spinner} {pos} {elapsed} {msg}",
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        match progress.total {
            Some(total) => bar.set_length(total),
            None => bar.unset_length(),
        }
        bar.set_prefix(<&str>::from(progress.stage));
        bar.set_position(progress.done);
        bar.set_message(status(&progress));
    }

    fn contradicted(&self, contradiction: &Contradiction) {
        self.0.println(format!("error: {contradiction}"));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

fn status(progress: &Progress) -> String {
    let seconds = |label, value: Option<f64>| {
        value.map_or_else(String::new, |value| format!("  {label} {value:.3} s"))
    };
    let gap = progress
        .relative_gap()
        .map_or_else(String::new, |gap| format!("  gap {:.3} %", gap * 100.0));
    let incumbent = seconds("best", progress.incumbent_s);
    format!(
        "{incumbent}{}{gap}",
        seconds("bound", progress.lower_bound_s)
    )
}

/// JSON lines: every change of stage, incumbent or bound, else at most ten lines per second.
struct JsonLines {
    begin: Instant,
    last: Mutex<Option<(Instant, Progress)>>,
}

#[derive(Serialize)]
struct ProgressLine {
    stage: &'static str,
    done: u64,
    total: Option<u64>,
    incumbent_s: Option<f64>,
    lower_bound_s: Option<f64>,
    relative_gap: Option<f64>,
    elapsed_s: f64,
}

const MIN_PAUSE: Duration = Duration::from_millis(100);

impl JsonLines {
    fn new() -> Self {
        Self {
            begin: Instant::now(),
            last: Mutex::new(None),
        }
    }

    fn line(&self, progress: &Progress, now: Instant) -> ProgressLine {
        ProgressLine {
            stage: progress.stage.into(),
            done: progress.done,
            total: progress.total,
            incumbent_s: progress.incumbent_s.filter(|value| value.is_finite()),
            lower_bound_s: progress.lower_bound_s.filter(|value| value.is_finite()),
            relative_gap: progress.relative_gap().filter(|value| value.is_finite()),
            elapsed_s: (now - self.begin).as_secs_f64(),
        }
    }
}

impl Observer for JsonLines {
    fn progress(&self, progress: Progress) {
        let now = Instant::now();
        // Locked while writing, so that lines of several threads do not mix.
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_some_and(|(at, shown)| now - at < MIN_PAUSE && !news(&shown, &progress)) {
            return;
        }
        *last = Some((now, progress));
        if let Ok(text) = serde_json::to_string(&self.line(&progress, now)) {
            complain(&text);
        }
    }

    fn contradicted(&self, contradiction: &Contradiction) {
        complain(&serde_json::json!({"error": contradiction.to_string()}).to_string());
    }
}

fn news(shown: &Progress, progress: &Progress) -> bool {
    let key = |p: &Progress| -> (Stage, Option<f64>, Option<f64>) {
        (p.stage, p.incumbent_s, p.lower_bound_s)
    };
    key(shown) != key(progress)
}
