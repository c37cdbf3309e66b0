//! Durability over shutdowns and kills of the process.

use crate::client::Request;
use crate::running::{ALONE, Service, fixture, large, small};
use serde_json::{Value, json};
use std::io::Read;

/// A scenario that is solved within seconds on any machine, but not at once.
pub(crate) fn sizeable() -> Value {
    let mut scenario = fixture("olivares-c.json");
    scenario["options"] = json!({"relative_gap": 0.05, "time_limit_s": null});
    scenario
}

#[test]
fn a_killed_solve_runs_again_and_nothing_acknowledged_is_lost() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("killed.db");
    let mut service = Service::on(&database, &ALONE);
    let ids = [service.submit(&sizeable()), service.submit(&small())];
    service.wait(&ids[0], |job| job["state"] == "running");
    service.kill();
    let service = Service::on(&database, &[]);
    let jobs = ids.each_ref().map(|id| service.wait_end(id));
    assert_eq!(
        (&jobs[0]["state"], jobs[0]["attempt"].as_i64()),
        (&"succeeded".into(), Some(2))
    );
    assert_eq!(
        (&jobs[1]["state"], jobs[1]["attempt"].as_i64()),
        (&"succeeded".into(), Some(1))
    );
}

#[test]
fn a_shutdown_returns_the_running_job_without_counting_the_attempt() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("ended.db");
    let mut service = Service::on(&database, &[]);
    let id = service.submit(&sizeable());
    service.wait(&id, |job| job["state"] == "running");
    let events = Request::new("GET", &format!("/v1/plans/{id}/events"));
    let mut stream = events.open(&service.address);
    let mut told = String::new();
    stream.read_exact(&mut [0; 1]).expect("an answer");
    assert!(service.terminate());
    stream.read_to_string(&mut told).expect("the stream ends");
    let last = |text: &str| {
        told.rfind(text)
            .unwrap_or_else(|| panic!("no {text} in {told}"))
    };
    let (ran, given_back) = (last("\"state\":\"running\""), last("\"state\":\"queued\""));
    assert!(ran < given_back && given_back < last("event: closing"));
    let service = Service::on(&database, &[]);
    let job = service.wait_end(&id);
    assert_eq!(
        (&job["state"], job["attempt"].as_i64()),
        (&"succeeded".into(), Some(1))
    );
}

#[test]
fn a_database_is_locked_by_one_service() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("shared.db");
    let _service = Service::on(&database, &[]);
    let second = std::process::Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .args(["serve", "--listen", "127.0.0.1:0", "--database"])
        .arg(&database)
        .output()
        .expect("the binary starts");
    assert_eq!(second.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&second.stderr).contains("another service"));
    assert!(folder.path().join("shared.db.lock").exists());
}

#[test]
fn a_command_shares_legs_with_the_service() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let service = Service::on(&database, &[]);
    let id = service.submit(&small());
    service.wait_end(&id);
    let fixture = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../tests/fixtures/two-targets.json"
    );
    let solved = std::process::Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .args(["solve", fixture, "--format", "json", "--database"])
        .arg(&database)
        .output()
        .expect("the binary starts");
    let plan: Value = serde_json::from_slice(&solved.stdout).expect("a plan");
    assert_eq!(plan["statistics"]["legs_solved"], 0);
}

#[test]
fn legs_are_not_solved_again_after_a_kill() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let mut service = Service::on(&database, &[]);
    let mut scenario = large();
    // So few that all of their legs are solved before the search.
    scenario["targets"]
        .as_array_mut()
        .expect("a list")
        .truncate(36);
    let id = service.submit(&scenario);
    service.wait(&id, |job| job["stage"] == "search");
    let [_, solved] = leg_lookups(&service);
    service.kill();
    let service = Service::on(&database, &[]);
    let searching = |job: &Value| job["attempt"] == 2 && job["stage"] == "search";
    service.wait(&id, searching);
    // The search compares some legs of its tours with legs from rest to rest, which may be new.
    let [found, missing] = leg_lookups(&service);
    assert!(
        solved > 600 && found + COMPARED > solved && missing < COMPARED,
        "{solved} solved, {found} found, {missing} missing"
    );
}

/// Legs from rest to rest that a search may look up until it is seen or killed.
const COMPARED: u64 = 60;

/// Legs that the store had, and those that it had not.
fn leg_lookups(service: &Service) -> [u64; 2] {
    let metrics = service.get("/metrics").expect(200).body;
    ["hit", "miss"].map(|outcome| {
        let name = format!("slewplan_leg_lookups_total{{outcome=\"{outcome}\"}} ");
        let mut counts = metrics.lines().filter_map(|line| line.strip_prefix(&*name));
        let count = counts.next().expect("the metric");
        count.parse().expect("a whole number")
    })
}

/// Runs the program beside a service, in a folder that is not writable; whether it succeeds, and
/// its standard error.
fn beside(arguments: &[&std::ffi::OsStr]) -> (bool, String) {
    let ended = std::process::Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .args(arguments)
        .current_dir("/proc")
        .output()
        .expect("the program runs");
    let told = String::from_utf8_lossy(&ended.stderr).into_owned();
    (ended.status.success(), told)
}

#[test]
fn a_backup_beside_the_service_is_valid_or_absent() {
    let folder = tempfile::tempdir().expect("a folder");
    let [database, copy, text] =
        ["used.db", "copy.db", "text.db"].map(|name| folder.path().join(name));
    let service = Service::on(&database, &[]);
    let id = service.submit(&small());
    service.wait_end(&id);
    let result = service.get(&format!("/v1/plans/{id}/result")).expect(200);
    let back_up = |from: &std::path::Path, to: &std::path::Path| {
        beside(&[
            "backup".as_ref(),
            "--database".as_ref(),
            from.as_ref(),
            to.as_ref(),
        ])
    };
    let (done, told) = back_up(&database, &copy);
    assert!(done, "{told}");
    let other = Service::on(&copy, &[]);
    let copied = other.get(&format!("/v1/plans/{id}/result")).expect(200);
    assert_eq!(copied.json(), result.json());
    std::fs::write(&text, "no database".repeat(1000)).expect("written");
    let before = std::fs::read_dir(folder.path()).expect("a folder").count();
    let nothing = folder.path().join("nothing.db");
    let (done, told) = back_up(&text, &nothing);
    assert!(!done && !told.is_empty() && !nothing.exists(), "{told}");
    let after = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(after, before, "something is left behind");
}
