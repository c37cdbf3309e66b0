//! Runs the built binary.

use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The result of a run.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Ended {
    /// The document on standard output.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }

    /// Asserts the exit code, and that there is no trace of a panic.
    #[track_caller]
    pub(crate) fn expect_code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:?}");
        for trace in ["panicked", "RUST_BACKTRACE", "internal error"] {
            assert!(
                !self.stdout.contains(trace) && !self.stderr.contains(trace),
                "{self:?}"
            );
        }
        self
    }
}

impl From<Output> for Ended {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("UTF-8 on standard output"),
            stderr: String::from_utf8(output.stderr).expect("UTF-8 on standard error"),
        }
    }
}

/// The binary, not yet started.
pub(crate) fn binary() -> Command {
    Command::new(env!("CARGO_BIN_EXE_slewplan"))
}

/// Runs the binary with arguments and nothing on standard input.
pub(crate) fn slewplan(arguments: &[&str]) -> Ended {
    binary()
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("the binary starts")
        .into()
}

/// Runs the binary with arguments and a text on standard input.
pub(crate) fn slewplan_fed(arguments: &[&str], input: &[u8]) -> Ended {
    let mut child = binary()
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    let mut stdin = child.stdin.take().expect("standard input is piped");
    // A binary that refuses its arguments does not read its input.
    let _ = stdin.write_all(input);
    drop(stdin);
    child.wait_with_output().expect("the binary ends").into()
}

/// The path of a fixture.
pub(crate) fn fixture(name: &str) -> String {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "tests", "fixtures", name]
        .iter()
        .collect();
    path.to_str().expect("UTF-8 path").to_owned()
}

/// A fixture as a document.
pub(crate) fn fixture_json(name: &str) -> Value {
    let text = std::fs::read_to_string(fixture(name)).expect("the fixture is there");
    serde_json::from_str(&text).expect("the fixture is JSON")
}

/// Cones of the camera around the equator, 30 degrees apart: closed from 15 degrees on.
pub(crate) fn belt_of_cones(half_angle_deg: f64) -> Value {
    let cone = |step: i32| {
        let (y, x) = f64::from(30 * step).to_radians().sin_cos();
        json!({"boresight": "camera", "direction": [x, y, 0], "half_angle_deg": half_angle_deg})
    };
    (0..12).map(cone).collect()
}

/// The names in a folder, sorted.
pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| {
            entry
                .expect("readable")
                .file_name()
                .into_string()
                .expect("UTF-8")
        })
        .collect();
    names.sort();
    names
}
