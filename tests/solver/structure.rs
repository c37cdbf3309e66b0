//! The arrows between the solver's modules, as `solver/README.md` draws them.

use std::path::{Path, PathBuf};

fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../solver/src");
    let mut open = vec![root.clone()];
    let mut found = Vec::new();
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("the solver's sources are there") {
            let path: PathBuf = entry.expect("a readable entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(&root).expect("below the root");
                let text = std::fs::read_to_string(&path).expect("a readable source");
                found.push((name.display().to_string(), text));
            }
        }
    }
    assert!(
        found.len() > 50,
        "the walk found {} files only",
        found.len()
    );
    found
}

/// Modules of the crate that the files of a module name in their code.
fn used_by(module: &str) -> Vec<(String, String)> {
    let own =
        |name: &str| name == format!("{module}.rs") || name.starts_with(&format!("{module}/"));
    let mut used = Vec::new();
    for (name, text) in sources().into_iter().filter(|(name, _)| own(name)) {
        let code = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        for line in code {
            for tail in line.split("crate::").skip(1) {
                let target: String = tail
                    .chars()
                    .take_while(|c| c.is_alphanumeric() || *c == '_')
                    .collect();
                used.push((name.clone(), target));
            }
        }
    }
    assert!(
        !used.is_empty() || ["nlp", "order_rules"].contains(&module),
        "{module} was not found"
    );
    used
}

#[test]
fn a_valid_scenario_knows_nothing_of_how_it_is_solved() {
    let given = [
        "attitude",
        "findings",
        "order_rules",
        "problem",
        "scenario",
        "spacecraft",
        "spec",
        "wheel_axes",
    ];
    let tests = |name: &str| name.ends_with("tests.rs") || name.contains("/tests/");
    for module in ["spacecraft", "scenario", "order_rules"] {
        let used = used_by(module);
        for (file, target) in used.into_iter().filter(|(name, _)| !tests(name)) {
            assert!(given.contains(&target.as_str()), "{file} uses {target}");
        }
    }
}

#[test]
fn the_engine_knows_no_physics() {
    for (file, target) in used_by("nlp") {
        assert_eq!(target, "nlp", "{file} uses {target}");
    }
}

#[test]
fn the_second_engine_knows_problems_and_a_general_solver() {
    for (file, target) in used_by("second_engine") {
        let given = ["convex", "nlp", "second_engine"];
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
}

#[test]
fn the_checker_uses_nothing_of_the_optimiser() {
    let given = [
        "attitude",
        "checker",
        "drive",
        "order_rules",
        "plan",
        "problem",
        "scenario",
        "spacecraft",
        "spec",
    ];
    for (file, target) in used_by("checker") {
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
}

#[test]
fn a_simulated_flight_uses_nothing_of_the_optimiser() {
    let given = [
        "attitude",
        "checker",
        "cone",
        "drive",
        "findings",
        "plan",
        "pool",
        "problem",
        "random",
        "scenario",
        "simulation",
        "spacecraft",
        "stop",
        "wheel_axes",
    ];
    // The study plans anew for every choice of authorities, and tests plan too.
    let flies = |name: &str| name != "simulation/study.rs" && !name.starts_with("simulation/tests");
    let used = used_by("simulation");
    for (file, target) in used.into_iter().filter(|(name, _)| flies(name)) {
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
}

#[test]
fn the_search_knows_slews_through_its_trait_only() {
    let given = [
        "sequence",
        "order_rules",
        "pool",
        "progress",
        "random",
        "stop",
    ];
    for (file, target) in used_by("sequence") {
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
}

#[test]
fn the_kinematic_bound_knows_rotations_only() {
    let given = ["attitude", "kinematic_bound", "kinematics"];
    for (file, target) in used_by("kinematic_bound") {
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
}

#[test]
fn certified_bounds_use_nothing_of_the_optimiser() {
    let given = [
        "attitude",
        "certified",
        "dynamics",
        "kinematic_bound",
        "scenario",
        // Waypoints: attitude and conditions of an end.
        "transcription",
    ];
    for (file, target) in used_by("certified") {
        if file.ends_with("tests.rs") {
            continue;
        }
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
}

#[test]
fn the_second_proof_of_bounds_knows_the_claims_only() {
    for (file, target) in used_by("certify") {
        let given = ["attitude", "certify", "kinematic_bound"];
        assert!(given.contains(&target.as_str()), "{file} uses {target}");
    }
    let own = |name: &str| name.starts_with("certify") && !name.contains("/tests");
    for (file, text) in sources().into_iter().filter(|(name, _)| own(name)) {
        let lines = text.lines().map(str::trim_start);
        for line in lines.filter(|line| !line.starts_with("//")) {
            let claims = ["certificate::", "ramps::{EndRates, SlewLimits}"];
            assert!(
                !line.contains("kinematic_bound::") || claims.iter().any(|of| line.contains(of)),
                "{file}: {line}"
            );
        }
    }
}

#[test]
fn one_file_names_clarabel() {
    let naming: Vec<_> = sources()
        .into_iter()
        .filter(|(_, text)| text.contains("clarabel::"))
        .map(|(name, _)| name)
        .collect();
    assert_eq!(naming, ["convex.rs"]);
}
