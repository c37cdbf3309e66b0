//! The canonical form of a leg: what makes two legs the same problem.

use super::places::Places;
use crate::leg::multiphase::LegSolution;
use crate::leg::solve::arrival::Arrival;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::{LegProblem, Resolution};
use crate::math::rounding::rounded;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use crate::model::dynamics::Dynamics;
use crate::model::scenario::RateCondition;
use crate::model::waypoint::{Waypoint, WheelCondition};
use nalgebra::{DVector, Vector3};
use std::collections::{HashMap, HashSet};
use std::fmt::Write;
use std::ops::Range;

/// Version of the canonical form and of the numerics behind it. It is part of the identity: legs
/// stored by another version are not found.
const VERSION: &str = "leg-10";
/// Length of the key of most legs, bytes.
const KEY_LENGTH: usize = 512;

/// A leg in the frame in which it begins at the identity attitude.
#[derive(Debug, Clone)]
pub(super) struct CanonicalLeg {
    /// Canonical text of everything that the solution depends on.
    pub(super) identity: String,
    /// Where it describes the spacecraft. What the legs of one scenario do not have in common follows.
    described: Range<usize>,
    /// The spacecraft with the momentum in this frame.
    pub(super) dynamics: Dynamics,
    /// The begin, at the identity attitude.
    pub(super) from: Waypoint,
    /// The end.
    pub(super) to: Waypoint,
    /// Whether this is the requested leg with begin and end exchanged.
    pub(super) mirrored: bool,
    /// Whether the time-reversed solution solves the leg with begin and end exchanged.
    pub(super) reversible: bool,
    /// Which quaternion signs count as arrived.
    pub(super) arrival: Arrival,
    null: DVector<f64>,
    /// How finely it is solved.
    pub(super) resolution: Resolution,
    /// With cones: the solution without them in this frame.
    pub(super) free: Option<LegSolution>,
}

impl CanonicalLeg {
    /// The canonical form of the leg between two waypoints, without cones.
    pub(super) fn of(places: &Places<'_>, from: &Waypoint, to: &Waypoint) -> Self {
        Self::within(&places.dynamics, places, [from, to])
    }

    /// The same with the cones that the scenario enforces.
    pub(super) fn around_cones(places: &Places<'_>, from: &Waypoint, to: &Waypoint) -> Self {
        Self::within(&places.with_cones, places, [from, to])
    }

    /// The same leg with what is known of it without cones between two waypoints.
    pub(super) fn knowing(mut self, free: &LegSolution, ends: [&Waypoint; 2]) -> Self {
        let begin = ends[usize::from(self.mirrored)];
        let here = begin.roll.as_ref().map(|_| &begin.attitude);
        self.free = Some(free.placed(self.mirrored, here, &self.from.attitude));
        self
    }

    /// The attitudes from which its ends are described, where their rolls are free.
    pub(super) fn described_from(&self) -> [Option<Attitude>; 2] {
        [&self.from, &self.to].map(|end| end.roll.as_ref().map(|_| end.attitude))
    }

    fn within(dynamics: &Dynamics, places: &Places<'_>, [from, to]: [&Waypoint; 2]) -> Self {
        let reversible = places.reversible([from, to]);
        let mut flown = DirectedLeg::of(dynamics, places, [from, to]);
        let mut mirrored = false;
        if reversible {
            let back = DirectedLeg::of(dynamics, places, [to, from]);
            mirrored = back.key < flown.key;
            if mirrored {
                flown = back;
            }
        }
        let head = &places.head;
        Self {
            identity: [&*head.text, &*flown.key].concat(),
            described: head.spacecraft..head.text.len(),
            dynamics: flown.dynamics,
            from: flown.from,
            to: flown.to,
            mirrored,
            reversible,
            arrival: places.arrival,
            null: places.null.clone(),
            resolution: places.resolution,
            free: None,
        }
    }

    /// The part of the identity that describes the spacecraft.
    pub(super) fn spacecraft(&self) -> &str {
        &self.identity[self.described.clone()]
    }

    /// What tells it from the other legs of its scenario: a third of the identity.
    pub(super) fn key(&self) -> &str {
        &self.identity[self.described.end..]
    }

    /// The problem to solve; initial guesses come from the extremals of its spacecraft.
    pub(super) fn problem<'a>(&'a self, extremals: &'a KinematicExtremals) -> LegProblem<'a> {
        LegProblem {
            dynamics: &self.dynamics,
            from: &self.from,
            to: &self.to,
            arrival: self.arrival,
            null: &self.null,
            extremals,
            resolution: self.resolution,
        }
    }
}

/// The canonical form of the leg between two waypoints: with cones or without them.
pub(super) type CanonicalForm = fn(&Places<'_>, &Waypoint, &Waypoint) -> CanonicalLeg;

/// A leg in one of the directions in which it may be flown.
struct DirectedLeg {
    /// The part of the identity that legs of one scenario do not have in common.
    key: String,
    dynamics: Dynamics,
    from: Waypoint,
    to: Waypoint,
}

impl DirectedLeg {
    fn of(dynamics: &Dynamics, places: &Places<'_>, [from, to]: [&Waypoint; 2]) -> Self {
        let mut turn = rounded_attitude(&from.attitude.turn_to(&to.attitude));
        if places.arrival == Arrival::Rotation {
            turn = upper_hemisphere(&turn);
        }
        let mut dynamics = dynamics.clone();
        dynamics.momentum = rounded_vector(from.attitude.to_body(dynamics.momentum));
        for cone in &mut dynamics.cones {
            cone.direction = rounded_vector(from.attitude.to_body(cone.direction));
        }
        // In what order and how often they are listed does not matter.
        dynamics.cones.sort_by_cached_key(described);
        dynamics.cones.dedup();
        let from = settled(&dynamics, Attitude::identity(), from);
        let to = settled(&dynamics, turn, to);
        let mut key = String::with_capacity(KEY_LENGTH);
        let momentum = dynamics.momentum;
        for part in [momentum.as_slice(), &turn.xyzw(), places.null.as_slice()] {
            push_numbers(&mut key, part);
        }
        for place in [&from, &to] {
            describe_conditions(&mut key, place);
        }
        describe_cones(&mut key, &dynamics.cones);
        Self {
            key,
            dynamics,
            from,
            to,
        }
    }
}

/// How the identities of all legs of a scenario begin.
#[derive(Debug)]
pub(super) struct IdentityHead {
    text: String,
    /// Where it describes the spacecraft, up to its end.
    spacecraft: usize,
}

impl IdentityHead {
    pub(super) fn new(resolution: Resolution, arrival: Arrival, dynamics: &Dynamics) -> Self {
        let mut text = format!("{VERSION};{resolution:?};{arrival:?};");
        let spacecraft = text.len();
        describe_spacecraft(&mut text, dynamics);
        Self { text, spacecraft }
    }

    /// Canonical text of the spacecraft.
    pub(super) fn spacecraft(&self) -> &str {
        &self.text[self.spacecraft..]
    }
}

/// The legs that are not known yet, without repetitions, with their places in the list.
pub(super) fn missing_from<'c, T>(
    known: &HashMap<String, T>,
    legs: &'c [Option<CanonicalLeg>],
) -> Vec<(usize, &'c CanonicalLeg)> {
    let mut listed = HashSet::new();
    let legs = legs.iter().enumerate();
    legs.filter_map(|(index, leg)| Some((index, leg.as_ref()?)))
        .filter(|(_, leg)| !known.contains_key(leg.key()) && listed.insert(leg.key()))
        .collect()
}

/// A waypoint with its attitude in the leg's frame. Conditions that leave nothing free are replaced
/// by the wheel momenta that they imply, so that equivalent conditions have one identity.
fn settled(dynamics: &Dynamics, attitude: Attitude, place: &Waypoint) -> Waypoint {
    let mut settled = Waypoint {
        attitude,
        ..place.clone()
    };
    if let [
        RateCondition::Fixed(x),
        RateCondition::Fixed(y),
        RateCondition::Fixed(z),
    ] = place.rate
        && place.fixes_limits(dynamics)
    {
        let null = match &place.wheels {
            WheelCondition::NullSpace(null) => null.clone(),
            WheelCondition::Free => DVector::zeros(0),
            WheelCondition::Fixed(_) => return settled,
        };
        let wheels = dynamics.wheels_at(&attitude, &Vector3::new(x, y, z), &null);
        settled.wheels = WheelCondition::Fixed(wheels);
    }
    settled
}

fn rounded_attitude(attitude: &Attitude) -> Attitude {
    let components = attitude.xyzw().map(|c| rounded(c, 1.0));
    Attitude::from_xyzw(components).expect("a rounded unit quaternion has nearly unit length")
}

fn rounded_vector(vector: Vector3<f64>) -> Vector3<f64> {
    let scale = vector.amax();
    vector.map(|c| rounded(c, scale))
}

/// The one of `q` and `-q` whose last nonzero component is positive.
fn upper_hemisphere(attitude: &Attitude) -> Attitude {
    let leading = attitude.xyzw().into_iter().rev().find(|c| *c != 0.0);
    if leading.is_some_and(|c| c < 0.0) {
        attitude.negated()
    } else {
        *attitude
    }
}

fn push_numbers(text: &mut String, numbers: &[f64]) {
    for number in numbers {
        // Adding zero turns -0 into 0. Writing to a string cannot fail.
        let _ = write!(text, "{:e},", number + 0.0);
    }
    text.push(';');
}

/// Canonical text of a spacecraft; its momentum is not part of it, because the frame of a leg turns it.
fn describe_spacecraft(text: &mut String, dynamics: &Dynamics) {
    push_numbers(text, dynamics.inertia.as_slice());
    for wheel in &dynamics.actuators {
        push_numbers(text, wheel.axis.as_slice());
        let numbers = [
            wheel.inertia,
            wheel.min_torque,
            wheel.max_torque,
            wheel.max_speed,
        ];
        push_numbers(text, &numbers);
    }
    push_numbers(text, dynamics.locked_momentum.as_slice());
    push_numbers(text, dynamics.max_rate.as_slice());
    push_numbers(text, &[dynamics.max_rate_norm]);
}

const CONE: &str = "cone ";

fn describe_cones(text: &mut String, cones: &[ForbiddenCone]) {
    for cone in cones {
        text.push_str(&described(cone));
    }
}

fn described(cone: &ForbiddenCone) -> String {
    let mut text = CONE.to_owned();
    push_numbers(&mut text, cone.axis.as_slice());
    push_numbers(&mut text, cone.direction.as_slice());
    push_numbers(&mut text, &[cone.half_angle]);
    text
}

/// The cones that a leg keeps out of, in the frame in which it begins at the identity attitude, from its
/// identity.
#[must_use]
pub fn cones_of(identity: &str) -> Vec<ForbiddenCone> {
    let cone = |text: &str| {
        let numbers = text.split([';', ',']).filter(|number| !number.is_empty());
        let numbers: Vec<f64> = numbers.filter_map(|number| number.parse().ok()).collect();
        let &[a, b, c, x, y, z, half_angle] = &numbers[..] else {
            return None;
        };
        Some(ForbiddenCone {
            axis: Vector3::new(a, b, c),
            direction: Vector3::new(x, y, z),
            half_angle,
        })
    };
    identity.split(CONE).skip(1).filter_map(cone).collect()
}

fn describe_conditions(text: &mut String, place: &Waypoint) {
    if let Some(roll) = &place.roll {
        text.push_str("roll ");
        push_numbers(text, roll.axis.as_slice());
        push_numbers(text, roll.arcs.as_flattened());
    }
    for rate in &place.rate {
        match rate {
            RateCondition::Free => text.push_str("free;"),
            RateCondition::Fixed(value) => push_numbers(text, &[*value]),
            RateCondition::Within(low, high) => push_numbers(text, &[*low, *high]),
        }
    }
    match &place.wheels {
        WheelCondition::Free => text.push_str("wheels free;"),
        WheelCondition::NullSpace(h) => {
            text.push_str("null ");
            push_numbers(text, h.as_slice());
        }
        WheelCondition::Fixed(h) => {
            text.push_str("fixed ");
            push_numbers(text, h.as_slice());
        }
    }
}

#[cfg(test)]
mod tests;
