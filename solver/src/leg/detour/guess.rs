//! A motion along a path of attitudes, from rest to rest, as a starting guess.
//!
//! The pace is bang-coast-bang with the least acceleration and rate of all directions in which the
//! path turns. Nodes are even in time, and denser where a cone is near, so that intervals cannot
//! lead through it.

use super::AttitudePath;
use crate::leg::profile::Profile;
use crate::math::bang_coast_bang::BangCoastBang;
use crate::math::rounding::parts_of;
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use nalgebra::{DVector, Vector3};

/// Clearance, rad, below which a cone is near.
const NEAR: f64 = 0.2;
/// Longest turn over an interval near a cone, rad.
const SHORT_TURN: f64 = 0.06;
/// Most parts of an even interval.
const MAX_PARTS: usize = 40;
/// How much longer than in a guess an interval may become near a cone.
pub(crate) const GUESS_STRETCH: f64 = 1.4;
/// How much longer an interval may become where no cone is near.
const FAR_STRETCH: f64 = 3.0;

/// The motion along a path with this null-space momentum, N m s, of the wheels, and so many intervals
/// where no cone is near.
pub(crate) fn along(
    dynamics: &Dynamics,
    path: &AttitudePath,
    null: &DVector<f64>,
    intervals: usize,
) -> Profile {
    let track = Track::of(path);
    let (mut acceleration, mut rate) = (f64::INFINITY, f64::INFINITY);
    for turn in track.turns.iter().filter(|turn| turn.norm() > 0.0) {
        let axis = turn.normalize();
        acceleration = acceleration.min(dynamics.axis_acceleration(&axis));
        rate = rate.min(dynamics.axis_rate(&axis));
    }
    let course = BangCoastBang::fastest(track.length(), acceleration, rate);
    let mut profile = Profile::empty();
    let mut before = 0.0;
    for time in node_times(dynamics, &track, &course, intervals) {
        let (angle, rate, _) = course.at(time);
        let (attitude, direction) = track.at(angle);
        let rate = direction * rate;
        profile
            .wheels
            .push(dynamics.wheels_at(&attitude, &rate, null));
        profile.attitudes.push(attitude);
        if time > 0.0 {
            profile.lengths.push(time - before);
        }
        before = time;
    }
    profile
}

/// Longest lengths, s, of the intervals of a motion such that none leads through a cone; those near
/// one may become longer by this factor, or as long as a turn that is not long takes.
pub(crate) fn longest_intervals(dynamics: &Dynamics, profile: &Profile, stretch: f64) -> Vec<f64> {
    let mean = profile.duration() / profile.intervals() as f64;
    let mut longest = Vec::with_capacity(profile.intervals());
    for (pair, length) in profile.attitudes.windows(2).zip(&profile.lengths) {
        let near = pair.iter().any(|q| is_near(dynamics, q));
        let turn = pair[0].signed_turn_to(&pair[1]).norm();
        let for_turn = if turn > 0.0 {
            length * SHORT_TURN / turn
        } else {
            mean
        };
        longest.push(if near {
            stretch * length.max(for_turn.min(mean))
        } else {
            FAR_STRETCH * length.max(mean)
        });
    }
    longest
}

/// Duration, s, of a motion along a path at the mean pace of all directions in which it turns: what
/// its fastest neighbour takes, roughly.
pub(crate) fn expected_duration(dynamics: &Dynamics, path: &AttitudePath) -> f64 {
    let track = Track::of(path);
    let (mut slowness, mut length) = ([0.0; 2], 0.0);
    for turn in track.turns.iter().filter(|turn| turn.norm() > 0.0) {
        let (angle, axis) = (turn.norm(), turn.normalize());
        slowness[0] += angle / dynamics.axis_acceleration(&axis);
        slowness[1] += angle / dynamics.axis_rate(&axis);
        length += angle;
    }
    BangCoastBang::fastest(length, length / slowness[0], length / slowness[1]).duration()
}

fn is_near(dynamics: &Dynamics, attitude: &Attitude) -> bool {
    dynamics
        .cones
        .iter()
        .any(|cone| cone.depth(attitude) > -NEAR)
}

/// Times of the nodes, s: even, and more of them where the path is near a cone.
fn node_times(
    dynamics: &Dynamics,
    track: &Track,
    course: &BangCoastBang,
    intervals: usize,
) -> Vec<f64> {
    let even = course.duration() / intervals as f64;
    let mut times = vec![0.0];
    for i in 0..intervals {
        let (begin, end) = (even * i as f64, even * (i + 1) as f64);
        let [from, to] = [begin, end].map(|time| course.at(time).0);
        let inside = (0..=4).map(|part| track.at(from + (to - from) * f64::from(part) / 4.0).0);
        let near = inside.into_iter().any(|q| is_near(dynamics, &q));
        let parts = if near {
            parts_of(to - from, SHORT_TURN, MAX_PARTS).max(1)
        } else {
            1
        };
        for part in 1..=parts {
            times.push(begin + even * part as f64 / parts as f64);
        }
    }
    times
}

/// A path with the angle turned since its begin.
struct Track<'a> {
    attitudes: &'a [Attitude],
    turns: Vec<Vector3<f64>>,
    /// Angle at each attitude, rad.
    angles: Vec<f64>,
}

impl<'a> Track<'a> {
    fn of(path: &'a AttitudePath) -> Self {
        let attitudes = path.attitudes();
        let turns: Vec<_> = attitudes
            .windows(2)
            .map(|q| q[0].signed_turn_to(&q[1]))
            .collect();
        let mut angles = vec![0.0];
        for turn in &turns {
            angles.push(angles[angles.len() - 1] + turn.norm());
        }
        Self {
            attitudes,
            turns,
            angles,
        }
    }

    fn length(&self) -> f64 {
        self.angles[self.angles.len() - 1]
    }

    /// The attitude after an angle, rad, and the unit direction about which the path turns there.
    fn at(&self, angle: f64) -> (Attitude, Vector3<f64>) {
        let after = self.angles.partition_point(|at| *at <= angle);
        let step = after.clamp(1, self.turns.len()) - 1;
        let size = self.angles[step + 1] - self.angles[step];
        if size <= 0.0 {
            return (self.attitudes[step], Vector3::zeros());
        }
        let direction = self.turns[step] / size;
        let beyond = (angle - self.angles[step]).clamp(0.0, size);
        (self.attitudes[step].retract(direction * beyond), direction)
    }
}
