//! Legs that were solved elsewhere, held against a scenario before anyone relies on them.
//!
//! Of such a leg only the motion is taken. What it is the solution of, what is proved of it and how
//! long it takes is found out here, and the motion is flown by the checker: as a whole, and from
//! node to node. That no other motion is faster is not known of it, except that it may not be
//! slower than the slew about the eigenaxis, which needs no solver.

use super::all_pairs;
use super::canonical::CanonicalLeg;
use super::from_store::{leg_solution, stored_leg};
use super::legs::{certify, end_of};
use super::places::Places;
use super::tables::SolvedLeg;
use super::verified::{flight_faults, node_faults};
use crate::checker::{END_SPEED_TOLERANCE, RATE_TOLERANCE};
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::motion::Motion;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::waypoint::{Waypoint, WheelCondition};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegKind, StoredLeg};
use nalgebra::{DVector, Vector3};
use std::collections::HashMap;

/// How much longer than the slew about the eigenaxis a leg may take: several times what the solver
/// allows itself.
const EIGENAXIS_TOLERANCE: f64 = 1e-5;

/// Angle, rad, by which a motion may begin away from the identity attitude: programs meet their ends
/// within a tenth of it, and the checker accepts a thousand times as much.
const BEGIN_TOLERANCE: f64 = 1e-9;
/// Most intervals of a leg: ten times what ordinary ones have.
const MAX_INTERVALS: usize = 500;

/// The legs of a kind between the places of a scenario, by their identity.
pub struct LegCheck<'a> {
    places: Places<'a>,
    kind: LegKind,
    legs: HashMap<String, CanonicalLeg>,
}

impl<'a> LegCheck<'a> {
    /// The wanted ones of the legs of a scenario, those around its cones too, told by their identity;
    /// `None` when stopped.
    ///
    /// The scenario must be one of which
    /// [`feasibility_problems`](super::feasibility_problems) finds nothing.
    #[must_use]
    pub fn new(
        scenario: &'a Scenario,
        kind: LegKind,
        wanted: &(dyn Fn(&str) -> bool + Sync),
        (pool, stop): (&SolverPool, &StopSignal),
    ) -> Option<Self> {
        let places = Places::of(scenario);
        let pairs = all_pairs(places.scenario);
        let legs = pool.map(&pairs, |(from, to)| {
            if stop.is_set() {
                return None;
            }
            let [from, to] = [from, to].map(|place| end_of(&places, kind, *place));
            let forms = [CanonicalLeg::of, CanonicalLeg::around_cones];
            let legs = forms.map(|form| form(&places, &from, &to)).into_iter();
            let wanted = legs.filter(|leg| wanted(&leg.identity));
            Some(wanted.map(|leg| (leg.identity.clone(), leg)).collect())
        });
        let legs: Vec<Vec<_>> = legs.into_iter().flatten().collect();
        (!stop.is_set()).then(|| Self {
            legs: legs.into_iter().flatten().collect(),
            places,
            kind,
        })
    }

    /// The identities of the wanted legs.
    pub fn identities(&self) -> impl Iterator<Item = &str> {
        self.legs.keys().map(String::as_str)
    }

    /// A leg as it may be stored, from its motion, in the frame in which it begins at the identity
    /// attitude, and the wall-clock time that its solve took, which is only handed on.
    ///
    /// # Errors
    ///
    /// Sentences about everything that is wrong with it.
    pub fn check(
        &self,
        identity: &str,
        motion: Motion,
        solve_time_s: f64,
    ) -> Result<StoredLeg, Vec<String>> {
        let leg = self.legs.get(identity);
        let leg = leg.ok_or_else(|| vec!["the scenario has no such leg".to_owned()])?;
        let solution = solved(leg, motion)?;
        let profile = &solution.profile;
        let mut faults = self.faults(leg, profile);
        if faults.is_empty() {
            faults = flight_faults(&self.places, leg, profile);
        }
        if faults.is_empty() {
            faults = node_faults(&self.places, leg, profile);
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let solved = SolvedLeg {
            solution,
            certified: certify(&self.places, leg).lower_bound,
            solves: 0,
            solve_time: solve_time_s,
            from_store: false,
            is_condensed: false,
            described_from: leg.described_from(),
        };
        Ok(stored_leg(leg, self.kind, &solved))
    }

    /// What can be said before the motion is flown: whether it begins and ends as it has to, and
    /// is not slow.
    fn faults(&self, leg: &CanonicalLeg, profile: &Profile) -> Vec<String> {
        let mut faults = Vec::new();
        let first = &profile.attitudes[0];
        let begin = leg.from.rolled_towards(first).attitude;
        let turned = first.signed_turn_to(&begin.nearest_sign(first)).norm();
        if turned > BEGIN_TOLERANCE {
            faults.push(format!(
                "it begins {turned:.1e} rad away from the identity attitude"
            ));
        }
        let last = profile.intervals();
        for (end, node, name) in [(&leg.from, 0, "begin"), (&leg.to, last, "end")] {
            let (attitude, wheels) = (&profile.attitudes[node], &profile.wheels[node]);
            let rate = leg.dynamics.rate(attitude, wheels);
            faults.extend(rate_faults(end, &rate, name));
            faults.extend(wheel_fault(leg, end, wheels, name));
        }
        let slew = leg.problem(&self.places.extremals);
        // With momentum the solver does not promise it either, and the eigenaxis may lead through cones.
        let promised = !leg.dynamics.has_momentum() && leg.dynamics.cones.is_empty();
        if promised && slew.begins_and_ends_at_rest() {
            let eigenaxis = slew.eigenaxis();
            let (duration, usual) = (profile.duration(), eigenaxis.course.duration());
            if eigenaxis.flyable && duration > usual * (1.0 + EIGENAXIS_TOLERANCE) {
                faults.push(format!(
                    "it takes {duration:.6} s, the slew about the eigenaxis {usual:.6} s"
                ));
            }
        }
        faults
    }
}

/// The motion of an imported leg, when its numbers fit together.
fn solved(leg: &CanonicalLeg, motion: Motion) -> Result<LegSolution, Vec<String>> {
    let wheels = leg.dynamics.wheel_count();
    let momenta = &motion.wheel_momenta_nms;
    let mut faults = Vec::new();
    if momenta.iter().any(|node| node.len() != wheels) {
        faults.push(format!("not every node has momenta of {wheels} wheels"));
    }
    if momenta
        .iter()
        .flatten()
        .any(|momentum| !momentum.is_finite())
    {
        faults.push("a momentum is not finite".into());
    }
    let is_time = |length: &f64| length.is_finite() && *length >= 0.0;
    if !motion.lengths_s.iter().all(is_time) {
        faults.push("a time between nodes is negative or not finite".into());
    }
    let intervals = motion.lengths_s.len();
    if intervals > MAX_INTERVALS {
        faults.push(format!("it has more than {MAX_INTERVALS} intervals"));
    }
    let solution = leg_solution(motion);
    if solution.is_none() {
        let nodes = intervals + 1;
        faults.push(format!(
            "it has not {nodes} unit quaternions and momenta with {intervals} times between them"
        ));
    }
    solution.filter(|_| faults.is_empty()).ok_or(faults)
}

/// Rates at an end of a leg that are not what its conditions ask for.
fn rate_faults(end: &Waypoint, rate: &Vector3<f64>, name: &str) -> Vec<String> {
    let off = |axis: usize| {
        let off = match end.rate[axis] {
            RateCondition::Free => 0.0,
            RateCondition::Fixed(value) => (rate[axis] - value).abs(),
            RateCondition::Within(low, high) => (low - rate[axis]).max(rate[axis] - high),
        };
        let about = ["x", "y", "z"][axis];
        (off.is_nan() || off > RATE_TOLERANCE)
            .then(|| format!("the rate about {about} is off by {off:.1e} rad/s at the {name}"))
    };
    (0..3).filter_map(off).collect()
}

/// Wheel momenta at an end of a leg that are not what its conditions ask for.
fn wheel_fault(
    leg: &CanonicalLeg,
    end: &Waypoint,
    wheels: &DVector<f64>,
    name: &str,
) -> Option<String> {
    let off = match &end.wheels {
        WheelCondition::Free => return None,
        WheelCondition::Fixed(held) => wheels - held,
        WheelCondition::NullSpace(held) => leg.dynamics.null_component(wheels) - held,
    };
    let limits = leg.dynamics.actuators.iter();
    let limits = limits.map(|wheel| wheel.inertia * wheel.max_speed);
    let largest = limits.filter(|limit| limit.is_finite());
    let scale = largest.fold(wheels.amax(), f64::max);
    let off = off.amax();
    (off.is_nan() || off > END_SPEED_TOLERANCE * scale)
        .then(|| format!("the wheels are off by {off:.1e} N m s at the {name}"))
}
