//! The clock of a scenario: windows of the targets and the latest end.

use super::Window;
use crate::model::epoch;
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::{MAX_TIME_S, MAX_WINDOWS, ScenarioSpec, TargetSpec, WindowSpec};
use jiff::civil::DateTime;

/// What dates and windows are compared with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Calendar {
    epoch: Option<DateTime>,
    /// Whether an epoch is written, valid or not.
    epoch_given: bool,
    latest_end: Option<f64>,
}

/// When the schedule ends at the latest.
pub(super) fn read_latest_end(latest: f64, findings: &mut Findings) -> Option<f64> {
    let latest = findings.positive("/latest_end_s", latest)?;
    is_moderate(latest, "/latest_end_s", findings).then_some(latest)
}

impl Calendar {
    /// The calendar of a description whose epoch has been read.
    pub(super) fn of(spec: &ScenarioSpec, epoch: Option<DateTime>) -> Self {
        Self {
            epoch,
            epoch_given: spec.epoch.is_some(),
            // One that is refused excludes no window.
            latest_end: spec.latest_end_s.filter(|latest| *latest > 0.0),
        }
    }

    /// The windows that are listed for a target, in order of time.
    pub(super) fn windows(
        &self,
        listed: &[WindowSpec],
        target: &TargetSpec,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Vec<Window>> {
        let pointer = format!("{pointer}/windows");
        if !findings.at_most(&pointer, listed.len(), MAX_WINDOWS) {
            return None;
        }
        let at = |i: usize| format!("{pointer}/{i}");
        // All are read before they are collected: collecting into an option stops at the first fault.
        let read: Vec<Option<Window>> = listed
            .iter()
            .enumerate()
            .map(|(i, window)| self.window(window, &at(i), findings))
            .collect();
        let mut windows: Vec<(usize, Window)> = read
            .into_iter()
            .enumerate()
            .map(|(i, window)| Some((i, window?)))
            .collect::<Option<_>>()?;
        windows.sort_by(|a, b| a.1.from.total_cmp(&b.1.from));
        let mut disjoint = true;
        for pair in windows.windows(2) {
            let [(one, before), (other, after)] = [pair[0], pair[1]];
            if after.from < before.to {
                disjoint = false;
                findings.refuse(
                    at(one.max(other)),
                    Code::WindowsOverlap,
                    format!(
                        "the windows {one} and {other} of the target overlap from {} s on",
                        after.from
                    ),
                    "join windows that overlap",
                );
            }
        }
        for &(i, window) in &windows {
            self.warn_of_unusable(target, window, &at(i), findings);
        }
        disjoint.then(|| windows.into_iter().map(|(_, window)| window).collect())
    }

    fn window(&self, spec: &WindowSpec, pointer: &str, findings: &mut Findings) -> Option<Window> {
        let from = self.time(
            (spec.from_s, spec.from.as_deref()),
            (pointer, "from"),
            findings,
        );
        let to = self.time((spec.to_s, spec.to.as_deref()), (pointer, "to"), findings);
        let (from, to) = (from?, to?);
        if from < to {
            return Some(Window { from, to });
        }
        findings.refuse(
            pointer,
            Code::EmptyRange,
            format!("the window begins at {from} s and ends at {to} s, not after its begin"),
            "exchange begin and end, or leave the window out",
        );
        None
    }

    /// One end of a window, s from time zero, which is written as seconds or as a date.
    fn time(
        &self,
        (seconds, date): (Option<f64>, Option<&str>),
        (pointer, name): (&str, &str),
        findings: &mut Findings,
    ) -> Option<f64> {
        let (code, message) = match (seconds, date) {
            (Some(seconds), None) => {
                let pointer = format!("{pointer}/{name}_s");
                let seconds = findings.finite(&pointer, seconds)?;
                return is_moderate(seconds, &pointer, findings).then_some(seconds);
            }
            (None, Some(date)) => {
                let pointer = format!("{pointer}/{name}");
                let seconds = self.seconds_at(date, &pointer, findings)?;
                return is_moderate(seconds, &pointer, findings).then_some(seconds);
            }
            (Some(_), Some(_)) => (
                Code::ConflictingFields,
                format!("both {name}_s and {name} are given"),
            ),
            (None, None) => (Code::MissingField, format!("the window has no {name}_s")),
        };
        let hint = format!("give {name}_s in seconds from time zero, or {name} as a date");
        findings.refuse(pointer, code, message, hint);
        None
    }

    /// Seconds from the epoch to a date in the same time system. Days have 86,400 s.
    fn seconds_at(&self, date: &str, pointer: &str, findings: &mut Findings) -> Option<f64> {
        if !self.epoch_given {
            findings.refuse(
                pointer,
                Code::EpochRequired,
                "the window is given by a date, but the scenario has no epoch of time zero",
                "give the epoch, or the window in seconds",
            );
            return None;
        }
        let Some(date) = epoch::parse(date) else {
            let short: String = date.chars().take(40).collect();
            findings.refuse(
                pointer,
                Code::InvalidEpoch,
                format!("{short:?} is no calendar date with a time"),
                "write YYYY-MM-DDThh:mm:ss in the time system of the epoch, such as \
                 2026-01-31T12:00:00.5Z",
            );
            return None;
        };
        // An epoch that cannot be read is reported where it stands.
        Some(date.duration_since(self.epoch?).as_secs_f64())
    }

    /// Warns of a window in which no visit fits, whatever the plan.
    fn warn_of_unusable(
        &self,
        target: &TargetSpec,
        window: Window,
        pointer: &str,
        findings: &mut Findings,
    ) {
        let stay = (target.settle_s + target.dwell_s).max(0.0);
        let latest = self.latest_end.unwrap_or(f64::INFINITY);
        let message = if window.to - window.from < stay {
            format!(
                "the window is {} s long, shorter than settle and dwell of {stay} s",
                window.to - window.from
            )
        } else if window.to - stay < 0.0 {
            format!("the window ends at {} s, too early for a visit", window.to)
        } else if window.from + stay > latest {
            format!(
                "the window begins at {} s, too late for a visit before the latest end at {latest} s",
                window.from
            )
        } else {
            return;
        };
        let hint = "look for a wrong unit or epoch; no visit can lie in this window";
        findings.warn(pointer, Code::WindowUnusable, message, hint);
    }
}

/// Whether a time is within the times of schedules.
fn is_moderate(time: f64, pointer: &str, findings: &mut Findings) -> bool {
    let moderate = time.abs() <= MAX_TIME_S;
    if !moderate {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!("the time is {time:e} s from time zero, beyond {MAX_TIME_S:e} s"),
            "write seconds from time zero; look for a wrong unit",
        );
    }
    moderate
}
