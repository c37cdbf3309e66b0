//! The places of a scenario (start, targets and end) as waypoints of legs.

use super::canonical::IdentityHead;
use crate::bounds::certified::CertifiedBounds;
use crate::leg::solve::arrival::Arrival;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::rolls::rolled_routes;
use crate::leg::solve::zero_length::SAME_ATTITUDE;
use crate::leg::solve::{LegProblem, Resolution};
use crate::math::rounding::rounded;
use crate::model::attitude::Attitude;
use crate::model::cone::forbidden_always;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::roll::RollArcs;
use crate::model::scenario::{End, RateCondition, Scenario};
use crate::model::spec::AttitudeEquivalence;
use crate::model::waypoint::{Waypoint, WheelCondition, least_angle, nearest_rolls};
use crate::tour::order::Place;
use nalgebra::{DVector, Vector3};

/// Number of targets up to which all legs are solved.
pub(super) const MAX_TARGETS_ALL_LEGS: usize = 40;
/// Number of targets up to which all legs are proved that do not couple: at most a second of work, from some 25
/// to 130 microseconds each; with momentum it would be ten times as much.
const MAX_TARGETS_ALL_BOUNDS: usize = 200;

/// The places of a scenario, with what the legs between them have in common.
pub(super) struct Places<'a> {
    /// The scenario.
    pub(super) scenario: &'a Scenario,
    /// Its dynamics, without cones.
    pub(super) dynamics: Dynamics,
    /// The same with the cones that hold along the whole flight.
    pub(super) with_cones: Dynamics,
    /// How the identities of all legs begin.
    pub(super) head: IdentityHead,
    /// Which quaternion signs count as arrived.
    pub(super) arrival: Arrival,
    /// Null-space momentum of the wheels at the start, N m s; rest-to-rest legs hold it at both
    /// ends.
    pub(super) null: DVector<f64>,
    /// Discretization of the legs.
    pub(super) resolution: Resolution,
    /// Kinematic extremals of the spacecraft, for initial guesses.
    pub(super) extremals: KinematicExtremals,
    /// Certified lower bounds on the spacecraft's slews.
    pub(super) certified: CertifiedBounds,
    /// The rolls that limits and cones leave at the targets and the end, where an axis is pointed.
    rolls: Vec<Option<RollArcs>>,
    end_rolls: Option<RollArcs>,
    /// The targets in one attitude each at full rest, where they are planned so.
    stops: Option<Vec<Waypoint>>,
}

/// Start, all targets, and the end of a scenario, where there is one.
pub(super) fn places_of(scenario: &Scenario) -> Vec<Place> {
    let targets = (0..scenario.targets().len()).map(Place::Target);
    let end = scenario.end().map(|_| Place::End);
    std::iter::once(Place::Start)
        .chain(targets)
        .chain(end)
        .collect()
}

impl<'a> Places<'a> {
    pub(super) fn of(scenario: &'a Scenario) -> Self {
        let start = scenario.start();
        let authority = Authority::of(scenario.options());
        let dynamics = Dynamics::of(scenario.spacecraft(), start, authority);
        let wheels = dynamics.wheels_of_speeds(&start.rate, &start.wheel_speed);
        let scale = wheels.amax();
        let targets = scenario.targets().iter();
        let rolls = targets
            .map(|target| scenario.clear_rolls(target.roll.as_ref(), &target.attitude, true));
        let end = scenario.end();
        let resolution = Resolution::of(scenario.options().accuracy, &dynamics);
        let arrival = match scenario.options().attitude_equivalence {
            AttitudeEquivalence::Rotation => Arrival::Rotation,
            AttitudeEquivalence::Quaternion => Arrival::Quaternion,
        };
        Self {
            // Rounding errors of a null-space component that vanishes are set to zero.
            null: dynamics.null_component(&wheels).map(|h| rounded(h, scale)),
            extremals: KinematicExtremals::of(&dynamics),
            certified: CertifiedBounds::of(&dynamics),
            rolls: rolls.collect(),
            end_rolls: end
                .and_then(|end| scenario.clear_rolls(end.roll.as_ref(), &end.attitude, false)),
            head: IdentityHead::new(resolution, arrival, &dynamics),
            resolution,
            arrival,
            with_cones: dynamics.with_cones(forbidden_always(scenario.cones())),
            dynamics,
            scenario,
            stops: None,
        }
    }

    /// The places of a scenario with every target at full rest and, where its roll is free, in that of its
    /// attitudes which is nearest to the start's: nothing is free at targets, and no legs couple.
    pub(super) fn stopping(scenario: &'a Scenario) -> Self {
        let mut places = Self::of(scenario);
        let targets = (0..scenario.targets().len()).map(Place::Target);
        let stops = targets.map(|target| {
            let nearest = places
                .waypoint(target)
                .rolled_towards(&scenario.start().attitude);
            places.stopped(&nearest.pinned())
        });
        places.stops = Some(stops.collect());
        places
    }

    /// Start, all targets, and the end where there is one.
    pub(super) fn all(&self) -> Vec<Place> {
        places_of(self.scenario)
    }

    /// The start and the targets of an order, followed by the end if the tour is `whole` and has
    /// one.
    pub(super) fn route(&self, order: &[usize], whole: bool) -> Vec<Place> {
        let end = self.scenario.end().filter(|_| whole).map(|_| Place::End);
        let targets = order.iter().map(|i| Place::Target(*i));
        std::iter::once(Place::Start)
            .chain(targets)
            .chain(end)
            .collect()
    }

    /// Cuts a route into segments at every waypoint that leaves nothing free: what comes before and
    /// after it are separate problems.
    pub(super) fn split<'r>(&self, route: &'r [Place]) -> Vec<&'r [Place]> {
        let mut segments = Vec::new();
        let mut begin = 0;
        for (i, place) in route.iter().enumerate().skip(1) {
            let last = i + 1 == route.len();
            if last || self.waypoint(*place).is_fixed(&self.dynamics) {
                segments.push(&route[begin..=i]);
                begin = i;
            }
        }
        segments
    }

    /// Identifier of a place: `start`, `end` or a target's identifier.
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
            Place::Target(i) => self.scenario.targets()[i].service(),
            Place::Start | Place::End => 0.0,
        }
    }

    /// Whether all legs are proved and solved before a search begins. With many targets almost none of
    /// them can be part of a good tour, and only those are on which a bound or a short order depends.
    pub(super) fn needs_all_legs(&self) -> bool {
        self.scenario.targets().len() <= MAX_TARGETS_ALL_LEGS
    }

    /// Whether there are so many targets that nothing is known of most legs.
    pub(super) fn has_very_many_targets(&self) -> bool {
        self.scenario.targets().len() > MAX_TARGETS_ALL_BOUNDS
    }

    /// Whether the certified bounds of all legs cost little. Searches for orders are then drawn to few legs that
    /// are underestimated.
    pub(super) fn affords_all_bounds(&self) -> bool {
        !self.has_very_many_targets() && !self.dynamics.has_momentum()
    }

    /// The attitude of a place; where its roll is free, that of roll 0.
    pub(super) fn attitude(&self, place: Place) -> Attitude {
        match place {
            Place::Start => self.scenario.start().attitude,
            Place::Target(i) => match &self.stops {
                Some(stops) => stops[i].attitude,
                None => self.scenario.targets()[i].attitude,
            },
            Place::End => self.end().attitude,
        }
    }

    /// The rolls of a place, where its roll is free.
    fn roll(&self, place: Place) -> Option<&RollArcs> {
        match place {
            Place::Start => None,
            Place::Target(i) => match &self.stops {
                Some(stops) => stops[i].roll.as_ref(),
                None => self.rolls[i].as_ref(),
            },
            Place::End => self.end_rolls.as_ref(),
        }
    }

    /// The attitudes of two places, where rolls are free those with the least turn between them.
    pub(super) fn nearest_attitudes(&self, ends: [Place; 2]) -> [Attitude; 2] {
        if ends.iter().all(|place| self.roll(*place).is_none()) {
            return ends.map(|place| self.attitude(place));
        }
        let [from, to] = ends.map(|place| self.waypoint(place));
        nearest_rolls(&from, &to).map(|end| end.attitude)
    }

    /// A lower bound on the angle, rad, of all turns between two places.
    pub(super) fn least_angle(&self, ends: [Place; 2]) -> f64 {
        if ends.iter().any(|place| self.roll(*place).is_none()) {
            let [from, to] = self.nearest_attitudes(ends);
            return from.angle_to(&to);
        }
        let [from, to] = ends.map(|place| self.waypoint(place));
        least_angle(&from, &to)
    }

    fn end(&self) -> &'a End {
        let end = self.scenario.end();
        end.expect("only scenarios with an end have the place `End`")
    }

    /// A place as a waypoint with its own conditions.
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
                    roll: None,
                    rate: fixed(&start.rate),
                    wheels: wheels(&start.rate, &start.wheel_speed),
                    costates: None,
                }
            }
            Place::Target(i) => {
                if let Some(stops) = &self.stops {
                    return stops[i].clone();
                }
                let target = &self.scenario.targets()[i];
                Waypoint {
                    attitude: target.attitude,
                    roll: self.roll(place).cloned(),
                    rate: target.rate,
                    wheels: WheelCondition::Free,
                    costates: None,
                }
            }
            Place::End => {
                let end = self.end();
                let speeds = end.wheel_speed.as_ref();
                Waypoint {
                    attitude: end.attitude,
                    roll: self.roll(place).cloned(),
                    rate: fixed(&end.rate),
                    wheels: speeds.map_or(WheelCondition::Free, |speeds| wheels(&end.rate, speeds)),
                    costates: None,
                }
            }
        }
    }

    /// Whether the conditions of a place admit rest with the null-space momentum of the start.
    pub(super) fn admits_rest(&self, place: Place) -> bool {
        let there = self.waypoint(place);
        self.slew(&there, &there).begins_and_ends_at_rest()
    }

    /// A place at full rest with the null-space momentum of the start.
    pub(super) fn at_rest(&self, place: Place) -> Waypoint {
        self.stopped(&self.waypoint(place))
    }

    /// A waypoint at full rest with the null-space momentum of the start.
    pub(super) fn stopped(&self, waypoint: &Waypoint) -> Waypoint {
        Waypoint {
            attitude: waypoint.attitude,
            roll: waypoint.roll.clone(),
            rate: [RateCondition::Fixed(0.0); 3],
            wheels: WheelCondition::NullSpace(self.null.clone()),
            costates: None,
        }
    }

    /// The waypoints of a route; where rolls are free, described from those of a short way through all.
    pub(super) fn waypoints(&self, route: &[Place]) -> Vec<Waypoint> {
        let mut starts = self.waypoint_starts(route, 1);
        starts.swap_remove(0)
    }

    /// The waypoints of a route, described from the rolls of so many starts at most.
    pub(super) fn waypoint_starts(&self, route: &[Place], most: usize) -> Vec<Vec<Waypoint>> {
        let waypoints = route.iter().map(|place| self.waypoint(*place)).collect();
        rolled_routes(&self.with_cones, &self.extremals, waypoints, most)
    }

    /// Torques of all wheels, N m, from those of the enabled ones; disabled wheels have none.
    pub(super) fn all_torques(&self, enabled: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut all = vec![0.0; self.scenario.spacecraft().wheels().len()];
        for (actuator, torque) in self.dynamics.actuators.iter().zip(enabled) {
            // A torque is a quotient of rounded numbers and may exceed the limits by rounding.
            all[actuator.index] = torque.clamp(actuator.min_torque, actuator.max_torque);
        }
        all
    }

    /// The leg between two waypoints as a problem to solve.
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

    /// Whether a motion through one place satisfies the conditions of the other: the attitudes are
    /// the same, and the conditions of the first imply those of the second.
    pub(super) fn covers(&self, one: Place, other: Place) -> bool {
        let (one, other) = (self.waypoint(one), self.waypoint(other));
        let implied = |axis: usize| {
            let ([low, high], [min, max]) = (one.rate[axis].range(), other.rate[axis].range());
            min <= low && high <= max
        };
        let held = other.wheels == WheelCondition::Free || one.wheels == other.wheels;
        self.arrival.implies(&one, &other) && (0..3).all(implied) && held
    }

    /// Whether one of two places covers the other.
    pub(super) fn are_one_stop(&self, one: Place, other: Place) -> bool {
        self.covers(one, other) || self.covers(other, one)
    }

    /// Whether the time-reversed motion of every tour is a tour of the same targets: tours begin
    /// and end in the same state, all legs are reversible, and there are no rules for the order.
    pub(super) fn are_symmetric(&self) -> bool {
        if self.scenario.end().is_none() || !self.scenario.order_rules().is_free() {
            return false;
        }
        let (start, end) = (self.waypoint(Place::Start), self.waypoint(Place::End));
        let turn = self.arrival.turn(&start.attitude, &end.attitude);
        // Three wheels have no null space: the rate fixes their momenta.
        let same_wheels = start.wheels == end.wheels || self.dynamics.wheel_count() == 3;
        let targets = (0..self.scenario.targets().len()).map(Place::Target);
        turn <= SAME_ATTITUDE
            && end.roll.is_none()
            && start.rate == end.rate
            && same_wheels
            && self.reversible([&start, &end])
            && targets
                .map(|target| self.waypoint(target))
                .all(|target| self.reversible([&target, &end]))
    }

    /// Whether the time-reversed solution of a leg solves the leg between the same ends exchanged.
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
