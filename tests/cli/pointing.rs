//! Targets and ends that point a boresight and leave the roll to the plan.

use crate::refusals::expect_refused;
use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// The two-target fixture, with what is given in place of the attitude of its first target.
fn with(pointing: Value) -> Value {
    let mut scenario = fixture_json("two-targets.json");
    let target = scenario["targets"][0].as_object_mut().expect("an object");
    target.remove("attitude");
    target.insert("pointing".into(), pointing);
    // Off the way of the camera.
    scenario["keep_out"][0]["applies"] = json!("report");
    scenario
}

fn star() -> Value {
    json!({"boresight": "camera", "ra_dec_deg": [20, 65]})
}

/// A pointing with one member replaced.
fn star_with(member: &str, value: Value) -> Value {
    let mut star = star();
    star[member] = value;
    star
}

#[test]
fn every_fault_of_a_pointing_is_named_where_it_stands() {
    let at = "/targets/0/pointing";
    let cases = [
        (
            star_with("boresight", json!("camra")),
            "/boresight",
            "unknown_reference",
        ),
        (
            star_with("boresight", json!([0, 0, 0])),
            "/boresight",
            "zero_direction",
        ),
        (
            star_with("direction", json!([1, 0, 0])),
            "/direction",
            "conflicting_fields",
        ),
        (
            json!({"boresight": "camera"}),
            "/direction",
            "missing_field",
        ),
        (
            json!({"boresight": "camera", "direction": [0, 0, 0]}),
            "/direction",
            "zero_direction",
        ),
        (
            json!({"boresight": "camera", "direction": {"body": "sun"}}),
            "/direction",
            "epoch_required",
        ),
        (
            json!({"ra_dec_deg": [20, 65]}),
            "/boresight",
            "missing_field",
        ),
        (
            star_with("ra_dec_deg", json!([20, 95])),
            "/ra_dec_deg/1",
            "out_of_range",
        ),
        (
            star_with("ra_dec_deg", json!([20])),
            "/ra_dec_deg",
            "wrong_length",
        ),
        (
            star_with("roll_min_deg", json!(3)),
            "/roll_max_deg",
            "missing_field",
        ),
        (
            star_with("roll_max_deg", json!(3)),
            "/roll_min_deg",
            "missing_field",
        ),
        (
            star_with("roll_deg", json!(3)),
            "/roll_deg",
            "unknown_field",
        ),
        (
            star_with("roll_min_deg", json!("3")),
            "/roll_min_deg",
            "wrong_type",
        ),
    ];
    for (pointing, place, code) in cases {
        let place = format!("{at}{place}");
        let expected = [(place.as_str(), code)];
        expect_refused(with(pointing).to_string().as_bytes(), &expected);
    }
    let mut empty = star_with("roll_min_deg", json!(40));
    empty["roll_max_deg"] = json!(30);
    let place = format!("{at}/roll_min_deg");
    expect_refused(
        with(empty).to_string().as_bytes(),
        &[(&place, "empty_range")],
    );
}

#[test]
fn of_attitude_and_pointing_exactly_one_is_given() {
    let attitude = json!({"mrp": [0, 0, 0]});
    for (place, object) in [
        ("/targets/0/attitude", "/targets/0"),
        ("/end/attitude", "/end"),
    ] {
        let mut scenario = fixture_json("two-targets.json");
        let members = scenario.pointer_mut(object).and_then(Value::as_object_mut);
        let members = members.expect("an object");
        members.insert("attitude".into(), attitude.clone());
        members.insert("pointing".into(), star());
        expect_refused(
            scenario.to_string().as_bytes(),
            &[(place, "conflicting_fields")],
        );
        let members = scenario.pointer_mut(object).and_then(Value::as_object_mut);
        let members = members.expect("an object");
        members.remove("attitude");
        members.remove("pointing");
        expect_refused(scenario.to_string().as_bytes(), &[(place, "missing_field")]);
    }
    let mut scenario = with(star());
    scenario["start"] = json!({"pointing": star()});
    expect_refused(
        scenario.to_string().as_bytes(),
        &[("/start/pointing", "conflicting_fields")],
    );
    scenario = with(star());
    scenario["options"] = json!({"attitude_equivalence": "quaternion"});
    expect_refused(
        scenario.to_string().as_bytes(),
        &[("/targets/0/pointing", "sign_undefined")],
    );
}

#[test]
fn a_misspelt_member_or_boresight_is_recognised() {
    for (pointing, meant) in [
        (star_with("boresight", json!("camra")), "\"camera\""),
        (star_with("roll_mim_deg", json!(1)), "\"roll_min_deg\""),
    ] {
        let told = slewplan_fed(&["validate", "-"], with(pointing).to_string().as_bytes());
        let told = told.expect_code(2).stdout;
        assert!(told.contains(&format!("did you mean {meant}?")), "{told}");
    }
}

#[test]
fn limits_and_cones_that_leave_no_roll_are_told() {
    // The panel along body X moves on the great circle across the star.
    let mut scenario = with(json!({"boresight": [0, 0, 1], "direction": [0, 0, 1]}));
    scenario["spacecraft"]["boresights"] = json!([{"name": "panel", "axis": [1, 0, 0]}]);
    scenario["keep_out"] = json!([]);
    scenario["keep_in"] = json!([
        {"boresight": "panel", "direction": [0, 1, 0], "half_angle_deg": 20, "applies": "at_targets"},
    ]);
    scenario["targets"]
        .as_array_mut()
        .expect("a list")
        .truncate(1);
    let validate = |scenario: &Value| {
        slewplan_fed(
            &["validate", "-", "--format", "json"],
            scenario.to_string().as_bytes(),
        )
    };
    validate(&scenario).expect_code(0);
    for limits in [[-30, 30], [-170, 60]] {
        let pointing = &mut scenario["targets"][0]["pointing"];
        // Seen from the reference frame, roll 0 is a panel along -Y: +90 degrees from north is west.
        pointing["roll_min_deg"] = json!(limits[0]);
        pointing["roll_max_deg"] = json!(limits[1]);
        let found = validate(&scenario);
        let document = found.json();
        let errors = document["errors"].as_array().expect("a list");
        let reached = errors.is_empty();
        // At the north pole with right ascension 0, up (+X) points to -X, and a roll of r turns it by r.
        let panel_at = |roll: f64| (180.0 + roll - 90.0).rem_euclid(360.0);
        let inside = |roll: f64| panel_at(roll) <= 20.0 || panel_at(roll) >= 340.0;
        let expected = (limits[0]..=limits[1]).any(|roll| inside(f64::from(roll)));
        assert_eq!(reached, expected, "{limits:?} {document:#}");
        for error in errors {
            assert_eq!(error["code"], "no_roll_left");
            assert_eq!(error["pointer"], "/targets/0/pointing");
            let message = error["message"].as_str().expect("a text");
            assert!(
                message.contains("limits and cones leave no roll"),
                "{message}"
            );
        }
    }
}

#[test]
fn a_plan_tells_its_rolls_and_passes_verification() {
    let mut scenario = with(star());
    scenario["end"] = json!({"pointing": {"boresight": "camera", "direction": [0, 0, 1]}});
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scenario.json");
    std::fs::write(&path, scenario.to_string()).expect("written");
    let path = path.to_str().expect("UTF-8");
    let plan = slewplan(&["solve", path]).expect_code(0).json();
    let passages = plan["passages"].as_array().expect("a list");
    for passage in passages {
        assert_eq!(
            passage["target"] == "a",
            passage["roll_deg"].is_number(),
            "{passage}"
        );
    }
    let end = &plan["end"];
    assert!(end["roll_deg"].is_number() && end["time_s"] == plan["total_time_s"]);
    let verify = |scenario: &Value, plan: &Value| {
        std::fs::write(path, scenario.to_string()).expect("written");
        slewplan_fed(&["verify", path, "-"], plan.to_string().as_bytes())
    };
    verify(&scenario, &plan).expect_code(0);
    // The attitude that was flown, given: the same flight passes.
    let flown = |document: &Value| json!({"quaternion": document["attitude"]["quaternion"]});
    let mut given = scenario.clone();
    let passage = passages
        .iter()
        .find(|passage| passage["target"] == "a")
        .expect("visited");
    let roll = passage["roll_deg"].as_f64().expect("a number");
    given["targets"][0] = json!({"id": "a", "zero_rate_axes": ["z"], "attitude": {
        "ra_dec_roll_deg": [20, 65, roll], "boresight": "camera"}});
    given["end"] = json!({"attitude": flown(end)});
    verify(&given, &plan).expect_code(0);
    // Another direction, and limits beside the roll, do not.
    let mut other = scenario.clone();
    other["targets"][0]["pointing"]["ra_dec_deg"] = json!([20, 65.001]);
    let told = verify(&other, &plan).expect_code(3).stdout;
    assert!(told.contains("target 'a' is missed by"), "{told}");
    let limited = |low: f64, high: f64| {
        let mut limited = scenario.clone();
        limited["targets"][0]["pointing"]["roll_min_deg"] = json!(low);
        limited["targets"][0]["pointing"]["roll_max_deg"] = json!(high);
        limited
    };
    verify(&limited(roll - 1.0, roll + 1.0), &plan).expect_code(0);
    verify(&limited(roll + 359.0, roll + 361.0), &plan).expect_code(0);
    let told = verify(&limited(roll + 1.0, roll + 2.0), &plan)
        .expect_code(3)
        .stdout;
    assert!(told.contains("outside the limits of its roll"), "{told}");
    let certified = slewplan_fed(&["certify", path, "-"], plan.to_string().as_bytes());
    assert!(certified.stdout.contains("not_checked"), "{certified:?}");
}

#[test]
fn scenarios_without_a_pointing_have_no_rolls() {
    let text = slewplan_fed(
        &["solve", "-"],
        fixture_json("two-targets.json").to_string().as_bytes(),
    );
    let text = text.expect_code(0).stdout;
    assert!(
        !text.contains("roll_deg") && !text.contains("\"end\":{"),
        "{text}"
    );
}

#[test]
fn a_single_slew_chooses_the_rolls_at_both_ends() {
    let solve = |slew: &Value| {
        let told = slewplan_fed(&["slew", "-"], slew.to_string().as_bytes()).expect_code(0);
        told.json()["slews"][0].clone()
    };
    let number = |slew: &Value, name: &str| slew[name].as_f64();
    let mut slew = fixture_json("slews/quarter-turn.json");
    let pointing = |direction: Value| json!({"boresight": [1, 0, 0], "direction": direction});
    slew["end"] = json!({"pointing": pointing(json!([0, 1, 0.5]))});
    let free = solve(&slew);
    let roll = number(&free, "end_roll_deg").expect("told");
    assert_eq!(number(&free, "start_roll_deg"), None);
    for beside in [roll - 8.0, roll + 8.0] {
        let mut given = slew.clone();
        for limit in ["roll_min_deg", "roll_max_deg"] {
            given["end"]["pointing"][limit] = json!(beside);
        }
        let given = solve(&given);
        assert!((number(&given, "end_roll_deg").expect("told") - beside).abs() < 1e-3);
        assert!(
            number(&given, "time_s") > number(&free, "time_s"),
            "{beside}"
        );
    }
    slew["start"] = json!({"pointing": pointing(json!([1, 0, 0]))});
    let both = solve(&slew);
    assert!(number(&both, "start_roll_deg").is_some());
    assert!(number(&both, "time_s") < number(&free, "time_s"));

    // The roll would turn the momentum of the wheels.
    let wheels = slew["spacecraft"]["wheels"]
        .as_array()
        .expect("a list")
        .len();
    slew["start"]["wheel_speed_rad_s"] = json!(vec![5; wheels]);
    let told = slewplan_fed(&["slew", "-"], slew.to_string().as_bytes()).expect_code(2);
    assert!(
        told.stderr.contains("/start/pointing") && told.stderr.contains("roll_not_free"),
        "{told:?}"
    );
}

#[test]
fn the_sun_chooses_the_rolls_of_a_star_camera() {
    let scenario = fixture("stars-and-sun.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).json();
    let verified = slewplan_fed(
        &["verify", &scenario, "-", "--strict"],
        plan.to_string().as_bytes(),
    );
    verified.expect_code(0);
    // Without the cones the rolls are others, and the tour is shorter.
    let mut free = fixture_json("stars-and-sun.json");
    for cones in ["keep_out", "keep_in"] {
        free[cones] = json!([]);
    }
    let free = slewplan_fed(&["solve", "-"], free.to_string().as_bytes());
    let free = free.expect_code(0).json();
    let total = |plan: &Value| plan["total_time_s"].as_f64().expect("a number");
    assert!(
        total(&free) < total(&plan),
        "{} {}",
        total(&free),
        total(&plan)
    );
}
