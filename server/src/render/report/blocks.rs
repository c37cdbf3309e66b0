//! Blocks of text that several reports share.

use super::numbers::{computed, decimals, percent, small};
use slewplan_solver::model::plan::{ConeClearance, Margins, Verification};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use std::fmt::{Display, Write};

/// One labelled line.
pub(super) fn line(label: &str, text: impl Display) -> String {
    format!("{label:<14}{text}\n")
}

/// The verification in a few lines, with the tests that failed.
pub(super) fn verification(found: &Verification, margins: &Margins) -> String {
    let verdict = match (found.passed, margins.violates_cones()) {
        (true, false) => "passed",
        (true, true) => "passed, but keep-out violated",
        (false, _) => "NOT PASSED",
    };
    let mut text = line(
        "verification",
        format_args!(
            "{verdict}: attitude error {} rad, rate error {} rad/s",
            small(found.max_attitude_error_rad),
            small(found.max_rate_error_rad_s)
        ),
    );
    text += &line(
        "",
        format_args!(
            "limits exceeded by (relative): torque {}, wheel speed {}, body rate {}",
            small(found.max_torque_excess),
            small(found.max_wheel_speed_excess),
            small(found.max_rate_excess)
        ),
    );
    text += &line("", format_args!("propagated again by {}", found.integrator));
    for failure in &found.failures {
        text += &line("", format_args!("failed: {failure}"));
    }
    text
}

/// The margins to every limit.
pub(super) fn margins(margins: &Margins) -> String {
    let share = |value: Option<f64>| match value {
        None => "no limit".to_owned(),
        Some(value) => computed(value, |value| percent(value, 1)),
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
    text + &clearances(&margins.keep_out_clearance_deg)
}

/// How close boresights come to cones; empty without cones.
pub(super) fn clearances(nearest: &[ConeClearance]) -> String {
    if nearest.is_empty() {
        return String::new();
    }
    let clearances: Vec<String> = nearest.iter().map(clearance).collect();
    let list = clearances.join(", ");
    line("", format_args!("clearance of cones [deg]: {list}"))
}

/// How close a boresight comes to the surface of a cone, and when.
fn clearance(nearest: &ConeClearance) -> String {
    let ConeClearance {
        boresight, cone, ..
    } = nearest;
    let when = || decimals(nearest.time_s, 2);
    let angle = computed(nearest.clearance_deg, |angle| {
        format!("{} at {} s", decimals(angle, 2), when())
    });
    format!("{boresight} ({cone}) {angle}")
}

/// The warnings of violated cones, which stand above everything else; empty without any.
pub(super) fn keep_out_banner(warnings: &[Problem]) -> String {
    let violations: Vec<_> = warnings.iter().filter(|one| is_keep_out(one)).collect();
    if violations.is_empty() {
        return String::new();
    }
    let mut text = "KEEP-OUT VIOLATED\n".to_owned();
    for violation in violations {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {violation}");
    }
    text.push('\n');
    text
}

fn is_keep_out(warning: &Problem) -> bool {
    matches!(
        warning.code,
        Code::KeepOutViolated | Code::AttitudeInKeepOut
    )
}

/// All warnings but those of the banner, or an empty text.
pub(super) fn warnings(warnings: &[Problem], scenario: Option<&Scenario>) -> String {
    let others = warnings.iter().filter(|one| !is_keep_out(one)).cloned();
    let others: Vec<Problem> = others.collect();
    if others.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{} to note:\n", count(others.len(), "warning"));
    text += &reasons(&others, scenario);
    text
}

/// Problems, one paragraph each; a scenario adds the names of the targets that pointers lead to.
pub(super) fn reasons(problems: &[Problem], scenario: Option<&Scenario>) -> String {
    let mut text = String::new();
    for problem in problems {
        text += &named(problem, scenario);
        text.push('\n');
    }
    text
}

/// A problem, after the name of the target that its pointer leads to.
pub(super) fn named(problem: &Problem, scenario: Option<&Scenario>) -> String {
    match scenario.and_then(|scenario| target_at(&problem.pointer, scenario)) {
        Some(id) => format!("target \"{id}\", {problem}"),
        None => problem.to_string(),
    }
}

/// The identifier of the target that a pointer leads to, or into.
fn target_at<'a>(pointer: &str, scenario: &'a Scenario) -> Option<&'a str> {
    // Studies have their scenario as a member.
    let inside = pointer.strip_prefix("/scenario").unwrap_or(pointer);
    let index = inside.strip_prefix("/targets/")?.split('/').next()?;
    let target = scenario.targets().get(index.parse::<usize>().ok()?)?;
    Some(&target.id)
}

/// A number with a noun in singular or plural.
pub(super) fn count(number: impl Copy + Display + PartialEq + From<u8>, thing: &str) -> String {
    let plural = if number == 1.into() { "" } else { "s" };
    format!("{number} {thing}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::checker::NOT_COMPUTED;

    #[test]
    fn values_not_computed_are_said_in_words() {
        let nearest = |index: usize, clearance_deg: f64| ConeClearance {
            boresight: "camera".into(),
            cone: format!("/keep_out/{index}"),
            direction: [0.0, 0.0, 1.0].into(),
            clearance_deg,
            time_s: 3.0,
        };
        let broken = Margins {
            torque: -NOT_COMPUTED,
            body_rate: Some(-3e300),
            keep_out_clearance_deg: vec![nearest(0, -NOT_COMPUTED), nearest(1, 12.5)],
            ..Margins::default()
        };
        let text = margins(&broken);
        let torque = "torque not computed, wheel speed no limit, body rate -3.0e302 %";
        assert!(text.contains(torque), "{text}");
        let cones =
            "[deg]: camera (/keep_out/0) not computed, camera (/keep_out/1) 12.50 at 3.00 s";
        assert!(text.contains(cones), "{text}");
    }

    #[test]
    fn margins_that_round_to_zero_have_no_sign() {
        let full = Margins {
            torque: -1e-9,
            ..Margins::default()
        };
        assert!(margins(&full).contains("torque 0.0 %"));
    }

    #[test]
    fn violated_cones_stand_in_the_banner_only() {
        let cone = Problem::new("/keep_out/0", Code::KeepOutViolated, "inside", "turn");
        let other = Problem::new("/start", Code::AttitudeNormalized, "off", "");
        let all = [cone, other];
        let banner = keep_out_banner(&all);
        assert!(banner.starts_with("KEEP-OUT VIOLATED\n  /keep_out/0: inside"));
        assert!(banner.contains("hint: turn") && !banner.contains("/start"));
        let noted = warnings(&all, None);
        assert!(noted.contains("1 warning to note") && !noted.contains("/keep_out"));
        assert_eq!(keep_out_banner(&all[1..]), "");
    }
}
