//! Import of legs.

use crate::client::Request;
use crate::running::{Service, small};
use serde_json::{Value, json};
use std::io::Write;
use std::process::{Command, Stdio};

/// A file of legs of a scenario as the command line writes it.
fn file(scenario: &Value, kind: &str) -> Value {
    let mut child = Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .args([
            "legs",
            "-",
            "--trajectories",
            "--progress",
            "none",
            "--kind",
        ])
        .arg(kind)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    let mut stdin = child.stdin.take().expect("standard input is piped");
    stdin
        .write_all(scenario.to_string().as_bytes())
        .expect("it is read");
    drop(stdin);
    let ended = child.wait_with_output().expect("it ends");
    assert!(ended.status.success(), "{ended:?}");
    serde_json::from_slice(&ended.stdout).expect("JSON")
}

#[test]
fn a_plan_uses_imported_legs() {
    let service = Service::start();
    for kind in ["rest_to_rest", "lower_bound"] {
        let file = file(&small(), kind);
        let answer = service.post("/v1/legs/import", &file).expect(200).json();
        assert_eq!(answer["refused"], json!([]));
        let again = service.post("/v1/legs/import", &file).expect(200).json();
        assert_eq!(again["imported"], 0);
        let legs = file["trajectories"].as_array().expect("a list").len();
        assert_eq!(again["known"].as_u64(), Some(legs as u64));
        let key = &file["trajectories"][0]["key"];
        let key = key.as_str().expect("a key");
        let leg = service.get(&format!("/v1/legs/{key}")).expect(200).json();
        assert!(leg["trajectory"]["states"].is_array());
    }
    let id = service.submit(&small());
    assert_eq!(service.wait_end(&id)["state"], "succeeded");
    let result = format!("/v1/plans/{id}/result");
    let plan = service.get(&result).expect(200).json();
    assert_eq!(plan["statistics"]["legs_solved"], 0);
    assert!(plan["statistics"]["legs_from_cache"].as_u64() > Some(0));
}

#[test]
fn failing_legs_are_listed_and_invalid_files_refused() {
    let service = Service::start_with(&["--max-targets", "2"]);
    let whole = file(&small(), "rest_to_rest");
    let mut spoilt = whole.clone();
    // A leg with a rotation: one without ends at its end whatever its torques.
    let motions = whole["trajectories"].as_array().expect("a list");
    let turns = |motion: &Value| motion["lengths_s"][0].as_f64() > Some(0.1);
    let turning = motions.iter().position(turns).expect("a leg that turns");
    spoilt["trajectories"][turning]["attitudes_xyzw"][5] = json!([0, 0, 0, 1]);
    let answer = service.post("/v1/legs/import", &spoilt).expect(200).json();
    let place = format!("/trajectories/{turning}");
    assert_eq!(answer["refused"][0]["pointer"], place.as_str());
    assert_eq!(answer["refused"][0]["code"], "leg_refused");
    let key = motions[turning]["key"].as_str().expect("a key");
    service
        .get(&format!("/v1/legs/{key}"))
        .expect_problem(404, "not_found");

    let mut invalid = whole.clone();
    invalid["scenario"]["targets"] = json!([]);
    invalid["trajectories"][0]["lengths_s"] = json!("long");
    let problem = service
        .post("/v1/legs/import", &invalid)
        .expect_problem(422, "invalid_input");
    let pointers = problem["errors"].as_array().expect("a list").iter();
    let pointers: Vec<_> = pointers.map(|error| &error["pointer"]).collect();
    assert_eq!(pointers, ["/trajectories/0/lengths_s"]);

    let mut old = whole;
    old["version"] = json!("0.0.1");
    let problem = service
        .post("/v1/legs/import", &old)
        .expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/version");
    assert_eq!(problem["errors"][0]["code"], "version_mismatch");

    let mut three = small();
    let mut third = three["targets"][0].clone();
    third["id"] = json!("third");
    three["targets"].as_array_mut().expect("a list").push(third);
    let file = file(&three, "rest_to_rest");
    service
        .post("/v1/legs/import", &file)
        .expect_problem(413, "too_many_targets");
    let request = Request::new("POST", "/v1/legs/import").body("{");
    let request = request.header("Content-Type", "application/json");
    service.send(&request).expect_problem(400, "malformed_json");
}
