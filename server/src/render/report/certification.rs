//! The check of a plan's proved bounds, as text.

use super::table::aligned;
use crate::documents::certification::{name, reason};
use slewplan_solver::tour::planner::{
    CheckedCertificate, PlanCertificate, StrongestBound, Verdict,
};

/// Headers of the numbers, which are aligned to the right below them.
const BOUND: &str = "stated bound [s]";
const STRONGEST: &str = "strongest [s]";

/// One row for every leg and one for all tours, under the verdict on the whole.
pub(super) fn certificate(certificate: &PlanCertificate, checked: &CheckedCertificate) -> String {
    let all = || checked.legs.iter().chain([&checked.tour]);
    let count = |of: fn(&Verdict) -> bool| all().filter(|verdict| of(verdict)).count();
    let strongest = &checked.strongest;
    let confirmed = strongest.legs.iter().chain([&strongest.tour]).flatten();
    let verdict = if checked.confirmed() {
        "confirmed"
    } else {
        "NOT CONFIRMED"
    };
    let mut rows = vec![["from", "to", BOUND, STRONGEST, "verdict"].map(str::to_owned)];
    let legs = certificate.legs.iter().zip(&checked.legs);
    for ((leg, verdict), strongest) in legs.zip(&checked.strongest.legs) {
        rows.push(row(
            [&leg.from, &leg.to],
            leg.lower_bound_s,
            *strongest,
            verdict,
        ));
    }
    rows.push(row(
        ["all tours", ""],
        certificate.lower_bound_s,
        checked.strongest.tour,
        &checked.tour,
    ));
    let rows: Vec<_> = rows.into_iter().map(Vec::from).collect();
    format!(
        "{verdict}: {} of {} bounds proved a second time, {} rejected; of the strongest, {}\n\n{}",
        count(|verdict| *verdict == Verdict::Confirmed),
        count(|verdict| *verdict != Verdict::NoBound),
        count(|verdict| matches!(verdict, Verdict::Rejected(_))),
        confirmed.filter(|strongest| strongest.is_confirmed).count(),
        aligned(5, &rows)
    )
}

fn row(
    [from, to]: [&str; 2],
    stated: Option<f64>,
    strongest: Option<StrongestBound>,
    verdict: &Verdict,
) -> [String; 5] {
    let told = |bound: Option<f64>, header: &str| {
        let bound = bound.map_or_else(|| "-".to_owned(), |bound| format!("{bound:.6}"));
        format!("{bound:>width$}", width = header.len())
    };
    let strongest = strongest.map(|strongest| strongest.bound_s);
    let [stated, strongest] = [told(stated, BOUND), told(strongest, STRONGEST)];
    let name = name(verdict).replace('_', " ");
    let verdict =
        reason(verdict).map_or_else(|| name.clone(), |reason| format!("{name}: {reason}"));
    [from.to_owned(), to.to_owned(), stated, strongest, verdict]
}
