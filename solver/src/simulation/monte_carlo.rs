//! Many simulated flights of one plan, and statistics over them.

use super::Simulation;
use super::cone_spread::{self, ConeSpread};
use super::cones::applicable;
use super::outcome::{SimulatedFlight, TrackingError};
use super::percentiles::Percentiles;
use crate::model::cone::Cone;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;

/// Errors at an arrival over all flights.
#[derive(Debug, Clone, PartialEq)]
pub struct PassageSpread {
    /// Identifier of the target.
    pub target: String,
    /// Arrival by the plan, s.
    pub time_s: f64,
    /// Attitude errors, rad.
    pub attitude_rad: Percentiles,
    /// Rate errors, rad/s.
    pub rate_rad_s: Percentiles,
}

/// Saturation of a wheel over all flights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SaturationSpread {
    /// Mean share of the flight at the torque limit.
    pub torque_mean: f64,
    /// The same of the flight with the largest share.
    pub torque_max: f64,
    /// Mean share of the flight at the speed limit.
    pub speed_mean: f64,
    /// The same of the flight with the largest share.
    pub speed_max: f64,
}

/// Statistics over the flights of a Monte-Carlo run.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// Number of flights that were simulated; fewer than asked for when stopped.
    pub runs: usize,
    /// Number of flights that were asked for.
    pub runs_asked: usize,
    /// Attitude error up to which a flight is a success, rad.
    pub tolerance_rad: f64,
    /// Share of the flights that end within the tolerance.
    pub share_within: f64,
    /// Share of the flights that are within the tolerance at every arrival.
    pub share_within_at_passages: f64,
    /// Share of the flights that stay clear of all enforced cones, at targets only or always as each
    /// applies; `None` where the scenario enforces none.
    pub share_clear: Option<f64>,
    /// Attitude errors at the end of the flight, rad.
    pub end_attitude_rad: Percentiles,
    /// Rate errors at the end of the flight, rad/s.
    pub end_rate_rad_s: Percentiles,
    /// Attitude errors at the end of the plan, before the time to settle, rad.
    pub plan_end_attitude_rad: Percentiles,
    /// Largest attitude errors at any sample, rad.
    pub peak_attitude_rad: Percentiles,
    /// Errors at the arrivals, in order of the plan.
    pub passages: Vec<PassageSpread>,
    /// One entry per wheel.
    pub saturation: Vec<SaturationSpread>,
    /// One entry per cone that applies at some time of the plan, in order of the scenario.
    pub cones: Vec<ConeSpread>,
}

impl Simulation<'_> {
    /// Simulates the number of flights that the description asks for. The flights are those of
    /// [`Simulation::simulate`] with the numbers from 0 on, for any number of threads. When the stop
    /// signal is set, only flights that are complete by then count.
    #[must_use]
    pub fn monte_carlo(&self, pool: &SolverPool, stop: &StopSignal) -> Spread {
        let numbers: Vec<u64> = (0..self.settings.runs as u64).collect();
        let simulated = pool.map(&numbers, |&number| {
            self.simulate(number, None, &|| stop.is_set())
        });
        let simulated: Vec<SimulatedFlight> = simulated.into_iter().flatten().collect();
        self.spread(&simulated)
    }

    fn spread(&self, simulated: &[SimulatedFlight]) -> Spread {
        let tolerance = self.settings.tolerance;
        let within = |error: &TrackingError| error.attitude_rad <= tolerance;
        let arrivals = |flight: &&SimulatedFlight| {
            let mut passages = flight.passages.iter();
            passages.all(|passage| within(&passage.error))
        };
        let cones: Vec<&Cone> = applicable(self.scenario, self.flight).collect();
        let enforces = self.scenario.cones().iter().any(Cone::is_enforced);
        Spread {
            runs: simulated.len(),
            runs_asked: self.settings.runs,
            tolerance_rad: tolerance,
            share_within: share(simulated, |flight| within(&flight.end)),
            share_within_at_passages: share(simulated, |flight| arrivals(&flight)),
            share_clear: enforces
                .then(|| share(simulated, |flight| cone_spread::is_clear(&cones, flight))),
            end_attitude_rad: percentiles(simulated, |flight| flight.end.attitude_rad),
            end_rate_rad_s: percentiles(simulated, |flight| flight.end.rate_rad_s),
            plan_end_attitude_rad: percentiles(simulated, |flight| flight.plan_end.attitude_rad),
            peak_attitude_rad: percentiles(simulated, |flight| flight.peak.attitude_rad),
            passages: self.passages(simulated),
            saturation: (0..self.scenario.spacecraft().wheels().len())
                .map(|wheel| saturation(simulated, wheel))
                .collect(),
            cones: cone_spread::of(&cones, simulated),
        }
    }

    fn passages(&self, simulated: &[SimulatedFlight]) -> Vec<PassageSpread> {
        let passages = self.flight.passages.iter().enumerate();
        passages
            .map(|(index, passage)| PassageSpread {
                target: passage.target.clone(),
                time_s: passage.time_s,
                attitude_rad: percentiles(simulated, |f| f.passages[index].error.attitude_rad),
                rate_rad_s: percentiles(simulated, |f| f.passages[index].error.rate_rad_s),
            })
            .collect()
    }
}

fn share(simulated: &[SimulatedFlight], good: impl Fn(&SimulatedFlight) -> bool) -> f64 {
    let count = simulated.iter().filter(|flight| good(flight)).count();
    count as f64 / simulated.len().max(1) as f64
}

fn percentiles(
    simulated: &[SimulatedFlight],
    value: impl Fn(&SimulatedFlight) -> f64,
) -> Percentiles {
    Percentiles::of(simulated.iter().map(value).collect())
}

fn saturation(simulated: &[SimulatedFlight], wheel: usize) -> SaturationSpread {
    let count = simulated.len().max(1) as f64;
    let mut spread = SaturationSpread::default();
    for saturation in simulated.iter().map(|flight| flight.saturation[wheel]) {
        spread.torque_mean += saturation.torque / count;
        spread.speed_mean += saturation.speed / count;
        spread.torque_max = spread.torque_max.max(saturation.torque);
        spread.speed_max = spread.speed_max.max(saturation.speed);
    }
    spread
}
