//! The pages against the tree: links, paths, and what `ARCHITECTURE.md` says about the rooms.

use super::{Row, SERVER, SOLVER};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Beginnings of paths from the top.
const FOLDERS: [&str; 5] = ["solver/", "server/", "tests/", "migrations/", ".ci/"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a readable folder");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("a readable entry").file_name();
    let names = entries.map(|entry| name(entry).to_string_lossy().into_owned());
    names.collect()
}

/// All files whose names end in one of these, by their paths from the top.
fn files(endings: &[&str]) -> Vec<String> {
    let (mut open, mut found) = (vec![String::new()], Vec::new());
    while let Some(folder) = open.pop() {
        for name in names_in(&root().join(&folder)) {
            let path = if folder.is_empty() {
                name.clone()
            } else {
                format!("{folder}/{name}")
            };
            let is_made = ["target", "node_modules", "__pycache__"].contains(&&*name);
            if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push(path);
            } else if !name.starts_with('.') && !is_made && root().join(&path).is_dir() {
                open.push(path);
            }
        }
    }
    assert!(found.len() > 12, "{found:?}");
    found
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).expect("a readable page")
}

/// The lines of a page outside of its blocks of code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut in_code = false;
    text.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        in_code ^= fence;
        !in_code && !fence
    })
}

/// The anchors of a page's headings, as GitHub makes them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).filter(|line| line.starts_with('#'));
    let anchor = |line: &str| -> String {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    headings.map(anchor).collect()
}

/// The targets of the links and pictures of a page.
fn links(text: &str) -> Vec<&str> {
    let tails = prose(text).flat_map(|line| line.split("](").skip(1));
    tails.filter_map(|tail| tail.split(')').next()).collect()
}

#[test]
fn every_relative_link_of_a_page_leads_somewhere() {
    let mut dead = Vec::new();
    for page in files(&[".md"]) {
        let text = read(&page);
        for link in links(&text) {
            if link.contains("://") {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let folder = Path::new(&page).parent().expect("a page is in a folder");
            let target = root().join(folder).join(path);
            let there = if path.is_empty() {
                Some(text.clone())
            } else if anchor.is_empty() {
                target.exists().then(String::new)
            } else {
                fs::read_to_string(&target).ok()
            };
            let found =
                there.is_some_and(|there| anchor.is_empty() || anchors(&there).contains(anchor));
            if !found {
                dead.push(format!("{page}: {link}"));
            }
        }
    }
    assert!(dead.is_empty(), "{dead:#?}");
}

#[test]
fn every_path_that_a_page_or_a_script_names_exists() {
    let mut missing = Vec::new();
    for page in files(&[".md", ".py", ".sh", "equivalent.txt"]) {
        let text = read(&page);
        let ends = |c: char| c.is_whitespace() || "`'\"()[],;|@=#".contains(c);
        for word in text.split(ends) {
            let path = word.trim_end_matches(['.', ':']);
            let is_path = FOLDERS.iter().any(|folder| path.starts_with(folder));
            let is_pattern = path.contains(['*', '{', '$', '<']);
            if is_path && !is_pattern && !root().join(path).exists() {
                missing.push(format!("{page}: {path}"));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

/// The floors of the diagram, from the top, of the solver and of the server.
fn floors(page: &str) -> [Vec<Vec<String>>; 2] {
    let diagram = page
        .split("```text\n")
        .find(|block| block.starts_with("solver/src"))
        .and_then(|block| block.split("```").next())
        .expect("the page has the diagram of the floors");
    let mut floors = [Vec::new(), Vec::new()];
    for line in diagram.lines().skip(1) {
        let sides = line.split_once('|').unwrap_or((line, ""));
        for (floors, side) in floors.iter_mut().zip([sides.0, sides.1]) {
            let rooms: Vec<_> = side.split_whitespace().map(str::to_owned).collect();
            if !rooms.is_empty() {
                floors.push(rooms);
            }
        }
    }
    floors
}

/// Holds the floors of a package against its files and against the table of its arrows.
fn stands(floors: &[Vec<String>], folder: &str, table: &[Row]) {
    let sources = names_in(&root().join(folder)).into_iter();
    let rooms: BTreeSet<_> = sources
        .filter_map(|name| name.strip_suffix(".rs").map(str::to_owned))
        .filter(|room| !["lib", "main"].contains(&&**room))
        .collect();
    let drawn: BTreeSet<_> = floors.iter().flatten().cloned().collect();
    assert_eq!(drawn, rooms, "{folder}");
    let floor = |room: &str| {
        floors
            .iter()
            .position(|floor| floor.iter().any(|r| r == room))
    };
    for (place, used) in table {
        let room = place.split('/').next().unwrap_or_default();
        for module in *used {
            let other = module.split("::").next().unwrap_or_default();
            assert!(
                other == room || floor(other) > floor(room),
                "{folder}: {room} uses {other}, which is drawn no lower"
            );
        }
    }
}

#[test]
fn the_diagram_of_the_rooms_is_that_of_the_tree() {
    let page = read("ARCHITECTURE.md");
    let [solver, server] = floors(&page);
    stands(&solver, "solver/src", SOLVER);
    stands(&server, "server/src", SERVER);
    for room in solver.iter().chain(&server).flatten() {
        assert!(
            page.contains(&format!("\n| `{room}` |")),
            "{room} is not described"
        );
    }
}

#[test]
fn every_step_of_the_walk_is_in_the_code() {
    let page = read("ARCHITECTURE.md");
    let mut steps = 0;
    for line in page.lines().filter(|line| line.starts_with("| `s")) {
        let cells: Vec<_> = line.split('|').map(str::trim).collect();
        let (file, function) = (cells[1].trim_matches('`'), cells[2].trim_matches('`'));
        if !file.contains("/src/") {
            continue;
        }
        let source = read(file);
        let is_there = ["(", "<"].map(|next| source.contains(&format!("fn {function}{next}")));
        assert!(
            is_there.contains(&true),
            "{file} has no function {function}"
        );
        steps += 1;
    }
    assert!(steps > 20, "{steps} steps");
}
