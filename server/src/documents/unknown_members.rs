//! A member that nobody knows is refused wherever it stands: what is misspelt is not ignored.

use super::study::{authority, comparison, envelopes, flight};
use super::{scenario, slew};
use slewplan_solver::model::problem::{Code, Problem};
use std::path::{Path, PathBuf};

const EXTRA: &str = "never_heard_of";

/// A reader that tells nothing but problems.
type Reader = fn(&[u8]) -> Result<(), Vec<Problem>>;

/// The reader of the fixtures of a folder, by the beginning of their names.
const READERS: [(&str, &str, Reader); 7] = [
    (".", "", |text| scenario::read(text, None).map(drop)),
    ("gallery", "", |text| scenario::read(text, None).map(drop)),
    ("slews", "", |text| slew::read(text).map(drop)),
    ("studies", "authority", |text| {
        authority::read(text).map(drop)
    }),
    ("studies", "comparison", |text| {
        comparison::read(text).map(drop)
    }),
    ("studies", "flight", |text| flight::read(text).map(drop)),
    ("studies", "pyramid", |text| envelopes::read(text).map(drop)),
];

/// Documents that differ from a text in one object each, which has a member more.
pub(super) fn with_an_extra_member(text: &str) -> impl Iterator<Item = String> + '_ {
    text.match_indices('{').map(|(place, _)| {
        let (before, after) = text.split_at(place + 1);
        let comma = if after.trim_start().starts_with('}') {
            ""
        } else {
            ","
        };
        format!("{before}\"{EXTRA}\": 1{comma}{after}")
    })
}

/// Whether a refusal is for the extra member.
pub(super) fn is_told(problems: &[Problem]) -> bool {
    let told = |problem: &Problem| {
        problem.code == Code::UnknownField && problem.pointer.ends_with(&format!("/{EXTRA}"))
    };
    problems.iter().any(told)
}

/// The documents of a folder of the fixtures.
pub(super) fn documents(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    let files = std::fs::read_dir(root.join(folder)).expect("the fixtures are there");
    let mut paths: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|kind| kind == "json"));
    paths.sort();
    paths
}

#[test]
fn in_every_object_of_every_fixture_it_is_refused() {
    for (folder, name, read) in READERS {
        let mut paths = documents(folder);
        paths.retain(|path| {
            let stem = path.file_stem().and_then(|stem| stem.to_str());
            stem.is_some_and(|stem| stem.starts_with(name))
        });
        assert!(!paths.is_empty(), "{folder} {name}");
        for path in paths {
            let text = std::fs::read_to_string(&path).expect("a fixture can be read");
            read(text.as_bytes()).unwrap_or_else(|problems| panic!("{path:?}: {problems:?}"));
            for changed in with_an_extra_member(&text) {
                let problems = read(changed.as_bytes()).expect_err(&changed);
                assert!(is_told(&problems), "{path:?}: {problems:?} of {changed}");
            }
        }
    }
}
