//! The rooms of the packages and the arrows between them.
//!
//! A room is a folder of `solver/src` or `server/src`; it may use the rooms that the table names, and
//! itself. Of a folder inside a room that has a line of its own, that line counts. Tests may use
//! anything. `cargo test -p slewplan-tests --test structure -- --nocapture` prints what is used.

mod pages;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A place in the sources, and the modules that it may use.
type Row = (&'static str, &'static [&'static str]);

/// The solver, from the ground up.
const SOLVER: &[Row] = &[
    ("math", &[]),
    // The signal to stop uses nothing else, so that every loop may poll it.
    ("run/sharing", &[]),
    ("run/stop", &["run::sharing"]),
    ("nlp", &["math", "run::stop"]),
    ("model", &["math"]),
    ("run", &["model"]),
    ("wheels", &["math", "model"]),
    // Shares no code with what it checks.
    ("checker", &["model"]),
    ("bounds", &["math", "model"]),
    ("bounds/kinematic", &["math::quaternion", "model::attitude"]),
    // The second proof knows what is claimed, and nothing of how it was found.
    (
        "bounds/certify",
        &[
            "bounds::interval",
            "bounds::kinematic::certificate",
            "bounds::kinematic::limits",
            "bounds::polytope::certificate",
            "bounds::polytope::trapezoid",
            "model::attitude",
        ],
    ),
    (
        "leg",
        &["bounds::kinematic", "math", "model", "nlp", "run::stop"],
    ),
    ("slew", &["checker", "leg", "math", "model", "nlp", "run"]),
    ("simulation", &["checker", "math", "model", "run"]),
    (
        "tour",
        &[
            "bounds", "checker", "leg", "math", "model", "nlp", "run", "wheels",
        ],
    ),
    // The search knows slews through its trait only.
    ("tour/order", &["math::random", "model::order_rules", "run"]),
    // Knows times alone.
    (
        "tour/schedule",
        &["math::random", "model::order_rules", "tour::order::Place"],
    ),
];

/// The server, from the ground up.
const SERVER: &[Row] = &[
    ("base", &[]),
    ("store", &["base"]),
    ("documents", &["base", "store"]),
    ("render", &["base", "documents"]),
    ("render/plot", &["documents", "render::report"]),
    ("jobs", &["base", "documents", "store"]),
    ("api", &["base", "documents", "jobs", "render", "store"]),
    ("service", &["api", "base", "documents", "jobs", "store"]),
    (
        "cli",
        &[
            "api",
            "base",
            "documents",
            "jobs",
            "render",
            "service",
            "store",
        ],
    ),
];

/// The sources below a folder, by their paths there; tests left out.
fn sources(folder: &str) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(folder);
    let (mut open, mut found) = (vec![root.clone()], Vec::new());
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("sources are there") {
            let path: PathBuf = entry.expect("a readable entry").path();
            let name = path.strip_prefix(&root).expect("below the root");
            let name = name.display().to_string();
            if path.is_dir() {
                open.push(path);
            } else if !name.ends_with("tests.rs") && !name.contains("/tests/") {
                let text = std::fs::read_to_string(&path).expect("a readable source");
                let code = text.split("#[cfg(test)]\nmod tests {").next();
                found.push((name, code.unwrap_or_default().to_owned()));
            }
        }
    }
    assert!(found.len() > 30, "{folder} has {} files", found.len());
    found
}

/// The modules of the crate that a source names in its code.
fn used(text: &str) -> Vec<String> {
    let code = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let tails = code.flat_map(|line| line.split("crate::").skip(1));
    let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let path = |tail: &str| -> String { tail.chars().take_while(|c| is_path(*c)).collect() };
    tails.map(path).collect()
}

/// Whether a path is this module or lies in it.
fn lies_in(path: &str, module: &str) -> bool {
    path.strip_prefix(module)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

fn keeps_to(folder: &str, table: &[Row]) {
    let mut arrows: BTreeMap<(&str, String), usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (file, text) in sources(folder) {
        let is_in = |place: &str| {
            file.strip_prefix(place)
                .is_some_and(|rest| rest == ".rs" || rest.starts_with('/'))
        };
        let rows = table.iter().filter(|(place, _)| is_in(place));
        let Some((place, given)) = rows.max_by_key(|(place, _)| place.len()) else {
            assert!(
                ["lib.rs", "main.rs"].contains(&&*file),
                "{file} is in no room"
            );
            continue;
        };
        for target in used(&text) {
            let own = lies_in(&target, &place.replace('/', "::"));
            if !own && !given.iter().any(|module| lies_in(&target, module)) {
                wrong.push(format!("{file} uses {target}"));
            }
            if !own {
                let room = target.split("::").next().unwrap_or_default();
                *arrows.entry((place, room.to_owned())).or_default() += 1;
            }
        }
    }
    for ((place, target), count) in arrows {
        println!("{folder}/{place} -> {target} ({count})");
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_rooms_of_the_solver_use_those_below_them() {
    keeps_to("solver/src", SOLVER);
}

#[test]
fn the_rooms_of_the_server_use_those_below_them() {
    keeps_to("server/src", SERVER);
}

#[test]
fn the_library_knows_neither_studies_nor_server() {
    for (file, text) in sources("solver/src") {
        assert!(
            !text.contains("slewplan_studies") && !text.contains("slewplan_server"),
            "{file}"
        );
    }
}

#[test]
fn one_file_names_clarabel() {
    let files = sources("solver/src").into_iter();
    let naming: Vec<_> = files
        .filter(|(_, text)| text.contains("clarabel::"))
        .map(|(name, _)| name)
        .collect();
    assert_eq!(naming, ["math/convex.rs"]);
}
