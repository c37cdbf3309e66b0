//! Lower bounds of a plan that its own times contradict.
//!
//! Whether a bound is proved is not asked here, but by `slewplan certify`.

use super::number;
use crate::documents::document::Node;
use slewplan_solver::checker::TIME_TOLERANCE;
use slewplan_solver::model::problem::{Code, Problem};

/// What to do about a bound above a time.
const HINT: &str = "one of the two numbers was changed or is wrong: make the plan again";

/// A problem for every lower bound, of the plan or of a leg, that is above the time that the plan says
/// it takes; with pointers into the plan. Members of other forms are not looked at.
pub(super) fn above_times(plan: &Node, total_time_s: f64) -> Vec<Problem> {
    let slack_s = TIME_TOLERANCE * total_time_s.abs();
    let problem = |pointer: String, message: String| {
        Problem::new(pointer, Code::BoundAboveTime, message, HINT)
    };
    let of_plan = ["lower_bound_s", "certified_lower_bound_s"]
        .into_iter()
        .filter_map(|name| {
            let bound_s = above(plan, name, total_time_s + slack_s)?;
            let message = format!(
                "the plan's own {name} of {bound_s} s is above its total_time_s of {total_time_s} s"
            );
            Some(problem(format!("/{name}"), message))
        });
    let legs = match plan.member("legs") {
        Some(Node::List(legs)) => &legs[..],
        _ => &[],
    };
    let of_legs = legs.iter().enumerate().filter_map(|(index, leg)| {
        let name = "certified_lower_bound_s";
        let duration_s = number(leg, "duration_s")?;
        let bound_s = above(leg, name, duration_s + slack_s)?;
        let message = format!(
            "leg {index} of the plan has a {name} of {bound_s} s above its duration_s of \
             {duration_s} s"
        );
        Some(problem(format!("/legs/{index}/{name}"), message))
    });
    of_plan.chain(of_legs).collect()
}

/// A member that is a number above a time, s.
fn above(object: &Node, name: &str, time_s: f64) -> Option<f64> {
    number(object, name).filter(|bound_s| *bound_s > time_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documents::document::parse;

    fn pointers(plan: &str, total_time_s: f64) -> Vec<String> {
        let plan = parse(plan.as_bytes()).expect("JSON");
        let problems = above_times(&plan, total_time_s);
        assert!(problems.iter().all(|p| p.code == Code::BoundAboveTime));
        problems
            .into_iter()
            .map(|problem| problem.pointer)
            .collect()
    }

    #[test]
    fn bounds_above_the_times_beside_them_are_named() {
        let plan = r#"{
            "lower_bound_s": 101, "certified_lower_bound_s": 100.5,
            "legs": [
                {"duration_s": 60.0, "certified_lower_bound_s": 60.0},
                {"duration_s": 40.0, "certified_lower_bound_s": 40.1}
            ]
        }"#;
        assert_eq!(
            pointers(plan, 100.0),
            [
                "/lower_bound_s",
                "/certified_lower_bound_s",
                "/legs/1/certified_lower_bound_s"
            ]
        );
        let of_leg = ["/legs/1/certified_lower_bound_s"];
        assert_eq!(pointers(plan, 101.0), of_leg);
    }

    #[test]
    fn rounding_nothing_and_other_forms_are_no_contradiction() {
        for plan in [
            r#"{"lower_bound_s": 100.00000001, "certified_lower_bound_s": null}"#,
            r#"{"lower_bound_s": "200", "legs": 7}"#,
            r#"{"legs": [3, {"certified_lower_bound_s": 5.0}, {"duration_s": 5.0}]}"#,
            "{}",
        ] {
            assert_eq!(pointers(plan, 100.0), [""; 0], "{plan}");
        }
    }
}
