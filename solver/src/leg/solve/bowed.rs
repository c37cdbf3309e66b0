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
use super::eigenaxis::Perturbation;
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use std::f64::consts::PI;

/// Angle of the bow as a share of the turn, and the largest turn, rad, that counts.
const BOW: f64 = 0.8;
const MAX_TURN: f64 = 1.5;
/// Duration relative to that of the eigenaxis slew.
const SLOWER: f64 = 1.2;
/// Shares of the duration at which motions are compared.
const COMPARED: [f64; 3] = [0.25, 0.5, 0.75];

/// A motion bowed to one side, at nodes that are evenly spaced in time.
pub(super) fn bowed(leg: &LegProblem<'_>, intervals: usize, side: Perturbation) -> Profile {
    let slew = leg.eigenaxis().lasting(leg.least_duration());
    let (turn, aside, fastest) = slew.geometry(leg.dynamics);
    let bow = aside * (side.sign() * BOW * turn.norm().min(MAX_TURN));
    let duration = SLOWER * fastest;
    let mut profile = Profile::empty();
    for node in 0..=intervals {
        let share = node as f64 / intervals as f64;
        let moved = share * share * (3.0 - 2.0 * share);
        // Exactly zero at both ends.
        let speed = 6.0 * share * (1.0 - share) / duration;
        let (sin, cos) = (PI * moved).sin_cos();
        let bend = Attitude::from_rotation_vector(bow * sin);
        let attitude = leg.from.attitude.retract(turn * moved).then_in_body(&bend);
        let rate = (bend.to_body(turn) + bow * (PI * cos)) * speed;
        let wheels = leg.dynamics.wheels_at(&attitude, &rate, leg.null);
        profile.wheels.push(wheels);
        profile.attitudes.push(attitude);
    }
    profile.lengths = vec![duration / intervals as f64; intervals];
    profile
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
