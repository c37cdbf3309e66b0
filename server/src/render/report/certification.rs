//! The check of a plan's proved bounds, as text.

use super::table::aligned;
use crate::documents::certification::{name, reason};
use slewplan_solver::tour::planner::{CheckedCertificate, PlanCertificate, Verdict};

/// Headers of the numbers, which are aligned to the right below them.
const BOUND: &str = "stated bound [s]";
const STRONGEST: &str = "strongest [s]";

/// One row for every leg and one for all tours, under the verdict on the whole.
pub(super) fn certificate(certificate: &PlanCertificate, checked: &CheckedCertificate) -> String {
    let all = || checked.legs.iter().chain([&checked.tour]);
    let count = |of: fn(&Verdict) -> bool| all().filter(|verdict| of(verdict)).count();
    let verdict = if checked.confirmed() {
        "confirmed"
    } else {
        "NOT CONFIRMED"
    };
    let mut rows = vec![["from", "to", BOUND, STRONGEST, "verdict"].map(str::to_owned)];
    let legs = certificate.legs.iter().zip(&checked.legs);
    for ((leg, verdict), strongest) in legs.zip(&checked.strongest.legs) {
        let bounds = [leg.lower_bound_s, *strongest];
        rows.push(row(&leg.from, &leg.to, bounds, verdict));
    }
    rows.push(row(
        "all tours",
        "",
        [certificate.lower_bound_s, checked.strongest.tour_s],
        &checked.tour,
    ));
    let rows: Vec<_> = rows.into_iter().map(Vec::from).collect();
    format!(
        "{verdict}: {} of {} bounds proved a second time, {} rejected\n\n{}",
        count(|verdict| *verdict == Verdict::Confirmed),
        count(|verdict| *verdict != Verdict::NoBound),
        count(|verdict| matches!(verdict, Verdict::Rejected(_))),
        aligned(5, &rows)
    )
}

fn row(from: &str, to: &str, bounds: [Option<f64>; 2], verdict: &Verdict) -> [String; 5] {
    let told = |bound: Option<f64>, header: &str| {
        let bound = bound.map_or_else(|| "-".to_owned(), |bound| format!("{bound:.6}"));
        format!("{bound:>width$}", width = header.len())
    };
    let [stated, strongest] = [told(bounds[0], BOUND), told(bounds[1], STRONGEST)];
    let name = name(verdict).replace('_', " ");
    let verdict =
        reason(verdict).map_or_else(|| name.clone(), |reason| format!("{name}: {reason}"));
    [from.to_owned(), to.to_owned(), stated, strongest, verdict]
}
