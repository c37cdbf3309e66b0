//! Epochs, time systems and frames, and targets on the sky.

use crate::refusals::expect_refused;
use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// The two-target fixture with a member.
fn with(name: &str, value: &str) -> Vec<u8> {
    let mut scenario = fixture_json("two-targets.json");
    scenario[name] = json!(value);
    scenario.to_string().into_bytes()
}

#[test]
fn labels_that_mean_nothing_are_refused() {
    for epoch in [
        "soon",
        "2026-05-05 12:00",
        "2026-05-05",
        "2026-02-30T00:00:00Z",
    ] {
        expect_refused(&with("epoch", epoch), &[("/epoch", "invalid_epoch")]);
    }
    for system in ["UCT", "utc", "GMT", ""] {
        let expected = [("/time_system", "unknown_choice")];
        expect_refused(&with("time_system", system), &expected);
    }
    for frame in ["EME200", "inertial"] {
        let expected = [("/reference_frame", "unknown_choice")];
        expect_refused(&with("reference_frame", frame), &expected);
    }
}

#[test]
fn the_likely_label_is_in_the_hint() {
    for (name, wrong, meant) in [
        ("time_system", "UCT", "UTC"),
        ("time_system", "tai", "TAI"),
        ("reference_frame", "EME200", "EME2000"),
        ("reference_frame", "ITRF2015", "ITRF2005"),
    ] {
        let told = slewplan_fed(&["solve", "-"], &with(name, wrong)).expect_code(2);
        let hint = format!("did you mean {meant:?}? Known here: ");
        assert!(told.stderr.contains(&hint), "{}", told.stderr);
    }
}

#[test]
fn every_time_system_is_written_into_an_attitude_message() {
    let scenario = fixture("quarter-turn.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    for system in ["UTC", "TAI", "TT", "GPS", "TDB", "TCB", "TCG", "UT1"] {
        let mut labelled = fixture_json("quarter-turn.json");
        labelled["time_system"] = json!(system);
        labelled["reference_frame"] = json!("GCRF");
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("labelled.json");
        std::fs::write(&path, labelled.to_string()).expect("written");
        let path = path.to_str().expect("a path");
        let line = ["export", path, "-", "--format", "aem-kvn"];
        let message = slewplan_fed(&line, plan.as_bytes()).expect_code(0).stdout;
        assert!(message.contains(&format!("TIME_SYSTEM = {system}\n")));
        assert!(message.contains("REF_FRAME_A = GCRF\n"));
    }
}

/// Where a body axis of a passage points: right ascension and declination, degrees.
fn on_the_sky(passage: &Value, axis: [f64; 3]) -> [f64; 2] {
    let q = &passage["attitude"]["quaternion"];
    let part = |name: &str| q[name].as_f64().expect("a number");
    let v = [part("x"), part("y"), part("z")];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let twice = cross(v, axis).map(|c| 2.0 * c);
    let bent = cross(v, twice);
    let [x, y, z] = [0, 1, 2].map(|i| axis[i] + part("w") * twice[i] + bent[i]);
    [
        y.atan2(x).to_degrees().rem_euclid(360.0),
        z.asin().to_degrees(),
    ]
}

#[test]
fn targets_on_the_sky_are_met_by_their_boresights() {
    let path = fixture("ra-dec.json");
    let plan = slewplan(&["solve", &path]).expect_code(0).json();
    assert_eq!(plan["verification"]["passed"], true);
    assert_eq!(plan["warnings"], json!([]));
    let passages = plan["passages"].as_array().expect("a list");
    assert_eq!(passages.len(), 4);
    for passage in passages {
        let (axis, expected) = match passage["target"].as_str() {
            Some("vega") => ([1.0, 0.0, 0.0], [279.235, 38.784]),
            Some("altair") => ([1.0, 0.0, 0.0], [297.696, 8.868]),
            Some("deneb") => ([1.0, 0.0, 0.0], [310.358, 45.28]),
            _ => ([0.0, -1.0, 0.0], [310.0, 20.0]),
        };
        let found = on_the_sky(passage, axis);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3, "{passage}");
        }
    }
}

#[test]
fn a_declination_beyond_the_pole_and_an_unknown_boresight_are_refused() {
    let mut scenario = fixture_json("ra-dec.json");
    scenario["targets"][0]["attitude"]["ra_dec_roll_deg"][1] = json!(138.784);
    scenario["targets"][1]["attitude"]["boresight"] = json!("camra");
    let expected = [
        ("/targets/0/attitude/ra_dec_roll_deg/1", "out_of_range"),
        ("/targets/1/attitude/boresight", "unknown_reference"),
    ];
    let text = scenario.to_string();
    expect_refused(text.as_bytes(), &expected);
    let told = slewplan_fed(&["solve", "-"], text.as_bytes()).stderr;
    assert!(told.contains("did you mean \"camera\"?"), "{told}");
}
