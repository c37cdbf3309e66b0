//! Wheel speeds as commands for controllers that hold a speed until the next one comes.
//!
//! Per line the number of the command, from 0, and the speed of every wheel, or of one, in
//! revolutions per minute relative to the body, separated by tabs and without a head: what test
//! benches read. Command `k` is due at `k` periods; the last one is at or after the end.

use super::{ExportError, Options, PERIOD_S, Spacing};
use slewplan_solver::checker::Motion;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Revolutions per minute of a speed, rad/s.
fn rpm(speed_rad_s: f64) -> f64 {
    speed_rad_s * 60.0 / TAU
}

/// The commands until the end of the flight.
pub(super) fn commands(
    motion: &Motion,
    total_time_s: f64,
    options: &Options,
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
        let speeds = chosen(&state.wheel_speed_rad_s, options.wheel)?;
        if !speeds.iter().all(|speed| speed.is_finite()) {
            return Err(ExportError::NotFinite);
        }
        // Writing into a text cannot fail.
        let _ = write!(text, "{number}");
        for speed in speeds {
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

fn chosen(speeds: &[f64], wheel: Option<usize>) -> Result<&[f64], ExportError> {
    let Some(index) = wheel else {
        return Ok(speeds);
    };
    speeds.get(index..=index).ok_or_else(|| {
        let count = speeds.len();
        ExportError::Choice(format!(
            "there is no wheel {index}: the spacecraft has {count}, counted from 0"
        ))
    })
}
