//! Wheel speed commands for controllers that hold a speed until the next command.
//!
//! Per line the number of the command, from 0, and the speed of every wheel, or of one, in
//! revolutions per minute relative to the body, separated by tabs and without a header, as test
//! benches read. Command `k` is due at `k` periods; the last one is at or after the end.

use super::{ExportError, ExportOptions, PERIOD_S, Spacing};
use slewplan_solver::checker::PropagatedMotion;
use slewplan_solver::model::scenario::Scenario;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Revolutions per minute of a speed, rad/s.
fn rpm(speed_rad_s: f64) -> f64 {
    speed_rad_s * 60.0 / TAU
}

/// The commands until the end of the flight.
pub(super) fn commands(
    motion: &PropagatedMotion,
    total_time_s: f64,
    options: &ExportOptions,
) -> Result<String, ExportError> {
    let period = match options.spacing {
        Some(Spacing::Step(step)) => step,
        _ => PERIOD_S,
    };
    if total_time_s / period >= options.most_samples as f64 {
        let most = options.most_samples;
        let what = format!("more than {most} commands would be needed; choose a longer step");
        return Err(ExportError::Choice(what));
    }
    let mut text = String::new();
    let (mut number, mut time) = (0_u32, 0.0);
    loop {
        let state = motion.state(time).ok_or(ExportError::NotFinite)?;
        let speeds = state.wheel_speed_rad_s.iter().enumerate();
        let chosen = speeds.filter(|(wheel, _)| options.wheel.is_none_or(|one| one == *wheel));
        // Writing to a String cannot fail.
        let _ = write!(text, "{number}");
        for (_, speed) in chosen {
            if !speed.is_finite() {
                return Err(ExportError::NotFinite);
            }
            let _ = write!(text, "\t{:.6}", rpm(*speed));
        }
        text.push('\n');
        if time >= total_time_s {
            return Ok(text);
        }
        number += 1;
        time = f64::from(number) * period;
    }
}

/// Tests that the selected wheel exists.
pub(super) fn check_wheel(scenario: &Scenario, wheel: Option<usize>) -> Result<(), ExportError> {
    let count = scenario.spacecraft().wheels().len();
    match wheel {
        Some(index) if index >= count => Err(ExportError::Choice(format!(
            "there is no wheel {index}: the spacecraft has {count}, counted from 0"
        ))),
        _ => Ok(()),
    }
}
