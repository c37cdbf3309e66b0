//! The summary of a plan.

use super::blocks::{count, line, margins, verification};
use super::table::aligned;
use crate::documents::plan::status;
use slewplan_solver::model::plan::{Leg, LowerBoundKind, Plan};

/// Title, legs, totals, bound, verification, comparison and work.
pub(super) fn plan(title: &str, plan: &Plan) -> String {
    let targets = plan.flight.passages.len();
    let mut text = format!(
        "{title}: {}, {:.3} s for {}\n\n",
        status(plan.optimality),
        plan.total_time_s,
        count(targets, "target")
    );
    text += &legs(&plan.legs);
    text.push('\n');
    text += &line("order", order(plan));
    text += &line("total", format_args!("{:.3} s", plan.total_time_s));
    text += &bound(plan);
    text += &alternatives(plan);
    text += &rest_to_rest(plan);
    text += &eigenaxis(plan);
    text += &verification(&plan.verification);
    text += &margins(&plan.margins);
    text += &work(plan);
    text
}

fn legs(legs: &[Leg]) -> String {
    let head = [
        "leg",
        "from",
        "to",
        "start [s]",
        "arrival [s]",
        "duration [s]",
        "eigenaxis [s]",
        "saved",
    ];
    let row = |(index, leg): (usize, &Leg)| {
        let other = leg.eigenaxis_duration_s;
        vec![
            (index + 1).to_string(),
            leg.from.clone(),
            leg.to.clone(),
            format!("{:.3}", leg.start_s),
            format!("{:.3}", leg.start_s + leg.duration_s),
            format!("{:.3}", leg.duration_s),
            other.map_or_else(|| "-".into(), |time| format!("{time:.3}")),
            other.map_or_else(|| "-".into(), |time| saved(leg.duration_s, time)),
        ]
    };
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(legs.iter().enumerate().map(row));
    aligned(3, &rows)
}

fn saved(time: f64, other: f64) -> String {
    if other > 0.0 {
        format!("{:.1} %", (1.0 - time / other) * 100.0)
    } else {
        "-".into()
    }
}

fn order(plan: &Plan) -> String {
    let mut names: Vec<&str> = plan
        .legs
        .first()
        .map(|leg| leg.from.as_str())
        .into_iter()
        .collect();
    names.extend(plan.legs.iter().map(|leg| leg.to.as_str()));
    names.join(" > ")
}

fn bound(plan: &Plan) -> String {
    let proved = plan
        .certified_lower_bound_s
        .map_or_else(String::new, |bound| {
            let gap = (plan.total_time_s - bound).max(0.0) / plan.total_time_s;
            let gap = if gap.is_finite() { gap } else { 0.0 };
            line(
                "proved bound",
                format_args!("{bound:.3} s, gap {:.4} %", gap * 100.0),
            )
        });
    let meaning = match plan.lower_bound_kind {
        LowerBoundKind::NlpRelaxation => "if every relaxed problem was solved globally",
        LowerBoundKind::PairTable => "sum of leg times with free ends, if each was solved globally",
        LowerBoundKind::Certified => "proved",
    };
    line(
        "lower bound",
        format_args!(
            "{:.3} s, gap {:.4} % ({}: {meaning})",
            plan.lower_bound_s,
            plan.relative_gap * 100.0,
            plan.lower_bound_kind
        ),
    ) + &proved
}

fn alternatives(plan: &Plan) -> String {
    let mut text = String::new();
    for (index, other) in plan.alternatives.iter().enumerate() {
        let label = if index == 0 { "next best" } else { "" };
        text += &line(
            label,
            format_args!(
                "{:.3} s  {}",
                other.total_time_s,
                other.sequence.join(" > ")
            ),
        );
    }
    text
}

/// The same order with legs that are minimum-time from rest to rest.
fn rest_to_rest(plan: &Plan) -> String {
    let slews: Option<f64> = plan
        .legs
        .iter()
        .map(|leg| leg.rest_to_rest_duration_s)
        .sum();
    slews.map_or_else(String::new, |slews| {
        same_order(plan, "rest to rest", "fastest rest-to-rest slews", slews)
    })
}

/// The same order with rest-to-rest turns about the eigenaxis.
fn eigenaxis(plan: &Plan) -> String {
    let turns: Option<f64> = plan.legs.iter().map(|leg| leg.eigenaxis_duration_s).sum();
    let Some(turns) = turns else {
        return line("eigenaxis", "not every leg has a slew about its eigenaxis");
    };
    same_order(plan, "eigenaxis", "rest-to-rest eigenaxis slews", turns)
}

/// The time that the plan saves against its order with other slews of a given total time, s.
fn same_order(plan: &Plan, label: &str, slews: &str, duration_s: f64) -> String {
    let waiting: f64 = plan
        .flight
        .passages
        .iter()
        .map(|p| p.departure_s - p.time_s)
        .sum();
    let tour = duration_s + waiting;
    line(
        label,
        format_args!(
            "{tour:.3} s for the same order with {slews}: saved {:.3} s ({})",
            tour - plan.total_time_s,
            saved(plan.total_time_s, tour)
        ),
    )
}

fn work(plan: &Plan) -> String {
    let work = &plan.statistics;
    line(
        "work",
        format_args!(
            "{:.2} s on {}: {} nodes, {} NLPs, {} legs solved and {} from the cache",
            work.wall_time_s,
            count(work.threads, "thread"),
            work.nodes_explored,
            work.nlp_solves,
            work.legs_solved,
            work.legs_from_cache
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::report::sample;

    #[test]
    fn the_summary_has_order_total_bound_and_saving() {
        let text = plan("two targets", &sample::plan());
        for part in [
            "two targets: optimal, 30.000 s for 2 targets",
            "start > a > b > end",
            "30.000 s, gap 0.0000 % (nlp_relaxation",
            "29.500 s, gap 1.6667 %",
            "41.000 s for the same order with rest-to-rest eigenaxis slews: saved 11.000 s (26.8 %)",
            "38.000 s for the same order with fastest rest-to-rest slews: saved 8.000 s (21.1 %)",
            "verification  passed",
            "31.000 s  b > a",
        ] {
            assert!(text.contains(part), "{part:?} is not in\n{text}");
        }
    }

    #[test]
    fn without_an_eigenaxis_slew_no_saving_is_stated() {
        let mut plan = sample::plan();
        plan.legs[1].eigenaxis_duration_s = None;
        assert!(super::plan("x", &plan).contains("not every leg"));
    }
}
