//! Blocks of text that several reports share.

use slewplan_solver::checker::NOT_COMPUTED;
use slewplan_solver::model::plan::{Margins, Verification};
use slewplan_solver::model::problem::Problem;
use std::fmt::{Display, Write};

/// Numbers from this size on are written with an exponent.
const LARGEST_IN_DIGITS: f64 = 1e6;

/// One labelled line.
pub(super) fn line(label: &str, text: impl Display) -> String {
    format!("{label:<14}{text}\n")
}

/// The verification in a few lines, with the tests that failed.
pub(super) fn verification(found: &Verification) -> String {
    let verdict = if found.passed { "passed" } else { "NOT PASSED" };
    let mut text = line(
        "verification",
        format_args!(
            "{verdict}: attitude error {} rad, rate error {} rad/s",
            error(found.max_attitude_error_rad),
            error(found.max_rate_error_rad_s)
        ),
    );
    text += &line(
        "",
        format_args!(
            "limits exceeded by (relative): torque {}, wheel speed {}, body rate {}",
            error(found.max_torque_excess),
            error(found.max_wheel_speed_excess),
            error(found.max_rate_excess)
        ),
    );
    text += &line("", format_args!("propagated again by {}", found.integrator));
    for failure in &found.failures {
        text += &line("", format_args!("failed: {failure}"));
    }
    text
}

fn error(value: f64) -> String {
    computed(value, |value| format!("{value:.1e}"))
}

/// A number in words where it could not be computed.
fn computed(value: f64, written: impl FnOnce(f64) -> String) -> String {
    if value.abs() >= NOT_COMPUTED {
        "not computed".to_owned()
    } else {
        written(value)
    }
}

/// A share in per cent. What exceeds a limit many times over is not written out in digits.
fn percent(share: f64) -> String {
    let percent = share * 100.0;
    if percent.abs() < LARGEST_IN_DIGITS {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.1e} %")
    }
}

/// The margins to every limit.
pub(super) fn margins(margins: &Margins) -> String {
    let share = |value: Option<f64>| match value {
        None => "no limit".to_owned(),
        Some(value) => computed(value, percent),
    };
    let mut text = line(
        "margins",
        format_args!(
            "left of the limit: torque {}, wheel speed {}, body rate {}",
            share(Some(margins.torque)),
            share(margins.wheel_speed),
            share(margins.body_rate)
        ),
    );
    let list = |values: &[String]| values.join(", ");
    let crossings: Vec<String> = margins
        .wheel_zero_crossings
        .iter()
        .map(ToString::to_string)
        .collect();
    text += &line(
        "",
        format_args!("zero crossings of the wheels: {}", list(&crossings)),
    );
    if !margins.keep_out_clearance_deg.is_empty() {
        let clearances: Vec<String> = margins
            .keep_out_clearance_deg
            .iter()
            .map(|angle| computed(*angle, |angle| format!("{angle:.2}")))
            .collect();
        text += &line(
            "",
            format_args!("keep-out clearance [deg]: {}", list(&clearances)),
        );
    }
    text
}

/// Warnings, or an empty text.
pub(super) fn warnings(warnings: &[Problem]) -> String {
    if warnings.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{} to note:\n", count(warnings.len(), "warning"));
    text += &reasons(warnings);
    text
}

/// Problems, one paragraph each.
pub(super) fn reasons(problems: &[Problem]) -> String {
    let mut text = String::new();
    for problem in problems {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{problem}");
    }
    text
}

/// A number with a noun in singular or plural.
pub(super) fn count(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_not_computed_are_said_in_words() {
        assert_eq!(error(NOT_COMPUTED), "not computed");
        assert_eq!(error(2.5e-9), "2.5e-9");
        let broken = Margins {
            torque: -NOT_COMPUTED,
            body_rate: Some(-3e300),
            keep_out_clearance_deg: vec![-NOT_COMPUTED, 12.5],
            ..Margins::default()
        };
        let text = margins(&broken);
        let torque = "torque not computed, wheel speed no limit, body rate -3.0e302 %";
        assert!(text.contains(torque), "{text}");
        assert!(text.contains("[deg]: not computed, 12.50"), "{text}");
    }
}
