//! Studies of wheels and of one flight, as text.

use super::blocks::{clearances, keep_out_banner, line, reasons, warnings};
use super::numbers::{percent, significant};
use super::table::aligned;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::wheels::array::EnvelopedArray;
use slewplan_studies::comparison::{ComparisonStudy, SizeComparison};
use slewplan_studies::envelope_study::{EnvelopeReport, TurnReport};
use slewplan_studies::flight::{FlightStudy, FlightStudyOutcome, SimulatedPlan};

/// A table under a title.
pub(super) fn titled(
    title: &str,
    left: usize,
    head: &[&str],
    rows: impl Iterator<Item = Vec<String>>,
) -> String {
    let mut all = vec![head.iter().map(|&name| name.to_owned()).collect()];
    all.extend(rows);
    format!("{title}\n\n{}", aligned(left, &all))
}

/// One flight in closed loop.
pub(crate) fn flight(study: &FlightStudy, outcome: &FlightStudyOutcome) -> String {
    let title = study.scenario.name().unwrap_or("unnamed scenario");
    let text = match outcome {
        FlightStudyOutcome::Simulated(simulated) => flown(title, simulated),
        FlightStudyOutcome::NoPlan(problems) => {
            format!("{title}: no plan\n") + &reasons(problems, Some(&study.scenario))
        }
        FlightStudyOutcome::Stopped => format!("{title}: stopped before it was flown\n"),
    };
    keep_out_banner(&study.warnings) + &text + &warnings(&study.warnings, Some(&study.scenario))
}

fn flown(title: &str, plan: &SimulatedPlan) -> String {
    let found = &plan.simulated;
    let within = found.end.attitude_rad <= plan.tolerance_rad;
    let verdict = if within { "within" } else { "NOT WITHIN" };
    let head = ["target", "arrival [s]", "error [deg]", "rate error [deg/s]"];
    let rows = found.passages.iter().map(|passage| {
        vec![
            passage.target.clone(),
            format!("{:.3}", passage.time_s),
            significant(passage.error.attitude_rad.to_degrees()),
            significant(passage.error.rate_rad_s.to_degrees()),
        ]
    });
    let title = format!(
        "{title}: {verdict} {} deg at the end of {:.3} s",
        significant(plan.tolerance_rad.to_degrees()),
        plan.flight_time_s
    );
    let error = |label: &str, error: f64, rate: f64| {
        line(
            label,
            format_args!(
                "{} deg, {} deg/s",
                significant(error.to_degrees()),
                significant(rate.to_degrees())
            ),
        )
    };
    let saturated = found.saturation.iter().enumerate().map(|(wheel, shares)| {
        let at = [percent(shares.torque, 1), percent(shares.speed, 1)];
        line(
            if wheel == 0 { "at limits" } else { "" },
            format_args!(
                "wheel {wheel}: torque {}, speed {} of the time",
                at[0], at[1]
            ),
        )
    });
    let mut text = titled(&title, 1, &head, rows);
    text.push('\n');
    text += &error("end", found.end.attitude_rad, found.end.rate_rad_s);
    text += &error(
        "plan's end",
        found.plan_end.attitude_rad,
        found.plan_end.rate_rad_s,
    );
    text += &error("largest", found.peak.attitude_rad, found.peak.rate_rad_s);
    text.extend(saturated);
    text + &clearances(&found.cones)
}

/// Envelopes, turns and demands.
pub(crate) fn envelopes(report: &EnvelopeReport, doubts: &[Problem]) -> String {
    let title = if report.complete {
        "What the wheels can do together"
    } else {
        "What the wheels can do together; stopped before all slews were solved"
    };
    let head = [
        "quantity",
        "in every direction",
        "mean",
        "greatest",
        "by the pseudo-inverse",
    ];
    let arrays = [
        ("torque [N m]", Some(&report.envelopes.torque)),
        ("momentum [N m s]", report.envelopes.momentum.as_ref()),
    ];
    let rows = arrays.into_iter().map(|(name, array)| match array {
        Some(array) => extent(name, array),
        None => vec![name.to_owned(), "no limit".to_owned()],
    });
    let mut text = titled(title, 1, &head, rows);
    if !report.turns.is_empty() {
        text += "\n";
        text += &turns(&report.turns);
    }
    if !report.demands.is_empty() {
        let head = ["demand [N m]", "load, pseudo-inverse", "least load"];
        let rows = report.demands.iter().map(|demand| {
            let least = demand.least_load.as_ref();
            vec![
                demand
                    .torque
                    .iter()
                    .map(|part| significant(*part))
                    .collect::<Vec<_>>()
                    .join(", "),
                percent(demand.pseudo_inverse.load, 1),
                least.map_or_else(|| "-".to_owned(), |least| percent(least.load, 1)),
            ]
        });
        text += "\n";
        text += &titled(
            "Torques shared out; above 100 % the wheels cannot",
            1,
            &head,
            rows,
        );
    }
    text + &warnings(doubts, None)
}

fn extent(name: &str, array: &EnvelopedArray) -> Vec<String> {
    let full = array.envelopes.full.size();
    let inverse = array.envelopes.pseudo_inverse.size();
    vec![
        name.to_owned(),
        significant(full.inscribed_radius),
        significant(full.mean_radius),
        significant(full.greatest_radius),
        significant(inverse.inscribed_radius),
    ]
}

fn turns(turns: &[TurnReport]) -> String {
    let head = ["slew", "turn [deg]", "duration [s]"];
    let mut rows = Vec::new();
    for turn in turns {
        let angle = significant(turn.vector.norm().to_degrees());
        for (baseline, _) in &turn.eigenaxis {
            let name = format!(
                "eigenaxis, {}",
                <&str>::from(baseline.limit).replace('_', " ")
            );
            let time = format!("{:.3}", baseline.course.duration());
            rows.push(vec![name, angle.clone(), time]);
        }
        for slew in &turn.time_optimal {
            let found = slew.found.as_ref();
            let time = found.map_or_else(|| slew.status.clone(), |(time, _)| format!("{time:.3}"));
            let name = format!(
                "minimum time, {}",
                <&str>::from(slew.allocation).replace('_', " ")
            );
            rows.push(vec![name, angle.clone(), time]);
        }
    }
    titled("Turns from rest to rest", 1, &head, rows.into_iter())
}

/// Wheels against gyroscopes.
pub(crate) fn comparison(study: &ComparisonStudy) -> String {
    let head = [
        "control",
        "size [N m s]",
        "rate [deg/s]",
        "acceleration [deg/s\u{b2}]",
        "faster from [deg]",
    ];
    let rows = study.comparison.sizes.iter().flat_map(size);
    titled(
        "Wheels and control moment gyroscopes, by the momentum of a device",
        1,
        &head,
        rows,
    )
}

fn size(size: &SizeComparison) -> impl Iterator<Item = Vec<String>> {
    size.agilities.iter().map(|agility| {
        let advantage = size
            .advantages
            .iter()
            .find(|one| one.control == agility.control);
        let from = advantage.map(|one| match one.angle_rad {
            Some(angle) => significant(angle.to_degrees()),
            None => "never".to_owned(),
        });
        vec![
            agility.control.to_string(),
            significant(size.momentum_nms),
            significant(agility.rate_rad_s.to_degrees()),
            significant(agility.acceleration_rad_s2.to_degrees()),
            from.unwrap_or_else(|| "-".to_owned()),
        ]
    })
}
