//! The part of a flight in closed loop that is drawn, read from its JSON.

use super::written::{Record, WrittenPassage, WrittenState};
use serde::Deserialize;

/// The part of the answer that is read.
#[derive(Debug, Deserialize)]
pub(crate) struct WrittenFlight {
    pub(super) name: Option<String>,
    pub(super) flight: Simulated,
}

#[derive(Debug, Deserialize)]
#[serde(from = "SimulatedFlightJson")]
pub(super) struct Simulated {
    pub(super) total_time_s: f64,
    pub(super) flight_time_s: f64,
    pub(super) within_tolerance: bool,
    pub(super) end: Off,
    pub(super) peak: Off,
    passages: Vec<WrittenPassage>,
    states: Vec<WrittenState>,
    pub(super) samples: Vec<WrittenSample>,
}

/// The JSON form: state and further members of a sample in one object.
#[derive(Debug, Deserialize)]
struct SimulatedFlightJson {
    total_time_s: f64,
    flight_time_s: f64,
    within_tolerance: bool,
    end: Off,
    peak: Off,
    passages: Vec<WrittenPassage>,
    samples: Vec<Whole>,
}

#[derive(Debug, Deserialize)]
struct Whole {
    #[serde(flatten)]
    state: WrittenState,
    #[serde(flatten)]
    sample: WrittenSample,
}

/// Members of a sample besides the state.
#[derive(Debug, Deserialize)]
pub(super) struct WrittenSample {
    pub(super) wheel_torque_nm: Vec<f64>,
    pub(super) torque_limited: Vec<bool>,
    pub(super) speed_limited: Vec<bool>,
    pub(super) error: Off,
}

/// Errors of the flight against the plan.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct Off {
    pub(super) attitude_rad: f64,
    pub(super) rate_rad_s: f64,
}

impl From<SimulatedFlightJson> for Simulated {
    fn from(document: SimulatedFlightJson) -> Self {
        let samples = document.samples.into_iter();
        let (states, samples) = samples.map(|whole| (whole.state, whole.sample)).unzip();
        Self {
            total_time_s: document.total_time_s,
            flight_time_s: document.flight_time_s,
            within_tolerance: document.within_tolerance,
            end: document.end,
            peak: document.peak,
            passages: document.passages,
            states,
            samples,
        }
    }
}

impl Simulated {
    /// Pairs of the times of each sample and of the next, s.
    pub(super) fn spans(&self) -> impl Iterator<Item = (f64, f64)> {
        let begins = self.states.iter().map(|state| state.time_s);
        let ends = begins.clone().skip(1).chain([self.flight_time_s]);
        begins.zip(ends)
    }

    /// The quantities drawn over time; commands are constant from sample to sample.
    ///
    /// # Errors
    ///
    /// A message, when there is nothing to draw or lists differ in length.
    pub(super) fn record(&self) -> Result<Record<'_>, String> {
        if self.states.len() < 2 || self.flight_time_s <= 0.0 {
            return Err("the flight has fewer than two samples".to_owned());
        }
        let wheels = self.samples.first().map_or(0, |s| s.wheel_torque_nm.len());
        let fits = |sample: &WrittenSample| {
            sample.wheel_torque_nm.len() == wheels
                && sample.torque_limited.len() == wheels
                && sample.speed_limited.len() == wheels
        };
        let speeds = self.states.iter().map(|state| &state.wheel_speed_rad_s);
        if !self.samples.iter().all(fits) || !speeds.map(Vec::len).all(|n| n == wheels) {
            return Err("the lists of wheels differ in length".to_owned());
        }
        let torque = |wheel: usize| {
            let held = self.samples.iter().map(move |s| s.wheel_torque_nm[wheel]);
            let ends = self.spans().zip(held);
            ends.flat_map(|((begin, end), torque)| [(begin, torque), (end, torque)])
        };
        Ok(Record {
            total_time_s: self.flight_time_s,
            states: &self.states,
            torques: (0..wheels).map(|i| torque(i).collect()).collect(),
            passages: &self.passages,
        })
    }
}
