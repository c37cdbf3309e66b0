//! The check of a plan's proved bounds, as text.

use super::table::aligned;
use crate::documents::certification::{name, reason};
use slewplan_solver::tour::planner::{CheckedCertificate, PlanCertificate, Verdict};

/// Headers of the numbers, which are aligned to the right below them.
const BOUND: &str = "stated bound [s]";

/// One row for every leg and one for all tours, under the verdict on the whole.
pub(super) fn certificate(certificate: &PlanCertificate, checked: &CheckedCertificate) -> String {
    let all = || checked.legs.iter().chain([&checked.tour]);
    let count = |of: fn(&Verdict) -> bool| all().filter(|verdict| of(verdict)).count();
    let verdict = if checked.confirmed() {
        "confirmed"
    } else {
        "NOT CONFIRMED"
    };
    let mut rows = vec![["from", "to", BOUND, "verdict"].map(str::to_owned)];
    for (leg, verdict) in certificate.legs.iter().zip(&checked.legs) {
        rows.push(row(&leg.from, &leg.to, leg.lower_bound_s, verdict));
    }
    rows.push(row(
        "all tours",
        "",
        certificate.lower_bound_s,
        &checked.tour,
    ));
    let rows: Vec<_> = rows.into_iter().map(Vec::from).collect();
    format!(
        "{verdict}: {} of {} bounds proved a second time, {} rejected\n\n{}",
        count(|verdict| *verdict == Verdict::Confirmed),
        count(|verdict| *verdict != Verdict::NoBound),
        count(|verdict| matches!(verdict, Verdict::Rejected(_))),
        aligned(4, &rows)
    )
}

fn row(from: &str, to: &str, bound: Option<f64>, verdict: &Verdict) -> [String; 4] {
    let bound = bound.map_or_else(|| "-".to_owned(), |bound| format!("{bound:.6}"));
    let bound = format!("{bound:>width$}", width = BOUND.len());
    let name = name(verdict).replace('_', " ");
    let told = reason(verdict).map_or_else(|| name.clone(), |reason| format!("{name}: {reason}"));
    [from.to_owned(), to.to_owned(), bound, told]
}
