//! The part of a plan that is drawn, read from its JSON.

use serde::Deserialize;
use slewplan_solver::model::attitude::Attitude;

/// The part of a plan's document that is read.
#[derive(Debug, Deserialize)]
pub(crate) struct WrittenPlan {
    pub(super) status: String,
    pub(super) total_time_s: f64,
    pub(super) lower_bound_s: f64,
    pub(super) relative_gap: f64,
    pub(super) legs: Vec<WrittenLeg>,
    pub(super) passages: Vec<WrittenPassage>,
    pub(super) trajectory: WrittenTrajectory,
    pub(super) verification: Option<WrittenVerification>,
    /// Sum of the values of the targets that are visited, and its upper bound.
    pub(super) value: Option<f64>,
    pub(super) value_bound: Option<f64>,
    #[serde(default)]
    pub(super) skipped: Vec<WrittenSkipped>,
    #[serde(default)]
    pub(super) waits: Vec<WrittenWait>,
    margins: Option<WrittenMargins>,
}

#[derive(Debug, Deserialize)]
struct WrittenMargins {
    /// Plans of other origin may lack it.
    #[serde(default)]
    keep_out_intrusions: Vec<WrittenIntrusion>,
}

/// A target that is left out.
#[derive(Debug, Deserialize)]
pub(super) struct WrittenSkipped {
    pub(super) target: String,
    pub(super) reason: String,
}

/// A stay at rest outside a visit.
#[derive(Debug, Deserialize)]
pub(super) struct WrittenWait {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
}

/// A stay of a boresight on the wrong side of a cone.
#[derive(Debug, Deserialize)]
pub(super) struct WrittenIntrusion {
    from_s: f64,
    to_s: f64,
}

/// Times, s, from which and to which boresights are on the wrong side of cones.
pub(super) fn spans(stays: &[WrittenIntrusion]) -> Vec<(f64, f64)> {
    stays.iter().map(|stay| (stay.from_s, stay.to_s)).collect()
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenLeg {
    pub(super) from: String,
    pub(super) to: String,
    pub(super) start_s: f64,
    pub(super) duration_s: f64,
    pub(super) eigenaxis_duration_s: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenPassage {
    pub(super) target: String,
    pub(super) time_s: f64,
    pub(super) departure_s: f64,
    /// Where a boresight is pointed.
    pub(super) roll_deg: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenTrajectory {
    pub(super) controls: Vec<WrittenControl>,
    pub(super) states: Vec<WrittenState>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenControl {
    pub(super) start_s: f64,
    pub(super) duration_s: f64,
    pub(super) wheel_torque_nm: Vec<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenState {
    pub(super) time_s: f64,
    quaternion: WrittenQuaternion,
    pub(super) body_rate_rad_s: [f64; 3],
    pub(super) wheel_speed_rad_s: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct WrittenQuaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenVerification {
    pub(super) passed: bool,
}

/// The quantities drawn over time.
#[derive(Debug)]
pub(super) struct Record<'a> {
    pub(super) total_time_s: f64,
    pub(super) states: &'a [WrittenState],
    /// Times (s) and torques (N m), one list per wheel.
    pub(super) torques: Vec<Vec<(f64, f64)>>,
    pub(super) passages: &'a [WrittenPassage],
}

impl WrittenState {
    /// The attitude; the identity when the quaternion is zero.
    pub(super) fn attitude(&self) -> Attitude {
        let WrittenQuaternion { x, y, z, w } = self.quaternion;
        Attitude::from_xyzw([x, y, z, w]).unwrap_or_else(Attitude::identity)
    }
}

impl WrittenPlan {
    /// Reads the document of a plan.
    ///
    /// # Errors
    ///
    /// A message, when it is no plan, or a document of reasons why there is none.
    pub(crate) fn read(document: &[u8]) -> Result<Self, String> {
        let plan: Self = serde_json::from_slice(document)
            .map_err(|error| format!("not a plan that can be drawn: {error}"))?;
        if plan.trajectory.states.len() < 2 || plan.total_time_s <= 0.0 {
            return Err("the plan has no trajectory".to_owned());
        }
        let wheels = plan.wheels();
        let same = |list: &Vec<f64>| list.len() == wheels;
        let states = plan.trajectory.states.iter();
        let controls = plan.trajectory.controls.iter();
        if states.map(|s| &s.wheel_speed_rad_s).all(same)
            && controls.map(|c| &c.wheel_torque_nm).all(same)
        {
            Ok(plan)
        } else {
            Err("the lists of wheel speeds and torques differ in length".to_owned())
        }
    }

    /// The quantities drawn over time.
    pub(super) fn record(&self) -> Record<'_> {
        let controls = &self.trajectory.controls;
        let torque = |wheel: usize| {
            controls.iter().flat_map(move |control| {
                let value = control.wheel_torque_nm[wheel];
                let end = control.start_s + control.duration_s;
                [(control.start_s, value), (end, value)]
            })
        };
        Record {
            total_time_s: self.total_time_s,
            states: &self.trajectory.states,
            torques: (0..self.wheels()).map(|i| torque(i).collect()).collect(),
            passages: &self.passages,
        }
    }

    /// Times, s, from which and to which a boresight is on the wrong side of a cone.
    pub(super) fn intrusions(&self) -> Vec<(f64, f64)> {
        let margins = self.margins.as_ref();
        margins.map_or_else(Vec::new, |margins| spans(&margins.keep_out_intrusions))
    }

    /// What the visits are worth, where targets have values.
    pub(super) fn value_words(&self) -> Option<String> {
        let (value, bound) = (self.value?, self.value_bound?);
        (bound > 0.0).then(|| format!("value {value} of at most {bound}"))
    }

    /// The index of the first state at a time, s, or after it.
    pub(super) fn index_from(&self, time_s: f64) -> usize {
        let states = &self.trajectory.states;
        states.partition_point(|state| state.time_s < time_s - 1e-6)
    }

    /// That state.
    pub(super) fn state_from(&self, time_s: f64) -> Option<&WrittenState> {
        self.trajectory.states.get(self.index_from(time_s))
    }

    /// Number of wheels.
    pub(super) fn wheels(&self) -> usize {
        let first = self.trajectory.states.first();
        first.map_or(0, |state| state.wheel_speed_rad_s.len())
    }
}
