//! The part of an answer to slews that is drawn, read from its JSON.

use super::written::{Record, WrittenIntrusion, WrittenState, spans};
use serde::Deserialize;

/// The part of the answer that is read.
#[derive(Debug, Deserialize)]
pub(crate) struct WrittenSlews {
    pub(super) name: Option<String>,
    /// The values of the sweep; none for a single slew.
    pub(super) sweep: Option<Swept>,
    pub(super) slews: Vec<WrittenSlew>,
}

/// The swept quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Swept {
    Weights,
    DurationsS,
    EnergiesJ,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenSlew {
    pub(super) swept: Option<f64>,
    pub(super) solved: bool,
    pub(super) time_s: f64,
    pub(super) effort_nm2_s: f64,
    pub(super) energy_proxy_j: Option<f64>,
    pub(super) energy_bill_j: Option<f64>,
    trajectory: SlewTrajectoryJson,
    /// Answers of former versions may lack it.
    #[serde(default)]
    flight: SlewFlightJson,
}

#[derive(Debug, Default, Deserialize)]
struct SlewFlightJson {
    #[serde(default)]
    keep_out_intrusions: Vec<WrittenIntrusion>,
}

#[derive(Debug, Deserialize)]
struct SlewTrajectoryJson {
    controls: Vec<WrittenRamp>,
    states: Vec<WrittenState>,
}

#[derive(Debug, Deserialize)]
struct WrittenRamp {
    start_s: f64,
    duration_s: f64,
    wheel_torque_begin_nm: Vec<f64>,
    wheel_torque_end_nm: Vec<f64>,
}

impl WrittenSlew {
    /// The quantities drawn over time.
    ///
    /// # Errors
    ///
    /// A message, when there is nothing to draw or lists differ in length.
    pub(super) fn record(&self) -> Result<Record<'_>, String> {
        let SlewTrajectoryJson { controls, states } = &self.trajectory;
        if states.len() < 2 || self.time_s <= 0.0 {
            return Err("the slew has no trajectory".to_owned());
        }
        let wheels = states.first().map_or(0, |s| s.wheel_speed_rad_s.len());
        let lists = states.iter().map(|s| &s.wheel_speed_rad_s);
        let begins = controls.iter().map(|c| &c.wheel_torque_begin_nm);
        let ends = controls.iter().map(|c| &c.wheel_torque_end_nm);
        if !lists.chain(begins).chain(ends).all(|l| l.len() == wheels) {
            return Err("the lists of wheel speeds and torques differ in length".to_owned());
        }
        let torque = |wheel: usize| {
            controls.iter().flat_map(move |control| {
                let end = control.start_s + control.duration_s;
                [
                    (control.start_s, control.wheel_torque_begin_nm[wheel]),
                    (end, control.wheel_torque_end_nm[wheel]),
                ]
            })
        };
        Ok(Record {
            total_time_s: self.time_s,
            states,
            torques: (0..wheels).map(|i| torque(i).collect()).collect(),
            passages: &[],
        })
    }

    /// Times, s, from which and to which a boresight is on the wrong side of a cone.
    pub(super) fn intrusions(&self) -> Vec<(f64, f64)> {
        spans(&self.flight.keep_out_intrusions)
    }
}
