//! The service as a child process with a database of its own: a file, or, where
//! `SLEWPLAN_TEST_DATABASE` is `postgres`, one of a server.

use crate::client::{Answer, Request};
use crate::postgres;
use serde_json::{Value, json};
use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Time between two looks at what another process does.
#[expect(clippy::disallowed_methods, reason = "polls another process")]
pub(crate) fn pause() {
    std::thread::sleep(Duration::from_millis(10));
}

/// Whether services that choose no database get one of Postgres.
pub(crate) fn on_postgres() -> bool {
    std::env::var("SLEWPLAN_TEST_DATABASE").is_ok_and(|kind| kind == "postgres")
}

/// One job at a time, so that others wait.
pub(crate) const ALONE: [&str; 2] = ["--jobs", "1"];

/// A running service; it is killed when it is dropped.
pub(crate) struct Service {
    child: Child,
    pub(crate) address: String,
    folder: Option<TempDir>,
}

impl Service {
    /// Starts a service on an empty database.
    pub(crate) fn start() -> Self {
        Self::start_with(&[])
    }

    /// Starts a service on an empty database with further arguments.
    pub(crate) fn start_with(arguments: &[&str]) -> Self {
        if on_postgres() {
            let database = postgres::new_database().expect("Postgres is installed");
            return Self::on_database(database.as_ref(), arguments);
        }
        let folder = tempfile::tempdir().expect("a folder");
        let mut service = Self::on(&folder.path().join("test.db"), arguments);
        service.folder = Some(folder);
        service
    }

    /// Starts a service on a file.
    pub(crate) fn on(database: &Path, arguments: &[&str]) -> Self {
        Self::on_database(database.as_os_str(), arguments)
    }

    /// Starts a service on a database of either kind.
    pub(crate) fn on_database(database: &OsStr, arguments: &[&str]) -> Self {
        let listen: &[&str] = if arguments.contains(&"--listen") {
            &[]
        } else {
            &["--listen", "127.0.0.1:0"]
        };
        let mut child = Command::new(env!("CARGO_BIN_EXE_slewplan"))
            .args(["serve", "--log", "warn", "--database"])
            .arg(database)
            .args(listen)
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the binary starts");
        let (line, _) = first_line(&mut child);
        let address = line
            .trim()
            .strip_prefix("listening on http://")
            .expect("the address");
        Self {
            address: address.to_owned(),
            child,
            folder: None,
        }
    }

    pub(crate) fn get(&self, path: &str) -> Answer {
        Request::new("GET", path).send(&self.address)
    }

    pub(crate) fn post(&self, path: &str, document: &Value) -> Answer {
        Request::new("POST", path)
            .json(document)
            .send(&self.address)
    }

    pub(crate) fn send(&self, request: &Request) -> Answer {
        request.send(&self.address)
    }

    /// Submits a scenario and returns the identifier of its job.
    pub(crate) fn submit(&self, scenario: &Value) -> String {
        let answer = self.post("/v1/plans", scenario).expect(202);
        let id = answer.json()["id"]
            .as_str()
            .expect("an identifier")
            .to_owned();
        assert_eq!(answer.header("location"), Some(&*format!("/v1/plans/{id}")));
        id
    }

    pub(crate) fn job(&self, id: &str) -> Value {
        self.get(&format!("/v1/plans/{id}")).expect(200).json()
    }

    /// Waits until a job satisfies a condition.
    pub(crate) fn wait(&self, id: &str, until: impl Fn(&Value) -> bool) -> Value {
        let begin = Instant::now();
        loop {
            let job = self.job(id);
            if until(&job) {
                return job;
            }
            assert!(begin.elapsed() < Duration::from_mins(2), "still {job}");
            pause();
        }
    }

    /// Waits until a job has ended.
    pub(crate) fn wait_end(&self, id: &str) -> Value {
        self.wait(id, |job| !job["finished_at"].is_null())
    }

    /// Kills the service without warning.
    pub(crate) fn kill(&mut self) {
        self.child.kill().expect("it is killed");
        self.child.wait().expect("it ends");
    }

    /// Sends SIGTERM; whether the service exited with success.
    pub(crate) fn terminate(&mut self) -> bool {
        let sent = Command::new("kill")
            .arg(self.child.id().to_string())
            .status();
        assert!(sent.expect("kill is there").success());
        self.child.wait().expect("it ends").success()
    }
}

/// Runs the program to its end.
pub(crate) fn slewplan<A: AsRef<OsStr>>(arguments: &[A]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slewplan"));
    command.args(arguments).output().expect("the binary starts")
}

/// The line that a process prints when it is ready, and what comes after it.
fn first_line(child: &mut Child) -> (String, BufReader<ChildStdout>) {
    let mut line = String::new();
    let stdout = child.stdout.take().expect("standard output is piped");
    let mut stdout = BufReader::new(stdout);
    stdout.read_line(&mut line).expect("a line");
    (line, stdout)
}

/// A running `slewplan work` with one thread; it is killed when it is dropped.
pub(crate) struct Worker(Child);

impl Worker {
    /// Starts a worker.
    pub(crate) fn on(database: &str) -> Self {
        Self::started(database, &[]).0
    }

    /// Starts a worker that offers parts of large tables of legs.
    pub(crate) fn spreading(database: &str) -> Self {
        Self::started(database, &["--spread-legs"]).0
    }

    /// Starts a worker that answers its metrics at the address that is returned.
    pub(crate) fn with_metrics(database: &str) -> (Self, String) {
        let (worker, mut told) = Self::started(database, &["--metrics", "127.0.0.1:0"]);
        let mut line = String::new();
        told.read_line(&mut line).expect("a line");
        let address = line.trim().strip_prefix("metrics on http://");
        (worker, address.expect("the address").to_owned())
    }

    fn started(database: &str, arguments: &[&str]) -> (Self, BufReader<ChildStdout>) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_slewplan"))
            .args([
                "work",
                "--log",
                "warn",
                "--threads",
                "1",
                "--database",
                database,
            ])
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the binary starts");
        let (line, told) = first_line(&mut child);
        assert!(line.starts_with("working on postgres://"), "{line}");
        (Self(child), told)
    }

    /// Sends SIGTERM; whether the worker exited with success.
    pub(crate) fn terminate(&mut self) -> bool {
        let sent = Command::new("kill").arg(self.0.id().to_string()).status();
        assert!(sent.expect("kill is there").success());
        self.0.wait().expect("it ends").success()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // The worker may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Drop for Service {
    fn drop(&mut self) {
        // The service may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A fixture as a document.
pub(crate) fn fixture(name: &str) -> Value {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "tests", "fixtures", name]
        .iter()
        .collect();
    let text = std::fs::read_to_string(path).expect("the fixture is there");
    serde_json::from_str(&text).expect("the fixture is JSON")
}

/// A scenario that is solved at once.
pub(crate) fn small() -> Value {
    fixture("two-targets.json")
}

/// Cones of the camera around the equator, 30 degrees apart: closed from 15 degrees on.
pub(crate) fn belt_of_cones(half_angle_deg: f64) -> Value {
    let cone = |step: i32| {
        let (y, x) = f64::from(30 * step).to_radians().sin_cos();
        json!({"boresight": "camera", "direction": [x, y, 0], "half_angle_deg": half_angle_deg})
    };
    (0..12).map(cone).collect()
}

/// A scenario whose search runs until it is stopped: many close targets have many orders of similar
/// time, and their short legs have loose bounds.
pub(crate) fn large() -> Value {
    let mut scenario = fixture("olivares-c.json");
    let targets = (0..48_u8).map(|number| {
        let [row, column, turn] = [number / 8, number % 8, number % 5].map(f64::from);
        json!({
            "id": format!("t{number}"),
            "attitude": {"roll_pitch_yaw_deg": [7.3 * column - 25.0, 11.9 * row - 30.0, 3.7 * turn]},
            "zero_rate_axes": ["z"],
        })
    });
    scenario["targets"] = targets.collect();
    scenario["options"] = json!({"time_limit_s": null});
    scenario
}
