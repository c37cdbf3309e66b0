//! A leg constructed without a program, which exists wherever the wheels can hold the stored
//! momentum: slowly about the eigenaxis.
//!
//! Inside the sphere of momenta that the wheels hold in every direction a body can rest at every
//! attitude, and so it can turn, if slowly enough. The motion: brake to rest, move the wheels far
//! from their limits ([`centred`]), turn about the eigenaxis at a pace that leaves room under every
//! limit, move the wheels to the momenta of the end, and speed up to its rates. Torque has to be
//! constant on every interval, so a nominal motion is followed two intervals at a time: for given
//! momenta at both ends, those in the middle are chosen such that the attitude at the second end is
//! met exactly, three equations with three unknowns.

use super::LegProblem;
use super::centred::centred;
use crate::leg::kinematics::{TurnInputs, exact_turn};
use crate::leg::multiphase::{LegSolution, keeps_limits_inside};
use crate::leg::profile::Profile;
use crate::math::bang_coast_bang::BangCoastBang;
use crate::math::rounding::parts_of;
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use crate::model::scenario::RateCondition;
use crate::model::waypoint::{Waypoint, WheelCondition};
use crate::nlp::NlpStatus;
use nalgebra::{DVector, Matrix3, Vector3};

/// The first pace that is tried, as a share of what zero momentum allows; the ratio of each pace to
/// the one before it; and the number of paces.
const FASTEST: f64 = 0.95;
const SLOWER: f64 = 0.8;
const PACES: i32 = 40;
/// The slowest pace at which a body brakes from a rate at an end, or speeds up to it.
const SLOWEST_BRAKE: f64 = 0.1;
/// How far a rate may stray between nodes, relative to its limit: the margin of the fastest pace.
const STRAY: f64 = 0.02;
/// Longest turn over one interval, rad.
const MAX_TURN: f64 = 0.1;
/// Intervals of a ramp, and the fewest of a coast; even numbers.
const RAMP: usize = 4;
const MIN_COAST: usize = 4;
/// Limit of the pairs of intervals of each part of the motion.
const MAX_PAIRS: usize = 2000;
/// Share of the torque that moves the wheels of a body at rest.
const SHIFT_TORQUE: f64 = 0.9;
/// Rate, rad/s, below which a body rests.
const SAME_RATE: f64 = 1e-12;
/// Angle, rad, within which an attitude is met, and steps on the way there.
const MET: f64 = 1e-12;
const STEERING_STEPS: usize = 30;
/// Turn, rad, of the finite differences.
const TRIAL_TURN: f64 = 1e-4;

/// The nominal motion: nodes with an even number of intervals between them.
struct Nominal {
    attitudes: Vec<Attitude>,
    wheels: Vec<DVector<f64>>,
    lengths: Vec<f64>,
}

/// The constructed solution; `None` where no pace is slow enough, or the state at an end exceeds
/// limits.
pub(super) fn steered(leg: &LegProblem<'_>) -> Option<LegSolution> {
    (0..PACES).find_map(|step| {
        let pace = FASTEST * SLOWER.powi(step);
        let profile = nominal(leg, pace)?.followed(leg.dynamics)?;
        keeps_limits(leg.dynamics, &profile).then(|| LegSolution {
            status: NlpStatus::Constructed,
            intervals: vec![profile.intervals()],
            profile,
            iterations: 0,
            infeasibility: 0.0,
            costates: Vec::new(),
        })
    })
}

/// Whether speed, rate and torque limits hold at the inner nodes and between nodes; the states at
/// the ends are given.
fn keeps_limits(dynamics: &Dynamics, profile: &Profile) -> bool {
    let nodes = profile.attitudes.iter().zip(&profile.wheels);
    let inner = nodes.skip(1).take(profile.intervals().saturating_sub(1));
    let held = |(attitude, wheels): (&Attitude, &DVector<f64>)| {
        dynamics.speed_usage(&dynamics.rate(attitude, wheels), wheels) <= 1.0
    };
    let pairs = profile.wheels.windows(2).zip(&profile.lengths);
    let mut torques = pairs.map(|(wheels, length)| (&wheels[1] - &wheels[0]) / *length);
    torques.all(|torque| dynamics.torque_usage(&torque) <= 1.0)
        && inner.into_iter().all(held)
        && keeps_limits_inside(dynamics, profile)
}

fn nominal(leg: &LegProblem<'_>, pace: f64) -> Option<Nominal> {
    let dynamics = leg.dynamics;
    let mut motion = Nominal::at(leg.from.attitude, state_at(leg, leg.from)?);
    motion.brake(dynamics, pace);
    let mut arrival = Nominal::at(leg.to.attitude, state_at(leg, leg.to)?);
    arrival.speed_up(dynamics, pace);
    let (resting, _) = motion.last();
    let target = leg.arrival.signed(&arrival.attitudes[0], &resting);
    if target != arrival.attitudes[0] {
        arrival.attitudes.iter_mut().for_each(|q| *q = q.negated());
    }
    motion.turn_to(dynamics, &target, pace)?;
    if arrival.lengths.is_empty() && leg.to.wheels == WheelCondition::Free {
        return Some(motion);
    }
    motion.shift_to(dynamics, arrival.wheels[0].clone());
    motion.append(arrival);
    Some(motion)
}

/// The wheel momenta at an end with the slowest rates that its conditions admit.
fn state_at(leg: &LegProblem<'_>, end: &Waypoint) -> Option<DVector<f64>> {
    let dynamics = leg.dynamics;
    let rate = Vector3::from_fn(|axis, _| slowest(end.rate[axis]));
    match &end.wheels {
        WheelCondition::Fixed(momenta) => Some(momenta.clone()),
        WheelCondition::NullSpace(null) => Some(dynamics.wheels_at(&end.attitude, &rate, null)),
        WheelCondition::Free => centred(dynamics, &dynamics.demanded(&end.attitude, &rate)),
    }
}

/// The rate nearest to zero.
fn slowest(condition: RateCondition) -> f64 {
    let [least, greatest] = condition.range();
    0.0_f64.clamp(least, greatest)
}

impl Nominal {
    fn at(attitude: Attitude, wheels: DVector<f64>) -> Self {
        Self {
            attitudes: vec![attitude],
            wheels: vec![wheels],
            lengths: Vec::new(),
        }
    }

    fn last(&self) -> (Attitude, DVector<f64>) {
        let last = self.lengths.len();
        (self.attitudes[last], self.wheels[last].clone())
    }

    fn push(&mut self, length: f64, attitude: Attitude, wheels: DVector<f64>) {
        self.lengths.push(length);
        self.attitudes.push(attitude);
        self.wheels.push(wheels);
    }

    fn append(&mut self, next: Self) {
        self.attitudes.extend(next.attitudes.into_iter().skip(1));
        self.wheels.extend(next.wheels.into_iter().skip(1));
        self.lengths.extend(next.lengths);
    }

    /// Extends a single node by a motion from its rate to rest.
    fn brake(&mut self, dynamics: &Dynamics, pace: f64) {
        *self = self.ramp(dynamics, pace, 1.0);
    }

    /// Extends a single node by a motion from rest to its rate.
    fn speed_up(&mut self, dynamics: &Dynamics, pace: f64) {
        *self = self.ramp(dynamics, pace, -1.0);
        self.attitudes.reverse();
        self.wheels.reverse();
        self.lengths.reverse();
    }

    /// Nodes from a single one to rest, forward or backward in time, the rate falling evenly about
    /// a fixed axis at constant null-space momentum.
    fn ramp(&self, dynamics: &Dynamics, pace: f64, direction: f64) -> Self {
        let (attitude, wheels) = self.last();
        let mut nodes = Self::at(attitude, wheels);
        let rate = dynamics.rate(&attitude, &nodes.wheels[0]);
        let size = rate.norm();
        if size <= SAME_RATE {
            return nodes;
        }
        let null = dynamics.null_component(&nodes.wheels[0]);
        // A body that brakes more slowly turns farther, so there is a least pace.
        let pace = pace.max(SLOWEST_BRAKE);
        let duration = size / (dynamics.axis_acceleration(&(rate / size)) * pace.powi(2));
        let turn = 0.5 * size * duration;
        let count = 2 * parts_of(turn, 2.0 * longest_turn(dynamics), MAX_PAIRS).max(1);
        for node in (0..count).rev() {
            let share = node as f64 / count as f64;
            let turned = rate * (direction * 0.5 * duration * (1.0 - share.powi(2)));
            let attitude = attitude.retract(turned);
            let wheels = dynamics.wheels_at(&attitude, &(rate * share), &null);
            nodes.push(duration / count as f64, attitude, wheels);
        }
        nodes
    }

    /// Moves the wheels while the body rests.
    fn shift_to(&mut self, dynamics: &Dynamics, wheels: DVector<f64>) {
        let (attitude, from) = self.last();
        let shift = &wheels - &from;
        let times = dynamics.actuators.iter().zip(shift.iter());
        let duration = times
            .map(|(wheel, shift)| shift.abs() / wheel.max_torque.min(-wheel.min_torque))
            .fold(0.0, f64::max)
            / SHIFT_TORQUE;
        if duration > 0.0 {
            self.push(0.5 * duration, attitude, from + shift * 0.5);
            self.push(0.5 * duration, attitude, wheels);
        }
    }

    /// Turns about the eigenaxis from rest to rest.
    fn turn_to(&mut self, dynamics: &Dynamics, target: &Attitude, pace: f64) -> Option<()> {
        let (from, _) = self.last();
        let held = |attitude: &Attitude, rate: &Vector3<f64>| {
            centred(dynamics, &dynamics.demanded(attitude, rate))
        };
        let turn = from.signed_turn_to(target);
        let angle = turn.norm();
        self.shift_to(dynamics, held(&from, &Vector3::zeros())?);
        if angle == 0.0 {
            return Some(());
        }
        let axis = turn / angle;
        let fastest = dynamics.axis_rate(&axis) * (1.0 - STRAY) * pace;
        let acceleration = dynamics.axis_acceleration(&axis) * pace.powi(2);
        let course = BangCoastBang::fastest(angle, acceleration, fastest);
        if !(course.duration() > 0.0 && course.duration().is_finite()) {
            // Limits near the ends of the number range allow no turn.
            return None;
        }
        let mut before = 0.0;
        for time in node_times(dynamics, &course, angle) {
            let (turned, rate, _) = course.at(time);
            let attitude = from.retract(axis * turned);
            let wheels = held(&attitude, &(axis * rate))?;
            self.push(time - before, attitude, wheels);
            before = time;
        }
        Some(())
    }

    /// The motion under constant torques that meets every second node.
    fn followed(self, dynamics: &Dynamics) -> Option<Profile> {
        let mut profile = Profile {
            attitudes: self.attitudes,
            wheels: self.wheels,
            lengths: self.lengths,
        };
        for first in (0..profile.intervals()).step_by(2) {
            steer(dynamics, &mut profile, first)?;
        }
        Some(profile)
    }
}

/// Finds the momenta in the middle of two intervals with which the attitude at their end is met.
fn steer(dynamics: &Dynamics, profile: &mut Profile, first: usize) -> Option<()> {
    let target = profile.attitudes[first + 2];
    let lever = &dynamics.axes_inverse * dynamics.inertia;
    let missed = |profile: &Profile, first: usize| {
        let middle = propagated(dynamics, profile, first, &profile.attitudes[first]);
        let end = propagated(dynamics, profile, first + 1, &middle);
        (middle, end.signed_turn_to(&target.nearest_sign(&end)))
    };
    let mut slope: Option<Matrix3<f64>> = None;
    for _ in 0..STEERING_STEPS {
        let (middle, error) = missed(profile, first);
        profile.attitudes[first + 1] = middle;
        if error.norm() <= MET {
            return Some(());
        }
        // By finite differences: the momentum in the body turns the response to a torque in time.
        let slope = *slope.get_or_insert_with(|| {
            let time = profile.lengths[first] + profile.lengths[first + 1];
            let by = TRIAL_TURN / time;
            let column = |axis: usize| {
                let mut trial = profile.part(first..first + 2);
                trial.wheels[1] += lever.column(axis) * by;
                (missed(&trial, 0).1 - error) / by
            };
            Matrix3::from_columns(&[column(0), column(1), column(2)])
        });
        let change = slope.lu().solve(&error)?;
        profile.wheels[first + 1] -= &lever * change;
    }
    None
}

/// The attitude at the end of interval `k` from an attitude at its beginning.
fn propagated(dynamics: &Dynamics, profile: &Profile, k: usize, from: &Attitude) -> Attitude {
    let length = profile.lengths[k];
    let rate = |wheels: &DVector<f64>| {
        let held = dynamics.locked_momentum + &dynamics.axes * wheels;
        dynamics.inertia_inverse * held * -length
    };
    let inputs = TurnInputs {
        begin: rate(&profile.wheels[k]),
        end: rate(&profile.wheels[k + 1]),
        momentum: from.to_body(dynamics.momentum) * length,
    };
    let turn = exact_turn(dynamics.inertia_inverse, dynamics.has_momentum(), &inputs);
    let turn = Attitude::from_xyzw(turn).unwrap_or_else(Attitude::identity);
    from.then_in_body(&turn)
}

/// Times of the nodes after the first, s: an even number, evenly spaced on each ramp and on the
/// coast.
fn node_times(dynamics: &Dynamics, course: &BangCoastBang, angle: f64) -> Vec<f64> {
    let turns = 2 * parts_of(angle, 2.0 * longest_turn(dynamics), MAX_PAIRS);
    let coast = turns.max(MIN_COAST);
    let parts = course.parts();
    let counts = [RAMP.max(turns / 2 * 2), coast, RAMP.max(turns / 2 * 2)];
    let mut times = Vec::new();
    let mut begin = 0.0;
    for (length, count) in parts.into_iter().zip(counts) {
        if length > 0.0 {
            times.extend((1..=count).map(|i| begin + length * i as f64 / count as f64));
            begin += length;
        }
    }
    times
}

/// The longest turn over an interval, rad, on which a rate strays little.
fn longest_turn(dynamics: &Dynamics) -> f64 {
    (8.0 * 0.5 * STRAY / dynamics.straying())
        .sqrt()
        .min(MAX_TURN)
}
