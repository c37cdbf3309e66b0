//! A plan's trajectory as a table: one row per sampled state.

use slewplan_solver::plan::{Control, Plan};
use std::fmt::Write;

const HEAD: &str = "time_s,q_x,q_y,q_z,q_w,body_rate_x_rad_s,body_rate_y_rad_s,body_rate_z_rad_s";

/// The table with a head line that names the units.
///
/// The torque of a row is the one in force from that moment on; the last row repeats the torque
/// of the last interval. Wheels are counted from 0, as in JSON pointers.
///
/// # Errors
///
/// When a number is not finite.
pub(crate) fn table(plan: &Plan) -> Result<String, std::fmt::Error> {
    let wheels = plan
        .states
        .first()
        .map_or(0, |state| state.wheel_speed_rad_s.len());
    let mut text = HEAD.to_owned();
    for wheel in 0..wheels {
        write!(text, ",wheel_{wheel}_speed_rad_s")?;
    }
    for wheel in 0..wheels {
        write!(text, ",wheel_{wheel}_torque_nm")?;
    }
    text.push('\n');
    let idle = vec![0.0; wheels];
    for state in &plan.states {
        let torque = torque_at(&plan.flight.controls, state.time_s).unwrap_or(&idle);
        let row = std::iter::once(state.time_s)
            .chain(state.attitude.xyzw())
            .chain(state.body_rate_rad_s.iter().copied())
            .chain(state.wheel_speed_rad_s.iter().copied())
            .chain(torque.iter().copied());
        write_row(&mut text, row)?;
    }
    Ok(text)
}

fn write_row(text: &mut String, row: impl Iterator<Item = f64>) -> std::fmt::Result {
    for (column, value) in row.enumerate() {
        if !value.is_finite() {
            return Err(std::fmt::Error);
        }
        let separator = if column == 0 { "" } else { "," };
        // The shortest text that reads back as the same number, with an exponent where it is small.
        write!(text, "{separator}{value:?}")?;
    }
    text.push('\n');
    Ok(())
}

fn torque_at(controls: &[Control], time_s: f64) -> Option<&Vec<f64>> {
    let begun = controls.partition_point(|control| control.start_s <= time_s);
    controls
        .get(begun.saturating_sub(1))
        .map(|control| &control.wheel_torque_nm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn every_row_has_the_columns_of_the_head() {
        let text = table(&sample::plan()).unwrap();
        let columns: Vec<usize> = text.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(columns, [14; 5]);
        assert!(text.starts_with("time_s,q_x,"));
        assert!(text.lines().next().unwrap().ends_with("wheel_2_torque_nm"));
    }

    #[test]
    fn a_boundary_has_the_torque_that_begins_there() {
        let plan = sample::plan();
        let controls = &plan.flight.controls;
        let first = |time| torque_at(controls, time).unwrap()[0].to_string();
        assert_eq!(
            [first(0.0), first(9.0), first(10.0), first(30.0)],
            ["0.5", "0.5", "-0.5", "0.25"]
        );
    }

    #[test]
    fn what_is_not_finite_is_not_written() {
        let mut plan = sample::plan();
        plan.states[1].wheel_speed_rad_s[2] = f64::INFINITY;
        assert!(table(&plan).is_err());
    }
}
