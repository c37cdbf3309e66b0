//! Wheels against gyroscopes: the request. Whatever is left out is as in the thesis.

mod answer;

pub(crate) use answer::ComparisonAnswerDocument;

use crate::documents::document::{self, Node};
use crate::documents::reader::{Cursor, Sink};
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_studies::comparison::{ComparisonStudySpec, MAX_ROWS};

/// Reads a comparison.
///
/// # Errors
///
/// Everything that is wrong with its shape.
pub(crate) fn read(bytes: &[u8]) -> Result<ComparisonStudySpec, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    read_node(&node)
}

/// Reads a comparison that has been parsed.
///
/// # Errors
///
/// Everything that is wrong with its shape.
pub(crate) fn read_node(node: &Node) -> Result<ComparisonStudySpec, Vec<Problem>> {
    let sink = Sink::default();
    let root = Cursor::root(node, &sink);
    let spec = ComparisonStudySpec::read(&root);
    if let Some(spec) = &spec {
        check_rows(spec.surface_rows, &root);
    }
    let problems = sink.into_problems();
    spec.filter(|_| problems.is_empty()).ok_or(problems)
}

/// A document may ask for fewer rows than can be computed.
fn check_rows(count: usize, root: &Cursor<'_>) {
    if count > MAX_ROWS
        && let Some(rows) = root.member("surface_rows")
    {
        rows.report(
            Code::OutOfRange,
            format!("there are {count} rows"),
            format!("give 1 to {MAX_ROWS} rows"),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_studies::comparison::{Laws, Radii};

    #[test]
    fn nothing_given_is_the_study_of_the_thesis() {
        assert_eq!(read(b"{}").unwrap(), ComparisonStudySpec::default());
    }

    #[test]
    fn what_is_given_is_taken_and_the_rest_is_as_published() {
        let text = br#"{"momenta_nms": [0.5], "surface_rows": 3,
            "radii": {"kind": "given", "cmg": {"momentum": 1, "torque": 1}},
            "laws": {"kind": "tables"}}"#;
        let spec = read(text).unwrap();
        assert_eq!(spec.momenta_nms, [0.5]);
        assert_eq!(spec.surface_rows, 3);
        let radii = spec.radii;
        assert_eq!(radii.optimal, Radii::PUBLISHED.optimal);
        assert!((radii.gyroscopes.momentum - 1.0).abs() < 1e-15);
        assert_eq!(Some(spec.laws), Laws::of_the_tables());
        let computed = read(br#"{"radii": {"kind": "computed"}}"#).unwrap();
        assert_eq!(Some(computed.radii), Radii::of_the_pyramid());
    }

    #[test]
    fn every_problem_has_its_place() {
        let text = br#"{"radii": {"kind": "given", "cmg": {"momentum": 1}, "rw": 1},
            "laws": {"kind": "published", "wheel": {}}, "surface_rows": 41, "angles_rad": ["1"]}"#;
        let problems = read(text).unwrap_err();
        let found: Vec<(&str, Code)> = problems
            .iter()
            .map(|problem| (problem.pointer.as_str(), problem.code))
            .collect();
        for expected in [
            ("/radii/cmg/torque", Code::MissingField),
            ("/radii/rw", Code::UnknownField),
            ("/laws/wheel", Code::UnknownField),
            ("/surface_rows", Code::OutOfRange),
            ("/angles_rad/0", Code::WrongType),
        ] {
            assert!(found.contains(&expected), "{expected:?} in {found:?}");
        }
    }
}
