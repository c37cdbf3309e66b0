//! Wheels against gyroscopes: the request. Whatever is left out is as in the thesis.

mod answer;

pub(crate) use answer::ComparisonAnswerDocument;

use crate::documents::document::{self, Node};
use crate::documents::reader::{Cursor, Fields, Sink};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_studies::catalogue::PowerLaw;
use slewplan_studies::comparison::{
    ComparisonSpec, ComparisonStudySpec, Laws, PyramidControl, Radii, Radius,
};

/// Most circles of latitude of the singular surfaces in an answer: eight surfaces of some 300 kB.
pub(crate) const MAX_ROWS: usize = 40;
/// Most entries of a list.
pub(crate) const MAX_ENTRIES: usize = 1000;

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
    let spec = decode(&Cursor::root(node, &sink));
    let problems = sink.into_problems();
    spec.filter(|_| problems.is_empty()).ok_or(problems)
}

fn decode(cursor: &Cursor<'_>) -> Option<ComparisonStudySpec> {
    let fields = cursor.object(&[
        "momenta_nms",
        "angles_rad",
        "required_rate_rad_s",
        "radii",
        "laws",
        "curve_momenta_nms",
        "device_masses_kg",
        "surface_rows",
    ])?;
    let usual = ComparisonStudySpec::default();
    let list = |name, usual| list(&fields, name).unwrap_or(usual);
    Some(ComparisonStudySpec {
        comparison: ComparisonSpec {
            momenta_nms: list("momenta_nms", usual.comparison.momenta_nms),
            angles_rad: list("angles_rad", usual.comparison.angles_rad),
            required_rate_rad_s: number(&fields, "required_rate_rad_s")
                .unwrap_or(usual.comparison.required_rate_rad_s),
            radii: fields
                .optional("radii")
                .and_then(|it| radii(&it))
                .unwrap_or(usual.comparison.radii),
            laws: fields
                .optional("laws")
                .and_then(|it| laws(&it))
                .unwrap_or(usual.comparison.laws),
        },
        curve_momenta_nms: list("curve_momenta_nms", usual.curve_momenta_nms),
        device_masses_kg: list("device_masses_kg", usual.device_masses_kg),
        surface_rows: fields
            .optional("surface_rows")
            .and_then(|it| rows(&it))
            .unwrap_or(usual.surface_rows),
    })
}

fn number(fields: &Fields<'_>, name: &str) -> Option<f64> {
    fields.optional(name)?.number()
}

fn list(fields: &Fields<'_>, name: &str) -> Option<Vec<f64>> {
    let read = fields
        .optional(name)?
        .each_of_at_most(MAX_ENTRIES, Cursor::number)?;
    read.into_iter().collect()
}

fn rows(cursor: &Cursor<'_>) -> Option<usize> {
    let count = usize::try_from(cursor.integer()?).unwrap_or(usize::MAX);
    if count > MAX_ROWS {
        cursor.report(
            Code::OutOfRange,
            format!("there are {count} rows"),
            format!("give 1 to {MAX_ROWS} rows"),
        );
        return None;
    }
    Some(count)
}

/// Radii of all controls: those that are not given are as published.
fn radii(cursor: &Cursor<'_>) -> Option<Radii> {
    let kinds = [("published", 0), ("computed", 1), ("given", 2)];
    match cursor.open_object()?.required("kind")?.choice(&kinds)? {
        0 => cursor.object(&["kind"]).map(|_| Radii::PUBLISHED),
        1 => cursor
            .object(&["kind"])
            .and_then(|_| Radii::of_the_pyramid()),
        _ => {
            let known = &[
                "kind",
                "rw_eigenaxis",
                "rw_pseudo_optimal",
                "rw_optimal",
                "cmg",
            ];
            let fields = cursor.object(known)?;
            let radius = |control: PyramidControl| {
                let given = fields.optional(control.into());
                let given = given.and_then(|it| radius(&it));
                given.unwrap_or(Radii::PUBLISHED.of(control))
            };
            Some(Radii {
                eigenaxis: radius(PyramidControl::Eigenaxis),
                pseudo_optimal: radius(PyramidControl::PseudoOptimal),
                optimal: radius(PyramidControl::Optimal),
                gyroscopes: radius(PyramidControl::Gyroscopes),
            })
        }
    }
}

fn radius(cursor: &Cursor<'_>) -> Option<Radius> {
    let fields = cursor.object(&["momentum", "torque"])?;
    let required = |name| fields.required(name).and_then(|it| it.number());
    let (momentum, torque) = (required("momentum"), required("torque"));
    Some(Radius {
        momentum: momentum?,
        torque: torque?,
    })
}

/// Laws of torque: those that are not given are as published.
fn laws(cursor: &Cursor<'_>) -> Option<Laws> {
    let kinds = [("published", 0), ("tables", 1), ("given", 2)];
    match cursor.open_object()?.required("kind")?.choice(&kinds)? {
        0 => cursor.object(&["kind"]).map(|_| Laws::PUBLISHED),
        1 => cursor.object(&["kind"]).and_then(|_| Laws::of_the_tables()),
        _ => {
            let fields = cursor.object(&["kind", "wheel", "gyroscope"])?;
            let law = |name| fields.optional(name).and_then(|it| law(&it));
            Some(Laws {
                wheel: law("wheel").unwrap_or(Laws::PUBLISHED.wheel),
                gyroscope: law("gyroscope").unwrap_or(Laws::PUBLISHED.gyroscope),
            })
        }
    }
}

fn law(cursor: &Cursor<'_>) -> Option<PowerLaw> {
    let fields = cursor.object(&["factor", "exponent"])?;
    let required = |name| fields.required(name).and_then(|it| it.number());
    let (factor, exponent) = (required("factor"), required("exponent"));
    Some(PowerLaw {
        factor: factor?,
        exponent: exponent?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(spec.comparison.momenta_nms, [0.5]);
        assert_eq!(spec.surface_rows, 3);
        let radii = spec.comparison.radii;
        assert_eq!(radii.optimal, Radii::PUBLISHED.optimal);
        assert!((radii.gyroscopes.momentum - 1.0).abs() < 1e-15);
        assert_eq!(Some(spec.comparison.laws), Laws::of_the_tables());
        let computed = read(br#"{"radii": {"kind": "computed"}}"#).unwrap();
        assert_eq!(Some(computed.comparison.radii), Radii::of_the_pyramid());
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
