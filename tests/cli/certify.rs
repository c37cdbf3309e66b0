//! `slewplan certify`.

use crate::run::{Ended, fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// A scenario in a file, and its plan.
struct Solved {
    folder: tempfile::TempDir,
    plan: Value,
}

impl Solved {
    fn of(scenario: &Value) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("scenario"), scenario.to_string()).expect("written");
        let mut solved = Self {
            folder,
            plan: Value::Null,
        };
        solved.plan = slewplan(&["solve", &solved.scenario()])
            .expect_code(0)
            .json();
        solved
    }

    fn scenario(&self) -> String {
        let path = self.folder.path().join("scenario");
        path.to_str().expect("UTF-8").to_owned()
    }

    fn certify(&self, plan: &Value, more: &[&str]) -> Ended {
        let scenario = self.scenario();
        let arguments = [&["certify", &scenario, "-"], more].concat();
        slewplan_fed(&arguments, plan.to_string().as_bytes())
    }

    /// The plan with one value replaced.
    fn with(&self, place: &str, value: Value) -> Value {
        let mut plan = self.plan.clone();
        *plan.pointer_mut(place).expect("the place exists") = value;
        plan
    }

    fn number(&self, place: &str) -> f64 {
        let value = self.plan.pointer(place).and_then(Value::as_f64);
        value.expect("a number")
    }
}

/// Experiment A with rest at all targets.
fn all_axes() -> Value {
    let mut scenario = fixture_json("olivares-a.json");
    for target in scenario["targets"].as_array_mut().expect("a list") {
        target
            .as_object_mut()
            .expect("an object")
            .remove("zero_rate_axes");
    }
    scenario
}

/// The verdicts on the legs, and that on all tours.
fn verdicts(found: &Value) -> (Vec<&str>, &str) {
    let legs = found["legs"].as_array().expect("a list").iter();
    let legs = legs.map(|leg| leg["verdict"].as_str().expect("a text"));
    (
        legs.collect(),
        found["tour"]["verdict"].as_str().expect("a text"),
    )
}

#[test]
fn plans_of_experiment_a_are_confirmed() {
    for scenario in [fixture_json("olivares-a.json"), all_axes()] {
        let solved = Solved::of(&scenario);
        let found = solved.certify(&solved.plan, &[]).expect_code(0).json();
        assert_eq!(found["confirmed"], true);
        assert_eq!(verdicts(&found), (vec!["confirmed"; 7], "confirmed"));
        let (claimed, flown) = (&found["legs"][0], &solved.plan["legs"][0]);
        for field in ["from", "to", "certified_lower_bound_s"] {
            assert_eq!(claimed[field], flown[field], "{field}");
        }
        assert_eq!(claimed["reason"], Value::Null);
        strongest_bounds_lie_between(&found, &solved.plan);
    }
}

/// Checks that the strongest bounds are no smaller than the claims, and no larger than what is flown.
fn strongest_bounds_lie_between(found: &Value, plan: &Value) {
    let lies_between = |claim: &Value, flown: &Value| {
        let strongest = claim["strongest_lower_bound_s"].as_f64().expect("a bound");
        let claimed = claim["certified_lower_bound_s"].as_f64().expect("a bound");
        let flown = flown.as_f64().expect("a number");
        assert!(
            (claimed..flown).contains(&strongest),
            "{claim} of {flown} s"
        );
        strongest / flown
    };
    let legs = found["legs"].as_array().expect("a list").iter();
    for (claim, leg) in legs.zip(plan["legs"].as_array().expect("a list")) {
        lies_between(claim, &leg["duration_s"]);
    }
    let share = lies_between(&found["tour"], &plan["total_time_s"]);
    assert!(share > 0.935, "{share} of the tour is proved");
}

#[test]
fn a_bound_that_is_too_large_is_rejected_with_the_reason() {
    let solved = Solved::of(&all_axes());
    let leg = "/legs/2/certified_lower_bound_s";
    let tour = "/certified_lower_bound_s";
    let duration = solved.number("/legs/2/duration_s");
    let cases = [
        (
            leg,
            solved.number(leg) * 1.001,
            "the solver's own bound for such slews",
        ),
        (leg, duration * 1.001, "the plan itself takes"),
        (tour, solved.number(tour) * 1.001, "bounds of 42 of 42 legs"),
        (
            tour,
            solved.number("/total_time_s") + 1.0,
            "the plan itself takes",
        ),
    ];
    for (place, value, reason) in cases {
        let plan = solved.with(place, json!(value));
        let found = solved.certify(&plan, &[]).expect_code(3).json();
        assert_eq!(found["confirmed"], false);
        let (mut legs, mut all) = (vec!["confirmed"; 7], "confirmed");
        let claim = if place == leg {
            legs[2] = "rejected";
            &found["legs"][2]
        } else {
            all = "rejected";
            &found["tour"]
        };
        assert_eq!(verdicts(&found), (legs, all), "{place} {value}");
        let told = claim["reason"].as_str().expect("a text");
        assert!(told.contains(reason), "{told}");
    }
}

#[test]
fn a_lower_bound_of_the_kind_certified_is_checked_too() {
    let solved = Solved::of(&all_axes());
    let mut plan = solved.with("/lower_bound_kind", json!("certified"));
    plan["certified_lower_bound_s"] = Value::Null;
    plan["lower_bound_s"] = solved.plan["certified_lower_bound_s"].clone();
    let found = solved.certify(&plan, &[]).expect_code(0).json();
    assert_eq!(verdicts(&found).1, "confirmed");
    plan["lower_bound_s"] = plan["total_time_s"].clone();
    let found = solved.certify(&plan, &[]).expect_code(3).json();
    assert_eq!(verdicts(&found).1, "rejected");
}

#[test]
fn the_bound_of_another_leg_is_rejected() {
    let solved = Solved::of(&fixture_json("olivares-a.json"));
    // The leg from the start to the first target is the shortest.
    let mut plan = solved.with("/legs/6/from", solved.plan["sequence"][0].clone());
    plan["legs"][1]["to"] = json!("start");
    let found = solved.certify(&plan, &[]).expect_code(3).json();
    let (legs, _) = verdicts(&found);
    assert_eq!(legs[1..3], ["rejected", "confirmed"], "{found}");
    assert_eq!(legs[6], "rejected", "{found}");
    let told = found["legs"][1]["reason"].as_str().expect("a text");
    assert!(told.contains("no tour"), "{told}");
}

#[test]
fn plans_without_certified_bounds_are_not_confirmed() {
    let solved = Solved::of(&fixture_json("two-targets.json"));
    let mut plan = solved.with("/legs/0/certified_lower_bound_s", Value::Null);
    let found = solved.certify(&plan, &[]).expect_code(0).json();
    assert_eq!(verdicts(&found).0, ["no_claim", "confirmed", "confirmed"]);
    plan["certified_lower_bound_s"] = Value::Null;
    for leg in plan["legs"].as_array_mut().expect("a list") {
        leg["certified_lower_bound_s"] = Value::Null;
    }
    let found = solved.certify(&plan, &[]).expect_code(3).json();
    assert_eq!(verdicts(&found), (vec!["no_claim"; 3], "no_claim"));
}

#[test]
fn bounds_with_stored_momentum_are_confirmed_and_larger_ones_rejected() {
    let solved = Solved::of(&fixture_json("pyramid-momentum-bias.json"));
    let found = solved.certify(&solved.plan, &[]).expect_code(0).json();
    assert_eq!(found["confirmed"], true);
    assert_eq!(verdicts(&found), (vec!["confirmed"; 4], "confirmed"));
    let bound = solved.plan["legs"][1]["certified_lower_bound_s"].as_f64();
    let more = json!(bound.expect("a bound") * 1.001);
    let plan = solved.with("/legs/1/certified_lower_bound_s", more);
    let found = solved.certify(&plan, &[]).expect_code(3).json();
    assert_eq!(verdicts(&found).0[1], "rejected");
    let told = found["legs"][1]["reason"].as_str().expect("a text");
    assert!(told.contains("not excluded"), "{told}");
}

#[test]
fn malformed_bounds_are_refused_with_pointers() {
    let leg = |from: Value, bound: Value| {
        let leg = json!({"from": from, "to": "a", "certified_lower_bound_s": bound});
        json!({"legs": [leg]})
    };
    let cases = [
        (json!({}), "/legs", "missing_field"),
        (
            leg(json!("x"), json!(1)),
            "/legs/0/from",
            "unknown_reference",
        ),
        (leg(json!(1), json!(1)), "/legs/0/from", "wrong_type"),
        (
            leg(json!("start"), json!("1 s")),
            "/legs/0/certified_lower_bound_s",
            "wrong_type",
        ),
    ];
    for (plan, pointer, code) in cases {
        let arguments = ["certify", &fixture("two-targets.json"), "-"];
        let ended = slewplan_fed(&arguments, plan.to_string().as_bytes()).expect_code(2);
        for part in [format!("\n{pointer}: "), format!("[{code}]")] {
            assert!(ended.stderr.contains(&part), "{part}: {ended:?}");
        }
    }
    slewplan(&["certify", "-", "-"]).expect_code(2);
}
