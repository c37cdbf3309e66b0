//! A plan's trajectory as a table: one row per sampled state.

use serde::Deserialize;
use slewplan_solver::plan::Plan;
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
    let states = plan.states.iter().map(|state| Row {
        time_s: state.time_s,
        xyzw: state.attitude.xyzw(),
        body_rate: state.body_rate_rad_s.into(),
        wheel_speed: &state.wheel_speed_rad_s,
    });
    let torques = plan.flight.controls.iter();
    write_table(
        &states.collect::<Vec<_>>(),
        &torques
            .map(|control| (control.start_s, &*control.wheel_torque_nm))
            .collect::<Vec<_>>(),
    )
}

/// The table of a plan that was written as JSON, digit for digit; `None` when it has no
/// trajectory.
///
/// # Errors
///
/// When the document is no plan of this program.
pub(crate) fn table_of_document(document: &[u8]) -> Result<Option<String>, serde_json::Error> {
    let WrittenPlan {
        trajectory: WrittenTrajectory { states, controls },
    } = serde_json::from_slice(document)?;
    if states.is_empty() {
        return Ok(None);
    }
    let rows = states.iter().map(|state| Row {
        time_s: state.time_s,
        xyzw: [
            state.quaternion.x,
            state.quaternion.y,
            state.quaternion.z,
            state.quaternion.w,
        ],
        body_rate: state.body_rate_rad_s,
        wheel_speed: &state.wheel_speed_rad_s,
    });
    let torques = controls
        .iter()
        .map(|control| (control.start_s, &*control.wheel_torque_nm));
    write_table(&rows.collect::<Vec<_>>(), &torques.collect::<Vec<_>>())
        .map(Some)
        .map_err(serde::de::Error::custom)
}

#[derive(Deserialize)]
struct WrittenPlan {
    trajectory: WrittenTrajectory,
}

#[derive(Deserialize)]
struct WrittenTrajectory {
    states: Vec<WrittenState>,
    controls: Vec<WrittenControl>,
}

#[derive(Deserialize)]
struct WrittenState {
    time_s: f64,
    quaternion: WrittenQuaternion,
    body_rate_rad_s: [f64; 3],
    wheel_speed_rad_s: Vec<f64>,
}

#[derive(Deserialize)]
struct WrittenQuaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Deserialize)]
struct WrittenControl {
    start_s: f64,
    wheel_torque_nm: Vec<f64>,
}

struct Row<'a> {
    time_s: f64,
    xyzw: [f64; 4],
    body_rate: [f64; 3],
    wheel_speed: &'a [f64],
}

fn write_table(states: &[Row<'_>], torques: &[(f64, &[f64])]) -> Result<String, std::fmt::Error> {
    let wheels = states.first().map_or(0, |state| state.wheel_speed.len());
    let mut text = HEAD.to_owned();
    for wheel in 0..wheels {
        write!(text, ",wheel_{wheel}_speed_rad_s")?;
    }
    for wheel in 0..wheels {
        write!(text, ",wheel_{wheel}_torque_nm")?;
    }
    text.push('\n');
    let idle = vec![0.0; wheels];
    for state in states {
        let torque = torque_at(torques, state.time_s).unwrap_or(&idle);
        let row = std::iter::once(state.time_s)
            .chain(state.xyzw)
            .chain(state.body_rate)
            .chain(state.wheel_speed.iter().copied())
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

fn torque_at<'a>(torques: &[(f64, &'a [f64])], time_s: f64) -> Option<&'a [f64]> {
    let begun = torques.partition_point(|(start_s, _)| *start_s <= time_s);
    torques
        .get(begun.saturating_sub(1))
        .map(|(_, torque)| *torque)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;
    use slewplan_solver::plan::Outcome;

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
        let controls = plan.flight.controls.iter();
        let torques: Vec<_> = controls.map(|c| (c.start_s, &*c.wheel_torque_nm)).collect();
        let first = |time| torque_at(&torques, time).unwrap()[0].to_string();
        assert_eq!(
            [first(0.0), first(9.0), first(10.0), first(30.0)],
            ["0.5", "0.5", "-0.5", "0.25"]
        );
    }

    #[test]
    fn a_written_plan_has_the_same_table() {
        let outcome = Outcome::Planned(Box::new(sample::plan()));
        let written = serde_json::to_vec(&crate::wire::plan::document(&outcome, &[])).unwrap();
        let expected = table(&sample::plan()).unwrap();
        assert_eq!(table_of_document(&written).unwrap(), Some(expected));
    }

    #[test]
    fn what_is_not_finite_is_not_written() {
        let mut plan = sample::plan();
        plan.states[1].wheel_speed_rad_s[2] = f64::INFINITY;
        assert!(table(&plan).is_err());
    }
}
