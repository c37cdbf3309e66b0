//! What a plan says of its schedule: value, targets left out, waits.

use super::blocks::{count, line};
use slewplan_solver::model::plan::{Schedule, SkippedTarget};

/// Targets left out that are named; the rest are counted.
const MAX_NAMED: usize = 10;

/// A number without zeros at its end.
fn plain(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The value in the title; nothing where no target has one.
pub(super) fn in_title(schedule: &Schedule) -> String {
    if has_values(schedule) {
        format!(", value {}", plain(schedule.value))
    } else {
        String::new()
    }
}

/// Lines about value, targets left out and waits.
pub(super) fn lines(schedule: &Schedule) -> String {
    let mut text = String::new();
    if has_values(schedule) {
        let (value, bound) = (schedule.value, schedule.value_bound);
        let gap = 100.0 * (bound - value).max(0.0) / bound;
        text += &line(
            "value",
            format_args!("{}, at most {}, gap {gap:.4} %", plain(value), plain(bound)),
        );
    }
    for (index, skipped) in schedule.skipped.iter().take(MAX_NAMED).enumerate() {
        let label = if index == 0 { "left out" } else { "" };
        text += &line(label, left_out(skipped));
    }
    let more = schedule.skipped.len().saturating_sub(MAX_NAMED);
    if more > 0 {
        text += &line("", format_args!("and {}", count(more, "further target")));
    }
    if !schedule.waits.is_empty() {
        let waited: f64 = schedule.waits.iter().map(|it| it.to_s - it.from_s).sum();
        let waits = count(schedule.waits.len(), "wait");
        text += &line("waiting", format_args!("{waited:.3} s in {waits}"));
    }
    text
}

fn has_values(schedule: &Schedule) -> bool {
    schedule.value > 0.0 || schedule.value_bound > 0.0
}

fn left_out(skipped: &SkippedTarget) -> String {
    let reason = format!("{}: {}", skipped.target, skipped.reason);
    match skipped.inclusion {
        Some(cost) => format!(
            "{reason}; with it the value changes by {}, the time by {:+.3} s",
            plain(cost.value_change),
            cost.time_change_s
        ),
        None => reason,
    }
}
