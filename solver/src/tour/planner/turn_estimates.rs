//! Estimates of legs from the turns between their ends, without any search or program.

use super::places::Places;
use crate::model::scenario::RateCondition;
use crate::tour::order::Place;
use nalgebra::Vector3;

/// Estimates of the legs between the places of a scenario.
pub(super) struct TurnEstimates<'a> {
    places: &'a Places<'a>,
    /// Largest body rate about each axis, rad/s.
    rates: Vector3<f64>,
    /// Largest acceleration about each axis, rad/s².
    accelerations: Vector3<f64>,
}

impl<'a> TurnEstimates<'a> {
    pub(super) fn of(places: &'a Places<'a>) -> Self {
        Self {
            places,
            rates: places.dynamics.reachable_rates(),
            accelerations: places.dynamics.reachable_accelerations(),
        }
    }

    /// Time of the slowest component of the turn, s, with the rates of [`Self::rates`] at both ends and the
    /// largest rate and acceleration about its axis.
    pub(super) fn duration_s(&self, from: Place, to: Place) -> f64 {
        let turn = self.turn(from, to);
        let rates = self.rates(&turn, [from, to]);
        let component = |axis: usize| {
            let (angle, most) = (turn[axis].abs(), self.rates[axis]);
            let acceleration = self.accelerations[axis];
            // From one end's rate to the peak and on to the other's, along the turn.
            let [first, last] = rates.map(|rate| rate[axis] * turn[axis].signum());
            let squares = 0.5 * (first * first + last * last);
            let peak = (angle * acceleration + squares).sqrt();
            if peak <= most {
                (2.0 * peak - first - last) / acceleration
            } else {
                let ramps_s = (2.0 * most - first - last) / acceleration;
                let ramps = (most * most - squares) / acceleration;
                ramps_s + (angle - ramps) / most
            }
        };
        (0..3).map(component).fold(0.0, f64::max)
    }

    /// Body rates at both ends, rad/s, of a turn about the eigenaxis as fast as the wheels allow, within
    /// the conditions at the ends.
    fn rates(&self, turn: &Vector3<f64>, ends: [Place; 2]) -> [Vector3<f64>; 2] {
        let fastest = self.rates.zip_map(turn, |most, part| most / part.abs());
        let fastest = fastest.min();
        let rate = if fastest.is_finite() {
            turn * fastest
        } else {
            Vector3::zeros()
        };
        ends.map(|place| admitted(&self.places.waypoint(place).rate, &rate))
    }

    /// The same, each component as the time in which it is reached from rest, s, with its sign.
    pub(super) fn free_ends(&self, from: Place, to: Place) -> [[f64; 3]; 2] {
        let rates = self.rates(&self.turn(from, to), [from, to]);
        rates.map(|rate| self.time_to_reach(&rate).into())
    }

    /// Times in which the components of a rate, rad/s, are reached from rest, s, with its signs.
    pub(super) fn time_to_reach(&self, rate: &Vector3<f64>) -> Vector3<f64> {
        rate.component_div(&self.accelerations)
    }

    fn turn(&self, from: Place, to: Place) -> Vector3<f64> {
        let [from, to] = self.places.nearest_attitudes([from, to]);
        self.places.arrival.turn_vector(&from, &to)
    }
}

/// The rate nearest to a given one that conditions admit, rad/s.
fn admitted(conditions: &[RateCondition; 3], rate: &Vector3<f64>) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| {
        let [low, high] = conditions[axis].range();
        rate[axis].clamp(low, high)
    })
}

#[cfg(test)]
mod tests;
