//! Start, targets and end as waypoints.

use crate::bounds::certified::CertifiedBounds;
use crate::leg::solve::arrival::Arrival;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::zero_length::SAME_ATTITUDE;
use crate::leg::solve::{LegProblem, Resolution};
use crate::math::rounding::rounded;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spec::AttitudeEquivalence;
use crate::model::waypoint::{Waypoint, WheelCondition};
use crate::tour::order::Place;
use nalgebra::{DVector, Vector3};

/// The places of a scenario, seen by the slew solver.
pub(super) struct Places<'a> {
    /// The scenario.
    pub(super) scenario: &'a Scenario,
    /// Its dynamics.
    pub(super) dynamics: Dynamics,
    /// Which quaternion signs count as arrived.
    pub(super) arrival: Arrival,
    /// Null-space momentum of the wheels at the start, N m s: held by rest-to-rest legs.
    pub(super) null: DVector<f64>,
    /// How finely slews are solved.
    pub(super) resolution: Resolution,
    /// What guesses of slews have in common.
    pub(super) extremals: KinematicExtremals,
    /// What no slew undercuts.
    pub(super) certified: CertifiedBounds,
}

impl<'a> Places<'a> {
    pub(super) fn of(scenario: &'a Scenario) -> Self {
        let start = scenario.start();
        let authority = Authority::of(scenario.options());
        let dynamics = Dynamics::of(scenario.spacecraft(), start, authority);
        let wheels = dynamics.wheels_of_speeds(&start.rate, &start.wheel_speed);
        let scale = wheels.amax();
        Self {
            // What rounding leaves of none is none.
            null: dynamics.null_component(&wheels).map(|h| rounded(h, scale)),
            extremals: KinematicExtremals::of(&dynamics),
            certified: CertifiedBounds::of(&dynamics),
            resolution: Resolution::of(scenario.options().accuracy, &dynamics),
            arrival: match scenario.options().attitude_equivalence {
                AttitudeEquivalence::Rotation => Arrival::Rotation,
                AttitudeEquivalence::Quaternion => Arrival::Quaternion,
            },
            dynamics,
            scenario,
        }
    }

    /// Start, all targets, and the end where there is one.
    pub(super) fn all(&self) -> Vec<Place> {
        let targets = (0..self.scenario.targets().len()).map(Place::Target);
        let end = self.scenario.end().map(|_| Place::End);
        std::iter::once(Place::Start)
            .chain(targets)
            .chain(end)
            .collect()
    }

    /// The places of an order, start included and, for whole tours, the end.
    pub(super) fn route(&self, order: &[usize], whole: bool) -> Vec<Place> {
        let end = self.scenario.end().filter(|_| whole).map(|_| Place::End);
        let targets = order.iter().map(|i| Place::Target(*i));
        std::iter::once(Place::Start)
            .chain(targets)
            .chain(end)
            .collect()
    }

    /// Identifier of a place.
    pub(super) fn name(&self, place: Place) -> String {
        match place {
            Place::Start => "start".into(),
            Place::Target(i) => self.scenario.targets()[i].id.clone(),
            Place::End => "end".into(),
        }
    }

    /// Settle and dwell time at a place, s.
    pub(super) fn service_time(&self, place: Place) -> f64 {
        match place {
            Place::Target(i) => {
                self.scenario.targets()[i].settle + self.scenario.targets()[i].dwell
            }
            Place::Start | Place::End => 0.0,
        }
    }

    /// A place with its own conditions.
    pub(super) fn waypoint(&self, place: Place) -> Waypoint {
        let wheels = |rate: &Vector3<f64>, speeds: &[f64]| {
            WheelCondition::Fixed(self.dynamics.wheels_of_speeds(rate, speeds))
        };
        let fixed = |rate: &Vector3<f64>| [0, 1, 2].map(|i| RateCondition::Fixed(rate[i]));
        match place {
            Place::Start => {
                let start = self.scenario.start();
                Waypoint {
                    attitude: start.attitude,
                    rate: fixed(&start.rate),
                    wheels: wheels(&start.rate, &start.wheel_speed),
                    costates: None,
                }
            }
            Place::Target(i) => {
                let target = &self.scenario.targets()[i];
                Waypoint {
                    attitude: target.attitude,
                    rate: target.rate,
                    wheels: WheelCondition::Free,
                    costates: None,
                }
            }
            Place::End => {
                let end = self
                    .scenario
                    .end()
                    .expect("an end is only asked for where there is one");
                let speeds = end.wheel_speed.as_ref();
                Waypoint {
                    attitude: end.attitude,
                    rate: fixed(&end.rate),
                    wheels: speeds.map_or(WheelCondition::Free, |speeds| wheels(&end.rate, speeds)),
                    costates: None,
                }
            }
        }
    }

    /// A place at full rest with the null-space momentum of the start.
    pub(super) fn at_rest(&self, place: Place) -> Waypoint {
        Waypoint {
            attitude: self.waypoint(place).attitude,
            rate: [RateCondition::Fixed(0.0); 3],
            wheels: WheelCondition::NullSpace(self.null.clone()),
            costates: None,
        }
    }

    /// Torques of all wheels of the spacecraft, N m, from those of the enabled ones.
    pub(super) fn all_torques(&self, enabled: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut all = vec![0.0; self.scenario.spacecraft().wheels().len()];
        for (actuator, torque) in self.dynamics.actuators.iter().zip(enabled) {
            // The quotient of two rounded numbers may leave the limits by a rounding error.
            all[actuator.index] = torque.clamp(actuator.min_torque, actuator.max_torque);
        }
        all
    }

    /// The slew between two waypoints.
    pub(super) fn slew<'s>(&'s self, from: &'s Waypoint, to: &'s Waypoint) -> LegProblem<'s> {
        LegProblem {
            dynamics: &self.dynamics,
            from,
            to,
            arrival: self.arrival,
            null: &self.null,
            extremals: &self.extremals,
            resolution: self.resolution,
        }
    }

    /// Whether whoever passes one place has passed the other one with it: the same attitude under
    /// conditions that imply those of the other.
    pub(super) fn covers(&self, one: Place, other: Place) -> bool {
        let (one, other) = (self.waypoint(one), self.waypoint(other));
        let turn = self.arrival.turn(&one.attitude, &other.attitude);
        let implied = |axis: usize| {
            let ([low, high], [least, greatest]) =
                (one.rate[axis].range(), other.rate[axis].range());
            least <= low && high <= greatest
        };
        let held = other.wheels == WheelCondition::Free || one.wheels == other.wheels;
        turn <= SAME_ATTITUDE && (0..3).all(implied) && held
    }

    /// Whether one of two places covers the other.
    pub(super) fn are_one_stop(&self, one: Place, other: Place) -> bool {
        self.covers(one, other) || self.covers(other, one)
    }

    /// Whether every tour may be flown backwards as a tour of the same targets: it begins and ends in
    /// the same state, each leg is reversible, and no target has its place in the order.
    pub(super) fn are_symmetric(&self) -> bool {
        if self.scenario.end().is_none() || !self.scenario.order_rules().is_free() {
            return false;
        }
        let (start, end) = (self.waypoint(Place::Start), self.waypoint(Place::End));
        let turn = self.arrival.turn(&start.attitude, &end.attitude);
        // Three wheels have no momentum of their own choice.
        let same_wheels = start.wheels == end.wheels || self.dynamics.wheel_count() == 3;
        let targets = (0..self.scenario.targets().len()).map(Place::Target);
        turn <= SAME_ATTITUDE
            && start.rate == end.rate
            && same_wheels
            && self.reversible([&start, &end])
            && targets
                .map(|target| self.waypoint(target))
                .all(|target| self.reversible([&target, &end]))
    }

    /// Whether a flown leg may be flown backwards as the leg between the same places exchanged.
    ///
    /// With zero momentum and no locked wheel turning, `(q, h, u)(t)` and `(q, -h, u)(T - t)` obey
    /// the same equations and torque and speed limits; conditions on rates and null-space
    /// momentum must not change under the sign.
    pub(super) fn reversible(&self, ends: [&Waypoint; 2]) -> bool {
        let symmetric_rate = |condition: &RateCondition| match condition {
            RateCondition::Free => true,
            RateCondition::Fixed(value) => *value == 0.0,
            RateCondition::Within(low, high) => low.to_bits() == (-high).to_bits(),
        };
        let symmetric_wheels = |condition: &WheelCondition| match condition {
            WheelCondition::Free => true,
            WheelCondition::NullSpace(h) | WheelCondition::Fixed(h) => h.iter().all(|h| *h == 0.0),
        };
        !self.dynamics.has_momentum()
            && self.dynamics.locked_momentum == Vector3::zeros()
            && ends
                .iter()
                .all(|end| end.rate.iter().all(symmetric_rate) && symmetric_wheels(&end.wheels))
    }
}

#[cfg(test)]
mod tests;
