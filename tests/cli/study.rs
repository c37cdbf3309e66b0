//! `slewplan study`.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

#[test]
fn a_study_of_shares_answers_for_every_pair() {
    let study = json!({
        "scenario": fixture_json("two-targets.json"),
        "simulation": {
            "controller": {"kind": "geometric_pid", "gains": {"kind": "bandwidth",
                "bandwidth_rad_s": 0.1, "integral_rad_s": 0.01}, "anti_windup": true},
            "errors": {"inertia_3_sigma": 0.02},
            "runs": 5,
        },
        "authorities": [{"torque_authority": 0.9, "momentum_authority": 0.9}],
    });
    let answer = slewplan_fed(&["study", "authority", "-"], study.to_string().as_bytes());
    let answer = answer.expect_code(0).json();
    let row = &answer["rows"][0];
    assert_eq!(
        (&answer["complete"], &row["status"]),
        (&json!(true), &json!("flown"))
    );
    assert_eq!(
        (&row["flights"]["runs"], &row["reasons"]),
        (&json!(5), &json!([]))
    );
    let scenario = fixture_json("two-targets.json");
    let targets = scenario["targets"].as_array().expect("a list").len();
    assert_eq!(
        row["flights"]["passages"].as_array().map(Vec::len),
        Some(targets)
    );
}

/// Two targets with a cone far away, one that the plan enters, and the edge of a third at a target.
fn near_cones() -> Value {
    let mut scenario = fixture_json("two-targets.json");
    let cone = |direction: [f64; 3], half_angle_deg: f64, applies: &str| {
        json!({"boresight": "camera",
        "direction": direction, "half_angle_deg": half_angle_deg, "applies": applies})
    };
    scenario["keep_out"] = json!([
        cone([-1.0, 0.0, 0.0], 30.0, "always"),
        cone([0.0, 0.0, 1.0], 10.0, "report"),
    ]);
    // The camera is 25 degrees from z at the target b.
    scenario["keep_in"] = json!([cone([0.0, 0.0, 1.0], 25.0005, "at_targets")]);
    scenario
}

#[test]
fn a_study_of_shares_tells_how_many_flights_stay_clear_of_cones() {
    let study = |scenario: &Value| {
        json!({
            "scenario": scenario,
            "simulation": {"errors": {"inertia_3_sigma": 0.1}, "runs": 20},
            "authorities": [{"torque_authority": 0.9, "momentum_authority": 0.9}],
        })
        .to_string()
    };
    let line = ["study", "authority", "-"];
    let near = study(&near_cones());
    let answer = slewplan_fed(&line, near.as_bytes()).expect_code(0).json();
    let flights = &answer["rows"][0]["flights"];
    let cones = flights["keep_out_clearance_deg"].as_array();
    let cones = cones.expect("a list");
    let named: Vec<_> = cones
        .iter()
        .map(|one| (&one["cone"], &one["applies"]))
        .collect();
    assert_eq!(
        json!(named),
        json!([
            ["/keep_out/0", "always"],
            ["/keep_out/1", "report"],
            ["/keep_in/0", "at_targets"]
        ])
    );
    let [far, entered, edge] = &cones[..] else {
        panic!("{cones:?}")
    };
    assert_eq!(
        (&far["share_clear"], &far["boresight"]),
        (&json!(1.0), &json!("camera"))
    );
    assert_eq!(far["direction"], json!([-1.0, 0.0, 0.0]));
    assert!(number(far, "/clearance_deg/min") > 10.0, "{far}");
    assert_eq!(entered["share_clear"], 0.0);
    assert!(number(entered, "/clearance_deg/p50") < -9.0, "{entered}");
    // Flights are on both sides of the edge. Only this one divides them: the other is not enforced.
    let share = number(edge, "/share_clear");
    assert!(share > 0.0 && share < 1.0, "{edge}");
    assert!((number(flights, "/share_clear") - share).abs() < 1e-12);
    let quantiles =
        ["min", "p1", "p10", "p50"].map(|name| number(edge, &format!("/clearance_deg/{name}")));
    assert!(quantiles.is_sorted() && quantiles[0] < 0.0, "{quantiles:?}");

    let line = ["study", "authority", "-", "--summary"];
    let text = slewplan_fed(&line, near.as_bytes()).expect_code(0).stdout;
    let table = "Clearance of cones that so many flights keep [deg]";
    assert!(
        text.contains("clear of cones") && text.contains(table),
        "{text}"
    );
    assert!(
        text.contains("camera (/keep_in/0)") && text.contains("at targets"),
        "{text}"
    );

    let mut none = near_cones();
    (none["keep_out"], none["keep_in"]) = (json!([]), json!([]));
    let none = study(&none);
    let answer = slewplan_fed(&line[..3], none.as_bytes())
        .expect_code(0)
        .json();
    let flights = &answer["rows"][0]["flights"];
    assert_eq!(
        (&flights["share_clear"], &flights["keep_out_clearance_deg"]),
        (&Value::Null, &json!([]))
    );
    let text = slewplan_fed(&line, none.as_bytes()).expect_code(0).stdout;
    assert!(!text.contains("cone"), "{text}");
}

#[test]
fn the_summary_of_a_flight_tells_how_close_it_came_to_cones() {
    let study =
        json!({"scenario": near_cones(), "simulation": {"errors": {"inertia_3_sigma": 0.1}}});
    let line = ["study", "flight", "-"];
    let answer = slewplan_fed(&line, study.to_string().as_bytes());
    let document = answer.expect_code(0);
    let cones = document.json()["flight"]["keep_out_clearance_deg"].clone();
    let line = [&line[..], &["--summary"]].concat();
    let text = slewplan_fed(&line, study.to_string().as_bytes());
    let text = text.expect_code(0).stdout;
    for one in cones.as_array().expect("a list") {
        let words = format!(
            "camera ({}) {:.2} at {:.2} s",
            one["cone"].as_str().expect("a pointer"),
            number(one, "/clearance_deg"),
            number(one, "/time_s")
        );
        assert!(text.contains(&words), "{words} not in {text}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = folder.path().join("scenario.json");
    std::fs::write(&scenario, near_cones().to_string()).expect("written");
    let line = ["plot", "-", "--scenario", scenario.to_str().expect("UTF-8")];
    let drawn = slewplan_fed(&line, document.stdout.as_bytes())
        .expect_code(0)
        .stdout;
    assert!(drawn.contains("Clearance of cones, deg</text>"));
    let alone = slewplan_fed(&["plot", "-"], document.stdout.as_bytes());
    assert!(!alone.expect_code(0).stdout.contains("Clearance of cones"));
}

#[test]
fn problems_are_listed_with_pointers() {
    let study = json!({
        "scenario": fixture_json("two-targets.json"),
        "simulation": {"controller": {"kind": "quaternion"}, "wheels": 3},
        "authorities": [{"torque_authority": 0.9}],
    });
    let answer = slewplan_fed(&["study", "authority", "-"], study.to_string().as_bytes());
    let answer = answer.expect_code(2);
    for place in [
        "/simulation/controller/gains",
        "/simulation/wheels",
        "/authorities/0/momentum_authority",
    ] {
        assert!(answer.stderr.contains(place), "{answer:?}");
    }
}

fn number(document: &Value, place: &str) -> f64 {
    let value = document.pointer(place).and_then(Value::as_f64);
    value.unwrap_or_else(|| panic!("no number at {place}"))
}

#[test]
fn the_published_pyramid_has_its_envelopes_slews_and_allocations() {
    let study = fixture("studies/pyramid-envelopes.json");
    let answer = slewplan(&["study", "envelopes", &study]).expect_code(0);
    let document = answer.json();
    assert_eq!(
        (&document["complete"], &document["warnings"]),
        (&json!(true), &json!([]))
    );
    // Published for wheels of unit torque and momentum: inscribed spheres and spheres of equal
    // volume.
    for (place, published) in [
        ("/momentum/full/inscribed_radius", 1.633),
        ("/momentum/full/equal_volume_radius", 1.805),
        ("/momentum/full/greatest_radius", 2.309),
        ("/momentum/pseudo_inverse/inscribed_radius", 1.333),
        ("/momentum/pseudo_inverse/equal_volume_radius", 1.577),
        // The thesis prints 24.632.
        ("/momentum/full/volume", 24.634),
    ] {
        let found = number(&document, place);
        assert!((found - published).abs() < 6e-4, "{place}: {found}");
        let torque = number(&document, &place.replace("momentum", "torque"));
        let unit: f64 = if place.ends_with("volume") {
            0.0857_f64.powi(3)
        } else {
            0.0857
        };
        assert!((torque - found * unit).abs() < 1e-9, "{place}: {torque}");
    }
    let full = &document["momentum"]["full"];
    let count = |name: &str| full[name].as_array().map_or(0, Vec::len);
    // A rhombic dodecahedron.
    assert_eq!((count("vertices"), count("facets")), (14, 12));
    // With the pseudo-inverse: 51.8 s published for a simulation, 51.57 s by the formula.
    for (place, seconds) in [
        ("/turns/0/eigenaxis/1/duration_s", 51.57),
        ("/turns/0/eigenaxis/3/duration_s", 38.27),
        ("/turns/0/time_optimal/0/duration_s", 38.27),
    ] {
        assert!((number(&document, place) - seconds).abs() < 0.01, "{place}");
    }
    for turn in 0..2 {
        let time = |place: &str| number(&document, &format!("/turns/{turn}/{place}/duration_s"));
        let (free, shared) = (time("time_optimal/0"), time("time_optimal/1"));
        assert!(free < shared + 1e-3 && shared < time("eigenaxis/1") + 1e-3);
        assert!(free < time("eigenaxis/3") + 1e-2);
    }
    // The demand is a minor vertex of the envelope.
    assert!((number(&document, "/demands/0/pseudo_inverse/load") - 1.5).abs() < 1e-9);
    assert!((number(&document, "/demands/0/least_load/load") - 1.0).abs() < 1e-6);

    let drawn = slewplan_fed(&["plot", "-", "--turn", "1"], answer.stdout.as_bytes());
    let picture = drawn.expect_code(0).stdout;
    assert!(picture.starts_with("<svg ") && picture.contains("90.0 degrees about"));
    let scenario = fixture("pyramid.json");
    for wrong in [
        ["--turn", "2"],
        ["--boresight", "x"],
        ["--scenario", &scenario],
    ] {
        let line = ["plot", "-", wrong[0], wrong[1]];
        let refused = slewplan_fed(&line, answer.stdout.as_bytes());
        assert!(refused.expect_code(2).stderr.contains(wrong[0]));
    }
}

#[test]
fn every_problem_of_a_study_of_envelopes_is_listed() {
    let mut study = fixture_json("studies/pyramid-envelopes.json");
    study["turns"][0]["form"] = json!({"mrp": [0, 0, 0]});
    study["demands_nm"] = json!([[1, 2]]);
    study["options"] = json!({"torque_authority": "all", "time_limit_s": 1});
    let line = ["study", "envelopes", "-"];
    let answer = slewplan_fed(&line, study.to_string().as_bytes()).expect_code(2);
    for place in [
        "/turns/0/form",
        "/demands_nm/0",
        "/options/torque_authority",
        "/options/time_limit_s",
    ] {
        assert!(answer.stderr.contains(place), "{answer:?}");
    }
    let mut study = fixture_json("studies/pyramid-envelopes.json");
    study["turns"][1]["to"] = study["turns"][1]["from"].clone();
    study["spacecraft"]["wheels"][0]["max_torque_nm"] = json!(-1);
    study["options"] = json!({"momentum_authority": 0});
    let answer = slewplan_fed(&line, study.to_string().as_bytes()).expect_code(2);
    for place in [
        "/turns/1: ",
        "/spacecraft/wheels/0/max_torque_nm",
        "/options/momentum_authority",
    ] {
        assert!(answer.stderr.contains(place), "{answer:?}");
    }
}

#[test]
fn the_published_comparison_needs_no_input() {
    let answer = slewplan(&["study", "comparison"]).expect_code(0);
    let study = answer.json();
    let number = |place: &str| {
        let value = study.pointer(place).and_then(Value::as_f64);
        value.unwrap_or_else(|| panic!("no number at {place}"))
    };
    // The published sizes; time-optimal wheels with devices of 0.01 N m s win beyond 25.5 degrees.
    assert_eq!(study["sizes"].as_array().map(Vec::len), Some(3));
    assert!((number("/sizes/0/inertia_kg_m2") - 25.458).abs() < 1e-3);
    let angle = number("/sizes/2/advantages/2/angle_rad").to_degrees();
    assert!((angle - 25.5).abs() < 0.1, "{angle}");
    let published = study["advantage"]["published"].as_array();
    let published: Vec<f64> = published
        .expect("a list")
        .iter()
        .map(|of| of["angle_rad"].as_f64().expect("an angle").to_degrees())
        .collect();
    for (found, expected) in published.iter().zip([77.0, 24.1, 30.3]) {
        assert!((found - expected).abs() < 1e-9, "{published:?}");
    }
    assert!((number("/mass/crossover_kg") - 0.908).abs() < 1e-3);
    assert!((number("/singular_states/least_elliptic") - 1.1547).abs() < 1e-4);
    assert_eq!(
        study["market"]["wheel"]["devices"].as_array().map(Vec::len),
        Some(61)
    );
    let surfaces = study["singular_states"]["surfaces"].as_array();
    assert_eq!(surfaces.map(Vec::len), Some(8));
    // It can be drawn.
    let drawn = slewplan_fed(&["plot", "-"], answer.stdout.as_bytes());
    let drawn = drawn.expect_code(0).stdout;
    for words in [
        "Wheels against gyroscopes",
        "Slew time, s; devices of 0.01 N m s",
        "Advantage angle, degrees",
        "Torque of four, N m",
        "0.9082",
    ] {
        assert!(drawn.contains(&format!(">{words}<")), "{words}");
    }
    assert!(!drawn.contains("NaN") && !drawn.contains("inf"));
}

#[test]
fn a_comparison_takes_other_values_and_lists_their_problems() {
    let other = json!({"momenta_nms": [0.1], "angles_rad": [1.0], "radii": {"kind": "computed"}});
    let line = ["study", "comparison", "-"];
    let answer = slewplan_fed(&line, other.to_string().as_bytes());
    let answer = answer.expect_code(0).json();
    assert_eq!(answer["sizes"].as_array().map(Vec::len), Some(1));
    for radius in answer["radii"].as_array().expect("a list") {
        assert_eq!(radius["momentum"], radius["computed_momentum"]);
    }
    let wrong = json!({"momenta_nms": [0], "surface_rows": 0, "curve_momenta_nms": []});
    let answer = slewplan_fed(&line, wrong.to_string().as_bytes()).expect_code(2);
    for place in ["/momenta_nms/0", "/surface_rows", "/curve_momenta_nms"] {
        assert!(answer.stderr.contains(place), "{answer:?}");
    }
}

/// The document of a study of a flight.
fn flight(scenario: &str, members: &[(&str, Value)]) -> Value {
    let mut study = json!({"scenario": fixture_json(scenario)});
    for (name, value) in members {
        study[*name] = value.clone();
    }
    let answer = slewplan_fed(&["study", "flight", "-"], study.to_string().as_bytes());
    answer.expect_code(0).json()
}

fn end_error(answer: &Value) -> f64 {
    let error = answer["flight"]["end"]["attitude_rad"].as_f64();
    error.unwrap_or_else(|| panic!("no error: {}", answer["status"]))
}

#[test]
fn a_flight_without_errors_follows_its_plan_and_a_step_command_does_not() {
    let open = json!({"controller": {"kind": "feed_forward"}, "feed_forward": "time_tagged"});
    let turn = "quarter-turn.json";
    let answer = flight(turn, &[("simulation", open), ("keep_every", json!(1))]);
    let flown = &answer["flight"];
    assert_eq!(
        (
            &answer["status"],
            &flown["plan_status"],
            &flown["within_tolerance"]
        ),
        (&json!("flown"), &json!("optimal"), &json!(true))
    );
    assert!(end_error(&answer) < 1e-9, "{}", flown["end"]);
    assert!(flown["peak"]["attitude_rad"].as_f64() < Some(1e-9));
    // There is a sample every tenth of a second.
    let samples = flown["samples"].as_array().expect("a list");
    let seconds = flown["flight_time_s"].as_f64().expect("a time");
    assert!((samples.len() as f64 - seconds * 10.0).abs() < 1.0 + 1e-9);
    let wheels = &samples[0];
    for list in ["wheel_torque_nm", "torque_limited", "speed_limited"] {
        assert_eq!(wheels[list].as_array().map(Vec::len), Some(3), "{list}");
    }
    // Commanding the end attitude from the first sample on reaches the limits and takes longer.
    let step = json!({"controller": {"kind": "step_input",
        "gains": {"kind": "bandwidth", "bandwidth_rad_s": 0.1}}});
    let step = flight(turn, &[("simulation", step)]);
    assert!(end_error(&step) > 0.05, "{}", step["flight"]["end"]);
    assert_eq!(step["flight"]["within_tolerance"], json!(false));
    let limited = |answer: &Value| {
        let samples = answer["flight"]["samples"].as_array().expect("a list");
        let met = |sample: &&Value| sample["torque_limited"] != json!([false, false, false]);
        samples.iter().filter(met).count()
    };
    assert!(limited(&step) > 0 && limited(&answer) == 0);
}

#[test]
fn a_flight_is_reproducible_and_takes_a_given_plan() {
    let scenario = fixture("two-targets.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).json();
    let errors = json!({"errors": {"inertia_3_sigma": 0.05}, "seed": 7});
    let of = |number: u64| {
        let members = [
            ("simulation", errors.clone()),
            ("plan", plan.clone()),
            ("flight", json!(number)),
            ("keep_every", json!(50)),
        ];
        flight("two-targets.json", &members)
    };
    let (first, again, other) = (of(0), of(0), of(1));
    assert_eq!(first, again);
    assert!((end_error(&first) - end_error(&other)).abs() > 1e-6);
    assert_eq!(first["flight"]["plan_status"], Value::Null);
    let kept = |answer: &Value| answer["flight"]["samples"].as_array().map(Vec::len);
    assert!(kept(&first).is_some_and(|count| count > 2));
    // With the given plan the flight is the same.
    let members = [("simulation", errors.clone()), ("keep_every", json!(50))];
    let planned = flight("two-targets.json", &members);
    assert!((end_error(&planned) - end_error(&first)).abs() < 1e-9);
    // It can be drawn with the limits of the scenario.
    let line = ["plot", "-", "--scenario", &scenario];
    let drawn = slewplan_fed(&line, first.to_string().as_bytes());
    let drawn = drawn.expect_code(0).stdout;
    assert!(drawn.contains("Attitude error") && drawn.contains("limit \u{b1}710"));
    assert!(drawn.contains("simulated in closed loop") && !drawn.contains("NaN"));
}

#[test]
fn all_problems_of_a_flight_are_listed() {
    let mut scenario = fixture_json("two-targets.json");
    scenario["targets"][0]["id"] = json!("");
    let study = json!({
        "scenario": scenario,
        "plan": {"total_time_s": "1"},
        "simulation": {"on_board_rate_hz": -1, "controller": {"kind": "none"}},
        "keep_every": 0,
    });
    let line = ["study", "flight", "-"];
    let answer = slewplan_fed(&line, study.to_string().as_bytes()).expect_code(2);
    for place in [
        "/scenario/targets/0/id",
        "/simulation/controller/kind",
        "/keep_every",
    ] {
        assert!(answer.stderr.contains(place), "{place}: {answer:?}");
    }
    let study = json!({
        "scenario": fixture_json("two-targets.json"),
        "plan": {"total_time_s": "1"},
        "simulation": {"on_board_rate_hz": -1},
    });
    let answer = slewplan_fed(&line, study.to_string().as_bytes()).expect_code(2);
    for place in [
        "/plan/total_time_s",
        "/plan/passages",
        "/simulation/on_board_rate_hz",
    ] {
        assert!(answer.stderr.contains(place), "{place}: {answer:?}");
    }
}
