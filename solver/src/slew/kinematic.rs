//! Starting guesses from the kinematic problem: rates within a box, no inertia.
//!
//! The extremals of `R' = R S(w)`, `|w_i| <= r_i`, follow `w_i = r_i sign(M_i)` with the costate
//! `M' = M x w`, a vector fixed in space: a family with three parameters, the direction of `M` and
//! the time. Between sign changes the turn has a constant axis, so the closest approach to the
//! target on every arc is known in closed form. A coarse set of directions, refined a little where
//! it pays, finds the shape of near-optimal motions, off-axis excursions and the better way round
//! included, which the eigenaxis slew (a symmetric stationary point) hides from a local solver.

use super::SlewProblem;
use crate::attitude::Attitude;
use crate::dynamics::Dynamics;
use crate::kinematics::{Quat, imaginary, product, quat};
use crate::profile::Profile;
use nalgebra::{Matrix3, Vector3};

/// Costate directions tried first: about 12 degrees apart.
const DIRECTIONS: usize = 300;
/// Rounds of halving the search step around the best directions, from this step, rad.
const REFINEMENTS: usize = 7;
const FIRST_STEP: f64 = 0.12;
/// Most arcs of an extremal.
const MAX_ARCS: usize = 16;

/// Which quaternion signs of the target count as arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrival {
    /// Either sign.
    Rotation,
    /// The sign as given.
    Quaternion,
}

impl Arrival {
    /// The attitude with the sign to arrive at from near another one.
    pub(crate) fn signed(self, attitude: &Attitude, near: &Attitude) -> Attitude {
        match self {
            Self::Rotation => attitude.nearest_sign(near),
            Self::Quaternion => *attitude,
        }
    }

    /// The turn between two attitudes as far as signs count, rad.
    pub(crate) fn turn(self, from: &Attitude, to: &Attitude) -> f64 {
        from.signed_turn_to(&self.signed(to, from)).norm()
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Arc {
    rate: Vector3<f64>,
    length: f64,
}

/// An extremal up to its closest approach to the target.
#[derive(Debug, Clone)]
struct Extremal {
    costate: Vector3<f64>,
    arcs: Vec<Arc>,
    /// Time of the approach plus the time that certainly covers the miss, s.
    score: f64,
}

/// The kinematic problem of one slew.
struct Search {
    box_rates: Vector3<f64>,
    target: Quat,
    arrival: Arrival,
}

/// Guesses for a slew, best first, at most `count`, with different sequences of rate signs.
pub(super) fn guesses(slew: &SlewProblem<'_>, intervals: usize, count: usize) -> Vec<Profile> {
    let (from, to) = (&slew.from.attitude, &slew.to.attitude);
    let axes = slew.dynamics.natural_axes();
    let (box_rates, ramp) = box_of(slew.dynamics, &axes, from.signed_turn_to(to).norm());
    let target = from.relative_to(to).xyzw();
    let search = Search {
        box_rates,
        target: quat(&axes.tr_mul(&imaginary(&target)), target[3]),
        arrival: slew.arrival,
    };
    let mut chosen: Vec<Extremal> = Vec::new();
    for extremal in search.ranked() {
        if chosen.len() == count {
            break;
        }
        let refined = search.refine(extremal);
        if chosen.iter().all(|other| other.word() != refined.word()) {
            chosen.push(refined);
        }
    }
    chosen.sort_by(|a, b| a.score.total_cmp(&b.score));
    chosen
        .iter()
        .map(|extremal| extremal.in_body_axes(&axes).guess(slew, ramp, intervals))
        .collect()
}

/// Rates that the wheels can give about each of some axes, rad/s, and the time to reach them, s.
fn box_of(dynamics: &Dynamics, axes: &Matrix3<f64>, angle: f64) -> (Vector3<f64>, f64) {
    let mut rates = Vector3::zeros();
    let mut ramp = 0.0_f64;
    for i in 0..3 {
        let axis = axes.column(i).into_owned();
        let acceleration = dynamics.axis_acceleration(&axis);
        // A short slew never reaches its top rate: then the peak of a bang-bang is the scale.
        rates[i] = dynamics.axis_rate(&axis).min((acceleration * angle).sqrt());
        ramp = ramp.max(rates[i] / acceleration);
    }
    (rates, ramp)
}

impl Search {
    /// Extremals from all directions, best first.
    fn ranked(&self) -> Vec<Extremal> {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let mut all: Vec<Extremal> = (0..DIRECTIONS)
            .map(|i| {
                let z = 1.0 - (2 * i + 1) as f64 / DIRECTIONS as f64;
                let (radius, azimuth) = ((1.0 - z * z).sqrt(), golden * i as f64);
                self.shoot(Vector3::new(
                    radius * azimuth.cos(),
                    radius * azimuth.sin(),
                    z,
                ))
            })
            .collect();
        all.sort_by(|a, b| a.score.total_cmp(&b.score));
        all
    }

    /// Moves the costate downhill by shrinking steps.
    fn refine(&self, mut best: Extremal) -> Extremal {
        let mut step = FIRST_STEP;
        for _ in 0..REFINEMENTS {
            let side = best
                .costate
                .cross(&Vector3::ith(best.costate.iamin(), 1.0))
                .normalize();
            let up = best.costate.cross(&side);
            let costate = best.costate;
            for i in 0..8 {
                let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos();
                let trial = self.shoot((costate + (side * cos + up * sin) * step).normalize());
                if trial.score < best.score {
                    best = trial;
                }
            }
            step *= 0.5;
        }
        best
    }

    /// Follows the extremal of a costate to its closest approach.
    fn shoot(&self, costate: Vector3<f64>) -> Extremal {
        let mut best = Extremal {
            costate,
            arcs: Vec::new(),
            score: f64::INFINITY,
        };
        let slowest = self.box_rates.min();
        let (mut q, mut m, mut time) = ([0.0, 0.0, 0.0, 1.0], costate, 0.0);
        let mut signs = m.map(|c| if c < 0.0 { -1.0 } else { 1.0 });
        let mut arcs: Vec<Arc> = Vec::with_capacity(MAX_ARCS);
        for _ in 0..MAX_ARCS {
            let rate = signs.component_mul(&self.box_rates);
            let speed = rate.norm();
            let axis = rate / speed;
            let (flip, turn) = first_sign_change(&axis, &m, &signs);
            let (at, alignment) = self.closest(&q, &axis, turn);
            let miss = 2.0 * self.nearness(alignment).clamp(-1.0, 1.0).acos();
            let score = time + at / speed + miss / slowest;
            if score < best.score {
                best.score = score;
                best.arcs.clone_from(&arcs);
                best.arcs.push(Arc {
                    rate,
                    length: at / speed,
                });
            }
            time += turn / speed;
            if time >= best.score {
                break;
            }
            arcs.push(Arc {
                rate,
                length: turn / speed,
            });
            q = product(&q, &quat(&(axis * (turn / 2.0).sin()), (turn / 2.0).cos()));
            m = rotated_back(&axis, turn, &m);
            match flip {
                Some(axis) => signs[axis] = -signs[axis],
                None => break,
            }
        }
        best
    }

    /// Scalar product with the target as far as its sign counts.
    fn nearness(&self, alignment: f64) -> f64 {
        match self.arrival {
            Arrival::Rotation => alignment.abs(),
            Arrival::Quaternion => alignment,
        }
    }

    /// Turn angle on an arc at which the target is closest, with the scalar product there.
    fn closest(&self, q: &Quat, axis: &Vector3<f64>, end: f64) -> (f64, f64) {
        let dot = |a: &Quat| a.iter().zip(&self.target).map(|(x, y)| x * y).sum::<f64>();
        let (a, b) = (dot(q), dot(&product(q, &quat(axis, 0.0))));
        let alignment = |x: f64| a * (x / 2.0).cos() + b * (x / 2.0).sin();
        let peak = 2.0 * b.atan2(a);
        let tau = std::f64::consts::TAU;
        let mut best = (0.0, alignment(0.0));
        for x in [end, peak, peak + tau, peak + 2.0 * tau] {
            if !(0.0..=end).contains(&x) {
                continue;
            }
            let value = alignment(x);
            if self.nearness(value) > self.nearness(best.1) + 1e-12 {
                best = (x, value);
            }
        }
        best
    }
}

/// `M` after a turn of the body about an axis: `M' = M x w`.
fn rotated_back(axis: &Vector3<f64>, turn: f64, m: &Vector3<f64>) -> Vector3<f64> {
    let along = axis * axis.dot(m);
    along + (m - along) * turn.cos() - axis.cross(m) * turn.sin()
}

/// The component of the costate that changes sign first, and the turn at which it does; a full
/// turn without any ends the extremal.
fn first_sign_change(
    axis: &Vector3<f64>,
    m: &Vector3<f64>,
    signs: &Vector3<f64>,
) -> (Option<usize>, f64) {
    let along = axis * axis.dot(m);
    let cosine = m - along;
    let sine = -axis.cross(m);
    let mut first = (None, std::f64::consts::TAU);
    for i in 0..3 {
        let amplitude = cosine[i].hypot(sine[i]);
        if amplitude <= along[i].abs() {
            continue;
        }
        let phase = sine[i].atan2(cosine[i]);
        let half = (-along[i] / amplitude).acos();
        // Leaving through zero means moving against the sign.
        let turn = (phase + half * signs[i]).rem_euclid(std::f64::consts::TAU);
        if turn < first.1 && turn > 1e-9 {
            first = (Some(i), turn);
        }
    }
    first
}

impl Extremal {
    /// The signs of the rates on its arcs.
    fn word(&self) -> Vec<[bool; 3]> {
        self.arcs
            .iter()
            .map(|arc| [0, 1, 2].map(|i| arc.rate[i] > 0.0))
            .collect()
    }

    /// The same with its rates in body axes instead of the search's.
    fn in_body_axes(&self, axes: &Matrix3<f64>) -> Self {
        let mut turned = self.clone();
        for arc in &mut turned.arcs {
            arc.rate = axes * arc.rate;
        }
        turned
    }

    /// The motion with its rate jumps spread over the time that the wheels need for them.
    fn guess(&self, slew: &SlewProblem<'_>, ramp: f64, intervals: usize) -> Profile {
        let duration = self.arcs.iter().map(|arc| arc.length).sum::<f64>() + ramp;
        let length = duration / intervals as f64;
        let mut profile = Profile::empty();
        for node in 0..=intervals {
            let time = length * node as f64;
            // Mean rate over the last ramp: zero at both ends, continuous between.
            let rate = (self.turned(time) - self.turned(time - ramp)) / ramp;
            let attitude = self.attitude(&slew.from.attitude, time - 0.5 * ramp);
            profile
                .wheels
                .push(slew.dynamics.wheels_at(&attitude, &rate, slew.null));
            profile.attitudes.push(attitude);
        }
        profile.lengths = vec![length; intervals];
        profile
    }

    /// Integral of the rates up to a time.
    fn turned(&self, time: f64) -> Vector3<f64> {
        self.clipped(time).map(|(rate, length)| rate * length).sum()
    }

    fn attitude(&self, from: &Attitude, time: f64) -> Attitude {
        self.clipped(time).fold(*from, |attitude, (rate, length)| {
            attitude.retract(rate * length)
        })
    }

    /// The arcs up to a time.
    fn clipped(&self, time: f64) -> impl Iterator<Item = (Vector3<f64>, f64)> + '_ {
        self.arcs.iter().scan(time, |left, arc| {
            let length = arc.length.min(*left);
            *left -= length;
            (length > 0.0).then_some((arc.rate, length))
        })
    }
}
