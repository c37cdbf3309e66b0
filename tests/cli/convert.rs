//! `slewplan convert`.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::json;
use std::fs;

const TABLE: &str =
    "ID,RA_deg,Dec_deg,Roll_deg,Dwell_s\nm31,10.68,41.27,0,60\nm33,23.46,30.66,45,\n";

#[test]
fn a_table_becomes_a_list_of_targets() {
    let ended = slewplan_fed(&["convert", "-"], TABLE.as_bytes()).expect_code(0);
    assert_eq!(
        ended.json(),
        json!([
            {"id": "m31", "dwell_s": 60.0,
             "attitude": {"ra_dec_roll_deg": [10.68, 41.27, 0.0], "boresight": [0.0, 0.0, 1.0]}},
            {"id": "m33",
             "attitude": {"ra_dec_roll_deg": [23.46, 30.66, 45.0], "boresight": [0.0, 0.0, 1.0]}},
        ])
    );
    assert!(
        ended.stderr.contains("ra and dec point body z"),
        "{ended:?}"
    );
    let named =
        slewplan_fed(&["convert", "-", "--boresight", "-y"], TABLE.as_bytes()).expect_code(0);
    assert_eq!(
        named.json()[0]["attitude"]["boresight"],
        json!([0.0, -1.0, 0.0])
    );
    assert_eq!(named.stderr, "");
}

#[test]
fn stars_without_a_roll_become_pointings_that_a_scenario_takes() {
    let table = "id,ra,dec,roll_min,roll_max\nvega,279.23,38.78,,\nsirius,101.29,-16.72,-20,20\n";
    let ended = slewplan_fed(&["convert", "-"], table.as_bytes()).expect_code(0);
    let expected = json!([
        {"id": "vega", "pointing": {"boresight": [0.0, 0.0, 1.0], "ra_dec_deg": [279.23, 38.78]}},
        {"id": "sirius", "pointing": {
            "boresight": [0.0, 0.0, 1.0], "ra_dec_deg": [101.29, -16.72],
            "roll_min_deg": -20.0, "roll_max_deg": 20.0}},
    ]);
    assert_eq!(ended.json(), expected);
    let base = fixture("two-targets.json");
    let into = slewplan_fed(&["convert", "-", "--into", &base], table.as_bytes()).expect_code(0);
    let filled = into.json();
    assert_eq!(filled["targets"][1]["pointing"]["roll_max_deg"], 20.0);
    let text = filled.to_string();
    slewplan_fed(&["validate", "-"], text.as_bytes()).expect_code(0);
}

#[test]
fn a_scenario_with_the_targets_is_valid_and_solved() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (table, base, into) = (
        path("targets.csv"),
        path("base.json"),
        path("scenario.json"),
    );
    fs::write(&table, TABLE).expect("written");
    let mut scenario = fixture_json("two-targets.json");
    scenario["spacecraft"]["boresights"] = json!([{"name": "camera", "axis": [0, 1, 0]}]);
    scenario
        .as_object_mut()
        .expect("an object")
        .remove("targets");
    fs::write(&base, scenario.to_string()).expect("written");
    let ended = slewplan(&["convert", &table, "--into", &base, "-o", &into]).expect_code(0);
    assert_eq!((ended.stdout.as_str(), ended.stderr.as_str()), ("", ""));
    slewplan(&["validate", &into]).expect_code(0);
    let plan = slewplan(&["solve", &into]).expect_code(0).json();
    let mut sequence: Vec<_> = plan["sequence"].as_array().expect("a list").clone();
    sequence.sort_by_key(ToString::to_string);
    assert_eq!(sequence, [json!("m31"), json!("m33")]);
    // Once more, in place of what is there now.
    fs::write(&table, "id,qx,qy,qz,qw\nonly,0,0,0.6,0.8\n").expect("written");
    slewplan(&["convert", &table, "--into", &into, "-o", &into]).expect_code(0);
    let text = fs::read_to_string(&into).expect("there");
    let filled: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(filled["targets"][0]["id"], "only");
    assert_eq!(filled["targets"].as_array().map(Vec::len), Some(1));
    assert_eq!(filled["spacecraft"], scenario["spacecraft"]);
}

#[test]
fn everything_wrong_with_table_and_scenario_is_listed_by_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let base = folder.path().join("base.json");
    let mut scenario = fixture_json("two-targets.json");
    scenario["spacecraft"]["wheels"][0]["max_torque_nm"] = json!(-1);
    fs::write(&base, scenario.to_string()).expect("written");
    let base = base.to_str().expect("UTF-8");
    let table = "id,roll,pitch,yaw,dwell\na,1,2,3,-4\na,1,2,3,0\n";
    let ended = slewplan_fed(&["convert", "-", "--into", base], table.as_bytes()).expect_code(2);
    for line in [
        format!("{base} is not valid: 1 problem"),
        "/spacecraft/wheels/0/max_torque_nm: ".to_owned(),
        "standard input is not valid: 2 problems".to_owned(),
        "line 2, column 5 (dwell): ".to_owned(),
        "line 3, column 1 (id): ".to_owned(),
    ] {
        assert!(ended.stderr.contains(&line), "{line} is not in {ended:?}");
    }
    assert_eq!(ended.stdout, "");
    let ended = slewplan_fed(&["convert", "-"], b"id,ra,dec\na,x,y\n").expect_code(2);
    assert!(
        ended
            .stderr
            .contains("line 2, column 2 (ra): expected a number, found the text \"x\""),
        "{ended:?}"
    );
    assert!(
        ended.stderr.contains("line 2, column 3 (dec): "),
        "{ended:?}"
    );
}

#[test]
fn the_boresight_must_be_known_and_not_a_guess() {
    let folder = tempfile::tempdir().expect("a folder");
    let base = folder.path().join("base.json");
    let mut scenario = fixture_json("two-targets.json");
    scenario["spacecraft"]["boresights"] =
        json!([{"name": "camera", "axis": [0, 0, 1]}, {"name": "antenna", "axis": [0.6, 0, 0.8]}]);
    fs::write(&base, scenario.to_string()).expect("written");
    let base = base.to_str().expect("UTF-8");
    let convert = |arguments: &[&str]| {
        let all = [&["convert", "-", "--into", base], arguments].concat();
        slewplan_fed(&all, TABLE.as_bytes())
    };
    let told = convert(&[]).expect_code(2).stderr;
    assert!(
        told.contains("several boresights; name one of camera, antenna"),
        "{told}"
    );
    let told = convert(&["--boresight", "radar"]).expect_code(2).stderr;
    assert!(
        told.contains("\"radar\" is none of camera, antenna, x, y, z"),
        "{told}"
    );
    let filled = convert(&["--boresight", "antenna"]).expect_code(0).json();
    assert_eq!(
        filled["targets"][1]["attitude"]["boresight"],
        json!([0.6, 0.0, 0.8])
    );
    slewplan(&["convert", "-", "--into", "-"]).expect_code(2);
    slewplan(&["convert", &fixture("none.csv")]).expect_code(2);
}
