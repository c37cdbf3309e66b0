//! The summary of a plan.

use super::blocks::{count, line, margins, verification};
use super::numbers::percent;
use super::schedule;
use super::table::aligned;
use crate::documents::plan::status;
use slewplan_solver::model::plan::{Leg, LowerBoundKind, Passage, Plan};
use slewplan_solver::model::scenario::Target;

/// The first line: status, duration and number of targets.
pub(super) fn title(name: &str, plan: &Plan) -> String {
    let violated = if plan.margins.violates_cones() {
        ", but keep-out violated"
    } else {
        ""
    };
    let (visited, schedule) = (plan.flight.passages.len(), plan.schedule.as_ref());
    let targets = match schedule.map_or(0, |it| it.skipped.len()) {
        0 => count(visited, "target"),
        skipped => format!("{visited} of {}", count(visited + skipped, "target")),
    };
    format!(
        "{name}: {}{violated}{}, {:.3} s for {targets}\n\n",
        status(plan.optimality),
        schedule.map_or_else(String::new, schedule::in_title),
        plan.total_time_s
    )
}

/// Legs, totals, bound, verification, comparison and work.
pub(super) fn plan(plan: &Plan, targets: &[Target]) -> String {
    let mut text = legs(plan, targets);
    text.push('\n');
    text += &line("order", order(plan));
    text += &line("total", format_args!("{:.3} s", plan.total_time_s));
    text += &bound(plan);
    text += &alternatives(plan);
    match &plan.schedule {
        Some(schedule) => text += &schedule::lines(schedule),
        // With a clock other slews would not end the same order sooner.
        None => text += &(rest_to_rest(plan) + &eigenaxis(plan)),
    }
    text += &verification(&plan.verification, &plan.margins);
    text += &margins(&plan.margins);
    text += &work(plan);
    text
}

fn legs(plan: &Plan, targets: &[Target]) -> String {
    let stays: Vec<_> = plan
        .legs
        .iter()
        .map(|leg| stay(leg, plan, targets))
        .collect();
    let rests = stays.iter().any(|stay| stay.iter().any(|time| *time > 0.0));
    let mut head = vec![
        "leg",
        "from",
        "to",
        "start [s]",
        "arrival [s]",
        "duration [s]",
    ];
    let waits: Vec<_> = plan.legs.iter().map(|leg| waited(leg, plan)).collect();
    let waiting = waits.iter().any(|time| *time > 0.0);
    if waiting {
        head.push("wait [s]");
    }
    if rests {
        head.extend(["settle [s]", "dwell [s]"]);
    }
    let rolls: Vec<_> = plan.legs.iter().map(|leg| roll(leg, plan)).collect();
    let chosen = rolls.iter().any(Option::is_some);
    if chosen {
        head.push("roll [deg]");
    }
    head.extend(["eigenaxis [s]", "saved"]);
    let mut rows = vec![head.into_iter().map(str::to_owned).collect::<Vec<_>>()];
    for (index, ((leg, stay), roll)) in plan.legs.iter().zip(stays).zip(rolls).enumerate() {
        let other = leg.eigenaxis_duration_s;
        let mut row = vec![(index + 1).to_string(), leg.from.clone(), leg.to.clone()];
        let times = [leg.start_s, leg.start_s + leg.duration_s, leg.duration_s];
        row.extend(times.map(|time| format!("{time:.3}")));
        if waiting {
            row.push(rest(waits[index]));
        }
        if rests {
            row.extend(stay.map(rest));
        }
        if chosen {
            row.push(roll.map_or_else(|| "-".into(), |roll| format!("{roll:.3}")));
        }
        row.push(other.map_or_else(|| "-".into(), |time| format!("{time:.3}")));
        row.push(other.map_or_else(|| "-".into(), |time| saved(leg.duration_s, time)));
        rows.push(row);
    }
    aligned(3, &rows)
}

/// Times to settle and to dwell at the end of a leg, s.
fn stay(leg: &Leg, plan: &Plan, targets: &[Target]) -> [f64; 2] {
    let is_here = |passage: &&Passage| passage.target == leg.to;
    let Some(passage) = plan.flight.passages.iter().find(is_here) else {
        return [0.0; 2];
    };
    let stay = passage.departure_s - passage.time_s;
    let target = targets.iter().find(|target| target.id == leg.to);
    let settle = target.map_or(0.0, |target| target.settle.min(stay));
    [settle, stay - settle]
}

/// Time of waits in the attitude at the end of a leg, s.
fn waited(leg: &Leg, plan: &Plan) -> f64 {
    let waits = plan.schedule.iter().flat_map(|it| &it.waits);
    let here = waits.filter(|wait| wait.target == leg.to);
    here.map(|wait| wait.to_s - wait.from_s).sum()
}

/// The roll at the end of a leg, degrees, where a boresight is pointed there.
fn roll(leg: &Leg, plan: &Plan) -> Option<f64> {
    let passages = &plan.flight.passages;
    match passages.iter().position(|passage| passage.target == leg.to) {
        Some(index) => plan.rolls.passages.get(index).copied().flatten(),
        None => plan.rolls.end,
    }
}

/// A time at rest; a dash where there is none.
fn rest(time: f64) -> String {
    // Departures are sums with rounding.
    if time > 1e-9 {
        format!("{time:.3}")
    } else {
        "-".to_owned()
    }
}

fn saved(time: f64, other: f64) -> String {
    if other > 0.0 {
        percent(1.0 - time / other, 1)
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
    // Of a schedule with open value no end may be known at all.
    if plan.relative_gap >= 1.0 {
        return proved;
    }
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
            "{:.2} s on {}: {}, {}, {} solved and {} from the cache",
            work.wall_time_s,
            count(work.threads, "thread"),
            count(work.nodes_explored, "node"),
            count(work.nlp_solves, "NLP"),
            count(work.legs_solved, "leg"),
            work.legs_from_cache
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::report::sample;
    use slewplan_solver::model::attitude::Attitude;
    use slewplan_solver::model::plan::{Intrusion, Rolls};
    use slewplan_solver::model::scenario::RateCondition;

    #[test]
    fn the_summary_has_order_total_bound_and_saving() {
        let sample = sample::plan();
        let text = title("two targets", &sample) + &plan(&sample, &[]);
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
    fn a_bound_that_is_not_known_is_not_stated() {
        let mut plan = sample::plan();
        assert!(super::plan(&plan, &[]).contains("lower bound"));
        (plan.lower_bound_s, plan.relative_gap) = (0.0, 1.0);
        let text = super::plan(&plan, &[]);
        assert!(text.contains("proved bound") && !text.contains("lower bound"));
    }

    #[test]
    fn without_an_eigenaxis_slew_no_saving_is_stated() {
        let mut plan = sample::plan();
        plan.legs[1].eigenaxis_duration_s = None;
        assert!(super::plan(&plan, &[]).contains("not every leg"));
    }

    #[test]
    fn settle_and_dwell_have_columns_where_there_are_any() {
        let mut plan = sample::plan();
        let mut target = Target {
            id: "b".into(),
            attitude: Attitude::identity(),
            roll: None,
            pointing: None,
            rate: [RateCondition::Fixed(0.0); 3],
            settle: 2.0,
            dwell: 3.0,
            windows: None,
            value: None,
        };
        let text = legs(&plan, std::slice::from_ref(&target));
        let cells: Vec<Vec<&str>> = text
            .lines()
            .map(|row| row.split_whitespace().collect())
            .collect();
        assert!(text.contains("settle [s]  dwell [s]"), "{text}");
        assert_eq!(cells[1][6..8], ["-", "-"], "{text}");
        assert_eq!(cells[2][6..8], ["2.000", "3.000"], "{text}");
        target.settle = 0.0;
        plan.flight.passages[1].departure_s = plan.flight.passages[1].time_s;
        assert!(!legs(&plan, &[target]).contains("dwell"));
    }

    #[test]
    fn a_schedule_has_its_value_and_what_is_left_out() {
        let mut plan = sample::plan();
        plan.schedule = Some(sample::schedule());
        let text = title("x", &plan) + &super::plan(&plan, &[]);
        for part in [
            "x: optimal, value 3, 30.000 s for 2 of 4 targets",
            "3, at most 4.5, gap 33.3333 %",
            "c: value_too_small; with it the value changes by -1.5, the time by +2.000 s",
            "d: not_tried",
            "2.000 s in 1 wait",
            "wait [s]",
        ] {
            assert!(text.contains(part), "{part:?} is not in\n{text}");
        }
        assert!(!text.contains("same order"), "{text}");
    }

    #[test]
    fn rolls_have_a_column_where_there_are_any() {
        let mut plan = sample::plan();
        let text = legs(&plan, &[]);
        assert!(
            text.contains("roll [deg]") && text.contains("-12.500"),
            "{text}"
        );
        plan.rolls.end = Some(3.0);
        let last = legs(&plan, &[]);
        let last = last.lines().last().unwrap_or_default();
        assert!(last.contains(" 3.000 "), "{last}");
        plan.rolls = Rolls::default();
        assert!(!legs(&plan, &[]).contains("roll"));
    }

    #[test]
    fn a_violated_keep_out_is_in_the_first_line_and_the_verdict() {
        let mut plan = sample::plan();
        plan.margins.keep_out_intrusions.push(Intrusion {
            boresight: "camera".into(),
            cone: "/keep_out/0".into(),
            from_s: 1.0,
            to_s: 2.0,
            depth_rad: 0.1,
        });
        assert!(title("x", &plan).starts_with("x: optimal, but keep-out violated, 30.000 s"));
        assert!(super::plan(&plan, &[]).contains("passed, but keep-out violated"));
    }

    #[test]
    fn counts_agree_with_their_nouns_and_zeros_are_plain() {
        let mut plan = sample::plan();
        plan.statistics.legs_solved = 1;
        plan.legs[0].eigenaxis_duration_s = Some(plan.legs[0].duration_s * (1.0 - 1e-9));
        let text = super::plan(&plan, &[]);
        assert!(
            text.contains("1 leg solved") && !text.contains("1 legs"),
            "{text}"
        );
        assert!(
            !text.contains("0.0e0") && !text.contains("-0.0 %"),
            "{text}"
        );
    }
}
