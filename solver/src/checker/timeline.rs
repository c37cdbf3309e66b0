//! The controls of a flight as a gapless sequence of intervals.

use super::TIME_TOLERANCE;
use super::integrator::TorqueSpan;
use super::number_format::figure;
use crate::model::plan::{Control, Flight};
use crate::model::spacecraft::Wheel;

/// Greatest number of sentences about controls; further defects are only counted.
const MAX_SENTENCES: usize = 10;

/// The control intervals from 0 to the total time.
///
/// An interval lasts from one `start_s` to the next; a difference from `duration_s` within the tolerance
/// is rounding of written numbers.
///
/// # Errors
///
/// Sentences about every defect of the controls with which the flight cannot be propagated.
pub(super) fn intervals<'a>(
    flight: &'a Flight,
    wheels: &[Wheel],
) -> Result<Vec<TorqueSpan<'a>>, Vec<String>> {
    let total = flight.total_time_s;
    if !total.is_finite() || total < 0.0 {
        return Err(vec![format!(
            "the total time of {total} s is not a duration"
        )]);
    }
    let mut defects: Vec<String> = flight
        .controls
        .iter()
        .enumerate()
        .filter_map(|(index, control)| numbers(index, control, wheels))
        .collect();
    if defects.is_empty() {
        defects = gaps(flight);
    }
    if defects.len() > MAX_SENTENCES {
        let more = defects.len() - MAX_SENTENCES;
        defects.truncate(MAX_SENTENCES);
        defects.push(format!("{more} more defects of the controls"));
    }
    if defects.is_empty() {
        Ok(tiles(flight))
    } else {
        Err(defects)
    }
}

/// A sentence about the first defect in the numbers of one control.
fn numbers(index: usize, control: &Control, wheels: &[Wheel]) -> Option<String> {
    let torque = &control.wheel_torque_nm;
    if !control.start_s.is_finite() || !control.duration_s.is_finite() {
        return Some(format!("control {index} has a time that is not finite"));
    }
    if control.duration_s < 0.0 {
        let duration = figure(control.duration_s);
        return Some(format!(
            "control {index} has a negative duration of {duration} s"
        ));
    }
    if torque.len() != wheels.len() {
        return Some(format!(
            "control {index} has {} torques for {} wheels",
            torque.len(),
            wheels.len()
        ));
    }
    if let Some(wheel) = torque.iter().position(|u| !u.is_finite()) {
        return Some(format!(
            "control {index} has a torque on wheel {wheel} that is not finite"
        ));
    }
    let locked = |(u, wheel): (&f64, &Wheel)| !wheel.enabled && *u != 0.0;
    let wheel = torque.iter().zip(wheels).position(locked)?;
    Some(format!(
        "control {index} drives wheel {wheel}, which is disabled, with {} N m",
        figure(torque[wheel])
    ))
}

/// Sentences about gaps and overlaps of the controls.
fn gaps(flight: &Flight) -> Vec<String> {
    let total = flight.total_time_s;
    let slack = TIME_TOLERANCE * total;
    let mut defects = Vec::new();
    let mut reached = 0.0;
    for (index, control) in flight.controls.iter().enumerate() {
        if (control.start_s - reached).abs() > slack {
            let kind = if control.start_s > reached {
                "a gap"
            } else {
                "an overlap"
            };
            defects.push(format!(
                "control {index} starts at {} s where {} s was reached: {kind} of {} s",
                figure(control.start_s),
                figure(reached),
                figure((control.start_s - reached).abs())
            ));
        }
        reached = control.start_s + control.duration_s;
    }
    if (reached - total).abs() > slack {
        defects.push(format!(
            "the controls end at {} s but the flight lasts {} s",
            figure(reached),
            figure(total)
        ));
    }
    defects
}

fn tiles(flight: &Flight) -> Vec<TorqueSpan<'_>> {
    let total = flight.total_time_s;
    let starts = flight.controls.iter().map(|control| control.start_s);
    let mut begin_s = 0.0;
    starts
        .skip(1)
        .chain([total])
        .zip(&flight.controls)
        .map(|(next, control)| {
            // By rounding an interval of length zero may end before it begins.
            let end_s = next.clamp(begin_s, total);
            let interval = TorqueSpan {
                begin_s,
                end_s,
                torque: &control.wheel_torque_nm,
                slope: &[],
            };
            begin_s = end_s;
            interval
        })
        .collect()
}
