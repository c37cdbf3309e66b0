//! Motions bowed far to one side of the eigenaxis, by which legs with several minima are explored.
//!
//! From the eigenaxis slew a program reaches the minima nearby, and the kinematic extremal has the
//! shape that one box of rates prefers. Where the rates that the wheels reach are no box, the fastest
//! motion may lead elsewhere: away from the eigenaxis to a side, and back. The motions here do so by
//! an angle of the size of the turn itself,
//!
//! ```text
//!   q(s) = exp(m x) exp(b sin(pi m)),    m = s^2 (3 - 2 s),    b across the turn x
//! ```
//!
//! and begin and end at rest.

use super::LegProblem;
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Angle of the bow as a share of the turn, and the largest turn, rad, that counts.
const BOW: f64 = 0.8;
const MAX_TURN: f64 = 1.5;
/// The long way round is explored up to so many times the turn of the short one, and bowed by so much, rad, to
/// either side.
const LONGEST_WAY: f64 = 4.0;
const LONG_BOW: f64 = 0.5;
/// Shares of the duration at which motions are compared.
const COMPARED: [f64; 3] = [0.25, 0.5, 0.75];

/// A way that is bowed to one side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bow {
    /// The turn as a whole, rad, body axes at its beginning.
    turn: Vector3<f64>,
    /// By how much it is bowed, rad, across the turn.
    aside: Vector3<f64>,
}

impl Bow {
    /// The ways of a leg that are explored: bowed to four sides, and the long way round, where that may be faster.
    pub(super) fn around(leg: &LegProblem<'_>) -> Vec<Self> {
        let (turn, aside) = leg.eigenaxis().geometry(leg.dynamics);
        let angle = turn.norm();
        let other = turn.normalize().cross(&aside);
        let size = BOW * angle.min(MAX_TURN);
        let mut ways = [-aside, aside, -other, other]
            .map(|side| Self {
                turn,
                aside: side * size,
            })
            .to_vec();
        if leg.may_go_the_long_way() && TAU - angle <= LONGEST_WAY * angle {
            ways.extend([LONG_BOW, -LONG_BOW].map(|size| Self {
                turn: turn * (1.0 - TAU / angle),
                aside: aside * size,
            }));
        }
        ways
    }

    /// The motion along the way in a duration, s, at nodes that are evenly spaced in time.
    pub(super) fn motion(&self, leg: &LegProblem<'_>, intervals: usize, duration: f64) -> Profile {
        let duration = duration.max(leg.least_duration());
        let mut profile = Profile::empty();
        for node in 0..=intervals {
            let share = node as f64 / intervals as f64;
            let moved = share * share * (3.0 - 2.0 * share);
            // Exactly zero at both ends.
            let speed = 6.0 * share * (1.0 - share) / duration;
            let (sin, cos) = (PI * moved).sin_cos();
            let bend = Attitude::from_rotation_vector(self.aside * sin);
            let along = leg.from.attitude.retract(self.turn * moved);
            let attitude = along.then_in_body(&bend);
            let rate = (bend.to_body(self.turn) + self.aside * (PI * cos)) * speed;
            let wheels = leg.dynamics.wheels_at(&attitude, &rate, leg.null);
            profile.wheels.push(wheels);
            profile.attitudes.push(attitude);
        }
        profile.lengths = vec![duration / intervals as f64; intervals];
        profile
    }
}

/// How far the ways of two motions with the same beginning are apart: the largest angle between their
/// attitudes at the same shares of their durations, relative to their largest turns there.
pub(super) fn apart(one: &Profile, other: &Profile) -> f64 {
    let (mut apart, mut turned) = (0.0, 0.0);
    for share in COMPARED {
        let [here, there] = [one, other].map(|motion| attitude_at(motion, share));
        let (Some(here), Some(there), Some(first)) = (here, there, one.attitudes.first()) else {
            return f64::INFINITY;
        };
        apart = f64::max(apart, here.angle_to(&there));
        turned = f64::max(turned, here.angle_to(first).max(there.angle_to(first)));
    }
    if turned > 0.0 { apart / turned } else { 0.0 }
}

/// The attitude after a share of the duration, on the way from node to node.
fn attitude_at(motion: &Profile, share: f64) -> Option<Attitude> {
    let mut left = share * motion.duration();
    for (ends, length) in motion.attitudes.windows(2).zip(&motion.lengths) {
        if left <= *length {
            let turn = ends[0].signed_turn_to(&ends[1]);
            let part = if *length > 0.0 { left / length } else { 0.0 };
            return Some(ends[0].retract(turn * part));
        }
        left -= length;
    }
    motion.attitudes.last().copied()
}

#[cfg(test)]
mod tests;
