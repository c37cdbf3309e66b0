//! Slews, as text.

use super::blocks::{clearances, count, keep_out_banner, line, reasons, warnings};
use super::numbers::{significant, small};
use super::table::aligned;
use crate::documents::slew::SlewRequest;
use slewplan_solver::slew::evidence::Evidence;
use slewplan_solver::slew::{Objective, SlewOutcome, Sweep};

/// A slew with what its objective is measured in, or a row for each value of a sweep.
pub(crate) fn answer(
    request: &SlewRequest,
    outcomes: &[(SlewOutcome, Option<Evidence>)],
    complete: bool,
) -> String {
    let title = request.name.as_deref().unwrap_or("unnamed slew");
    let solved = outcomes
        .iter()
        .filter(|(outcome, _)| outcome.solved)
        .count();
    let state = match (outcomes, &request.sweep) {
        ([(only, _)], None) if only.solved => format!("solved, {:.3} s", only.time_s),
        ([(only, _)], None) => format!("NOT SOLVED: {}", only.status),
        _ => format!("{solved} of {} solved", count(outcomes.len(), "slew")),
    };
    let stopped = if complete { "" } else { ", stopped early" };
    let mut text = format!("{title}: {state}{stopped}\n\n");
    let mut violated = request.warnings.clone();
    let flown = outcomes.iter().map(|(outcome, _)| &outcome.propagated);
    violated.extend(flown.flat_map(|flown| flown.warnings.iter().cloned()));
    text += &keep_out_banner(&violated);
    match (outcomes, &request.sweep) {
        ([(only, evidence)], None) => text += &single(request, only, evidence.as_ref()),
        (_, sweep) => text += &rows(request, outcomes, sweep.as_ref()),
    }
    text + &warnings(&request.warnings, None)
}

/// The lines of one slew.
fn single(request: &SlewRequest, slew: &SlewOutcome, evidence: Option<&Evidence>) -> String {
    let mut text = line("duration", format_args!("{:.3} s", slew.time_s));
    if let Some(unit) = objective_unit(request) {
        text += &line(
            "objective",
            format_args!("{} {unit}", significant(slew.objective)),
        );
    }
    if let Some(time) = slew.continuous_time_s {
        text += &line(
            "continuous",
            format_args!("{time:.3} s, the minimum without samples"),
        );
    }
    text += &line(
        "effort",
        format_args!("{} N\u{b2}m\u{b2}s", significant(slew.effort)),
    );
    let rolls = [slew.propagated.start_roll_rad, slew.propagated.end_roll_rad];
    for (roll, end) in rolls.into_iter().zip(["at the start", "at the end"]) {
        if let Some(roll) = roll {
            text += &line("roll", format_args!("{:.3} deg {end}", roll.to_degrees()));
        }
    }
    if has_motors(request) {
        let energies = &slew.propagated.energies;
        text += &line(
            "energy",
            format_args!(
                "{} J from the supply, {} J if braking fed back",
                significant(energies.bill_j),
                significant(energies.proxy_j)
            ),
        );
    }
    text += &flown(slew);
    text += &reasons(&slew.reasons, None);
    if let Some(evidence) = evidence {
        text += &line(
            "evidence",
            format_args!(
                "Hamiltonian within {} of its scale, {} lower by other torques",
                small(evidence.pointwise_spread),
                small(evidence.principle_gap)
            ),
        );
    }
    text + &line(
        "work",
        format_args!(
            "{} from {}",
            count(slew.iterations, "iteration"),
            count(slew.starts, "start")
        ),
    )
}

/// What the independent integration found.
fn flown(slew: &SlewOutcome) -> String {
    let found = &slew.propagated;
    let verdict = if found.failures.is_empty() {
        "passed"
    } else {
        "NOT PASSED"
    };
    let mut text = line(
        "verification",
        format_args!(
            "{verdict}: attitude error {} rad, rate error {} rad/s",
            small(found.attitude_error_rad),
            small(found.rate_error_rad_s)
        ),
    );
    text += &line(
        "",
        format_args!(
            "limits exceeded by (relative): torque {}, wheel speed {}, body rate {}",
            small(found.torque_excess),
            small(found.wheel_speed_excess),
            small(found.rate_excess)
        ),
    );
    text += &clearances(&found.clearances);
    for failure in &found.failures {
        text += &line("", format_args!("failed: {failure}"));
    }
    text
}

/// One row for every slew of a sweep.
fn rows(
    request: &SlewRequest,
    outcomes: &[(SlewOutcome, Option<Evidence>)],
    sweep: Option<&Sweep>,
) -> String {
    let swept = match sweep {
        Some(Sweep::Durations(_)) => "given [s]",
        Some(Sweep::Energies(_)) => "energy [J]",
        Some(Sweep::Weights(_)) => "weight",
        None => "slew",
    };
    let motors = has_motors(request);
    let mut head = vec!["status", swept, "duration [s]", "effort [N\u{b2}m\u{b2}s]"];
    if motors {
        head.push("energy bill [J]");
    }
    let mut rows = vec![head.into_iter().map(str::to_owned).collect::<Vec<_>>()];
    let values = sweep.map_or(&[][..], Sweep::values);
    for (index, (slew, _)) in outcomes.iter().enumerate() {
        let value = values.get(index).copied();
        let status = if slew.solved { "solved" } else { &slew.status };
        let mut row = vec![
            status.replace('_', " "),
            value.map_or_else(|| (index + 1).to_string(), significant),
            format!("{:.3}", slew.time_s),
            significant(slew.effort),
        ];
        if motors {
            row.push(significant(slew.propagated.energies.bill_j));
        }
        rows.push(row);
    }
    aligned(1, &rows)
}

/// The unit of the objective; none where that is the duration itself.
fn objective_unit(request: &SlewRequest) -> Option<&'static str> {
    match request.slew.objective() {
        Objective::Energy { .. } => Some("J"),
        Objective::TimeAndEffort { .. } => Some("s"),
        Objective::MinimumTime | Objective::MinimumTimeAtEnergy { .. } => None,
    }
}

fn has_motors(request: &SlewRequest) -> bool {
    let mut drives = request.slew.all_drives().iter();
    drives.any(|drive| drive.motor.is_some())
}
