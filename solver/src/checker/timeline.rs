//! The controls of a flight as a gapless sequence of intervals.

use super::TIME_TOLERANCE;
use super::integrator::Interval;
use super::number_format::figure;
use crate::model::plan::{Control, Flight};
use crate::model::spacecraft::Wheel;

/// Sentences of one kind that are worth reading; a wrong file tends to be wrong everywhere.
const MAX_SENTENCES: usize = 10;

/// The control intervals from 0 to the total time.
///
/// What is flown is from one `start_s` to the next: differences to `duration_s` below the
/// tolerance are the rounding of text.
///
/// # Errors
///
/// Sentences about everything that keeps the flight from being flown at all.
pub(super) fn intervals<'a>(
    flight: &'a Flight,
    wheels: &[Wheel],
) -> Result<Vec<Interval<'a>>, Vec<String>> {
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

/// What is wrong with the numbers of one interval.
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

/// Where the intervals do not tile the flight.
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

fn tiles(flight: &Flight) -> Vec<Interval<'_>> {
    let total = flight.total_time_s;
    let starts = flight.controls.iter().map(|control| control.start_s);
    let mut begin_s = 0.0;
    starts
        .skip(1)
        .chain([total])
        .zip(&flight.controls)
        .map(|(next, control)| {
            // Rounding may order the ends of an interval of no length the other way round.
            let end_s = next.clamp(begin_s, total);
            let interval = Interval {
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
