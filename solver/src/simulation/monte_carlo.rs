//! Many flights of one plan, and what they have in common.

use super::Simulation;
use super::outcome::{SimulatedFlight, TrackingError};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;

/// Values that so many of the flights do not exceed (nearest rank).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Percentiles {
    /// Half of them.
    pub p50: f64,
    /// 90 of 100.
    pub p90: f64,
    /// 99 of 100.
    pub p99: f64,
    /// All of them.
    pub max: f64,
}

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

/// What the flights of a Monte-Carlo run have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// Flights that were flown; fewer than asked for when stopped.
    pub runs: usize,
    /// Flights that were asked for.
    pub runs_asked: usize,
    /// Attitude error up to which a flight is a success, rad.
    pub tolerance_rad: f64,
    /// Share of the flights that end within the tolerance.
    pub share_within: f64,
    /// Share of the flights that are within the tolerance at every arrival.
    pub share_within_at_passages: f64,
    /// Attitude errors at the end of the flight, rad.
    pub end_attitude_rad: Percentiles,
    /// Rate errors at the end of the flight, rad/s.
    pub end_rate_rad_s: Percentiles,
    /// Attitude errors at the end of the plan, before the time to settle, rad.
    pub plan_end_attitude_rad: Percentiles,
    /// Largest attitude errors on the way, rad.
    pub peak_attitude_rad: Percentiles,
    /// Errors at the arrivals, in order of the plan.
    pub passages: Vec<PassageSpread>,
    /// One entry per wheel.
    pub saturation: Vec<SaturationSpread>,
}

impl Simulation<'_> {
    /// Flies as many times as the description says, and sums up. The flights are those of
    /// [`Simulation::fly`] with the numbers from 0 on, for any number of threads; when the signal is
    /// given, those that have been flown to their end by then.
    #[must_use]
    pub fn monte_carlo(&self, pool: &SolverPool, stop: &StopSignal) -> Spread {
        let numbers: Vec<u64> = (0..self.settings.runs as u64).collect();
        let flown = pool.map(&numbers, |&number| {
            self.fly(number, None, &|| stop.is_set())
        });
        let flown: Vec<SimulatedFlight> = flown.into_iter().flatten().collect();
        self.spread(&flown)
    }

    fn spread(&self, flown: &[SimulatedFlight]) -> Spread {
        let tolerance = self.settings.tolerance;
        let within = |error: &TrackingError| error.attitude_rad <= tolerance;
        let arrivals = |flight: &&SimulatedFlight| {
            let mut passages = flight.passages.iter();
            passages.all(|passage| within(&passage.error))
        };
        Spread {
            runs: flown.len(),
            runs_asked: self.settings.runs,
            tolerance_rad: tolerance,
            share_within: share(flown, |flight| within(&flight.end)),
            share_within_at_passages: share(flown, |flight| arrivals(&flight)),
            end_attitude_rad: percentiles(flown, |flight| flight.end.attitude_rad),
            end_rate_rad_s: percentiles(flown, |flight| flight.end.rate_rad_s),
            plan_end_attitude_rad: percentiles(flown, |flight| flight.plan_end.attitude_rad),
            peak_attitude_rad: percentiles(flown, |flight| flight.peak.attitude_rad),
            passages: self.passages(flown),
            saturation: (0..self.scenario.spacecraft().wheels().len())
                .map(|wheel| saturation(flown, wheel))
                .collect(),
        }
    }

    fn passages(&self, flown: &[SimulatedFlight]) -> Vec<PassageSpread> {
        let passages = self.flight.passages.iter().enumerate();
        passages
            .map(|(index, passage)| PassageSpread {
                target: passage.target.clone(),
                time_s: passage.time_s,
                attitude_rad: percentiles(flown, |f| f.passages[index].error.attitude_rad),
                rate_rad_s: percentiles(flown, |f| f.passages[index].error.rate_rad_s),
            })
            .collect()
    }
}

fn share(flown: &[SimulatedFlight], good: impl Fn(&SimulatedFlight) -> bool) -> f64 {
    let count = flown.iter().filter(|flight| good(flight)).count();
    count as f64 / flown.len().max(1) as f64
}

fn percentiles(flown: &[SimulatedFlight], value: impl Fn(&SimulatedFlight) -> f64) -> Percentiles {
    Percentiles::of(flown.iter().map(value).collect())
}

impl Percentiles {
    /// Of values in any order; all zero of none.
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let rank = |percent: usize| {
            let rank = (values.len() * percent).div_ceil(100).max(1);
            values.get(rank - 1).copied().unwrap_or(0.0)
        };
        Self {
            p50: rank(50),
            p90: rank(90),
            p99: rank(99),
            max: rank(100),
        }
    }
}

fn saturation(flown: &[SimulatedFlight], wheel: usize) -> SaturationSpread {
    let count = flown.len().max(1) as f64;
    let mut spread = SaturationSpread::default();
    for saturation in flown.iter().map(|flight| flight.saturation[wheel]) {
        spread.torque_mean += saturation.torque / count;
        spread.speed_mean += saturation.speed / count;
        spread.torque_max = spread.torque_max.max(saturation.torque);
        spread.speed_max = spread.speed_max.max(saturation.speed);
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_values_of_the_nearest_rank() {
        let values: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        let found = Percentiles::of(values);
        let expected = Percentiles {
            p50: 100.0,
            p90: 180.0,
            p99: 198.0,
            max: 200.0,
        };
        assert_eq!(found, expected);
        assert_eq!(Percentiles::of(Vec::new()), Percentiles::default());
        assert!((Percentiles::of(vec![3.0]).p50 - 3.0).abs() <= 0.0);
    }
}
