//! Progress on standard error: a bar for terminals, JSON lines for programs.

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
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

/// The observer for a mode; the time limit, s, is that of the work it observes.
pub(crate) fn observer(mode: ProgressMode, time_limit_s: Option<f64>) -> Box<dyn Observer> {
    let clock = Clock {
        begin: Instant::now(),
        limit_s: time_limit_s,
    };
    match mode {
        ProgressMode::Auto if std::io::stderr().is_terminal() => Box::new(Bar::new(clock)),
        ProgressMode::Json => Box::new(JsonLines::new(clock)),
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

/// The time of the work.
#[derive(Debug, Clone, Copy)]
struct Clock {
    begin: Instant,
    limit_s: Option<f64>,
}

impl Clock {
    fn elapsed_s(&self, now: Instant) -> f64 {
        (now - self.begin).as_secs_f64()
    }

    /// What is left of the time limit, s.
    fn left_s(&self, now: Instant) -> Option<f64> {
        Some((self.limit_s? - self.elapsed_s(now)).max(0.0))
    }

    /// Elapsed time and what is left of the limit, in whole seconds.
    fn words(&self, now: Instant) -> String {
        let elapsed = self.elapsed_s(now);
        match self.left_s(now) {
            Some(left) => format!("{elapsed:.0} s, {left:.0} s left"),
            None => format!("{elapsed:.0} s"),
        }
    }
}

/// A progress bar with steps, time, incumbent, bound and gap.
struct Bar(ProgressBar, Clock);

impl Bar {
    fn new(clock: Clock) -> Self {
        // Hidden counters until the first report.
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar, clock)
    }
}

impl Observer for Bar {
    fn progress(&self, progress: Progress) {
        let (bar, clock) = (&self.0, self.1);
        let template = match progress.total {
            Some(_) => "{prefix} [{bar:24}] {msg}  {time}{standing}",
            None => "{prefix} {spinner} {msg}  {time}{standing}",
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            let standing = standing(&progress);
            // Asked for at every tick, so that the time goes on between two reports.
            let time = move |_: &ProgressState, text: &mut dyn std::fmt::Write| {
                let _ = text.write_str(&clock.words(Instant::now()));
            };
            let standing = move |_: &ProgressState, text: &mut dyn std::fmt::Write| {
                let _ = text.write_str(&standing);
            };
            bar.set_style(style.with_key("time", time).with_key("standing", standing));
        }
        match progress.total {
            Some(total) => bar.set_length(total),
            None => bar.unset_length(),
        }
        bar.set_prefix(<&str>::from(progress.stage));
        bar.set_position(progress.done);
        bar.set_message(steps(&progress));
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

/// The steps of a stage, with what they are.
fn steps(progress: &Progress) -> String {
    let (done, total) = (progress.done, progress.total);
    let of = total.map_or_else(String::new, |total| format!(" of {total}"));
    match progress.stage {
        Stage::Legs => format!("{done}{of} legs"),
        Stage::Search if done == 1 && total.is_none() => "1 node".to_owned(),
        Stage::Search => format!("{done}{of} nodes"),
        Stage::Verify => "integrating the plan again".to_owned(),
    }
}

/// Values, best plan, bound and gap, as far as they are known.
fn standing(progress: &Progress) -> String {
    let seconds = |label, value: Option<f64>| {
        value.map_or_else(String::new, |value| format!("  {label} {value:.3} s"))
    };
    let gap = progress
        .relative_gap()
        .map_or_else(String::new, |gap| format!("  gap {:.3} %", gap * 100.0));
    let value = match (progress.value, progress.value_bound) {
        (Some(value), Some(bound)) if bound > 0.0 => format!("  value {value} of at most {bound}"),
        _ => String::new(),
    };
    let incumbent = seconds("best plan", progress.incumbent_s);
    format!(
        "{value}{incumbent}{}{gap}",
        seconds("lower bound", progress.lower_bound_s)
    )
}

/// JSON lines: every change of stage, incumbent, value or bound, else at most ten lines per second.
struct JsonLines {
    clock: Clock,
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
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value_bound: Option<f64>,
    elapsed_s: f64,
    /// What is left of the time limit; `null` without one.
    time_left_s: Option<f64>,
}

const MIN_PAUSE: Duration = Duration::from_millis(100);

impl JsonLines {
    fn new(clock: Clock) -> Self {
        Self {
            clock,
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
            value: progress.value.filter(|value| value.is_finite()),
            value_bound: progress.value_bound.filter(|value| value.is_finite()),
            elapsed_s: self.clock.elapsed_s(now),
            time_left_s: self.clock.left_s(now),
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
    let key = |p: &Progress| {
        let values = (p.value, p.value_bound);
        (p.stage, p.incumbent_s, p.lower_bound_s, values)
    };
    key(shown) != key(progress)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(stage: Stage, done: u64, total: Option<u64>) -> Progress {
        Progress {
            stage,
            done,
            total,
            incumbent_s: Some(50.0),
            lower_bound_s: Some(40.0),
            value: None,
            value_bound: None,
        }
    }

    #[test]
    fn the_numbers_of_a_stage_have_their_names() {
        assert_eq!(steps(&at(Stage::Legs, 3, Some(42))), "3 of 42 legs");
        assert_eq!(steps(&at(Stage::Search, 1, None)), "1 node");
        assert_eq!(steps(&at(Stage::Search, 7, None)), "7 nodes");
        let standing = standing(&at(Stage::Search, 7, None));
        assert_eq!(
            standing,
            "  best plan 50.000 s  lower bound 40.000 s  gap 20.000 %"
        );
        let valued = Progress {
            value: Some(3.0),
            value_bound: Some(4.5),
            ..at(Stage::Search, 7, None)
        };
        assert!(super::standing(&valued).starts_with("  value 3 of at most 4.5  best plan"));
    }

    #[test]
    fn what_is_left_of_the_limit_is_never_below_zero() {
        let begin = Instant::now();
        let clock = |limit_s| Clock { begin, limit_s };
        let now = begin + Duration::from_secs(20);
        assert_eq!(clock(Some(60.0)).words(now), "20 s, 40 s left");
        assert_eq!(clock(Some(15.0)).words(now), "20 s, 0 s left");
        assert_eq!(clock(None).words(now), "20 s");
    }
}
