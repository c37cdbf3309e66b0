//! Ways around cones: paths of attitudes, pushed out of the cones that they enter.
//!
//! A path is pushed out of a cone by moving the boresight to the cone's surface, where it runs around
//! the axis to one side or the other from where it entered to where it leaves. The body turns with
//! the boresight by the smallest rotation, so that the rest of the attitude changes little.

pub(crate) mod guess;

use crate::leg::clear_path::least_clearance;
use crate::math::rounding::parts_of;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};
use std::slice;

/// Clearance, rad, of a path that was pushed out, where there is room.
const MARGIN: f64 = 0.03;
/// Longest step of a path, rad, and the most steps of half a turn and less.
const STEP: f64 = 0.05;
const MAX_STEPS: usize = 130;
/// Share of a way around a cone over which an end inside the margin reaches it.
const RISE: f64 = 0.25;
/// Depth, rad, that rounding leaves on a surface.
const TOUCH: f64 = 1e-12;
/// Turn, rad, by which attitudes of the same path differ at most.
const SAME_TURN: f64 = 1e-9;
/// Times that all cones are visited: leaving one may lead into another.
const ROUNDS: usize = 4;

/// To which side of a cone a path is pushed, seen along its axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Where the way around is shorter.
    Shorter,
    /// Where it is longer.
    Longer,
}

/// Attitudes with steps that are not long, from one end to the other.
#[derive(Debug, Clone)]
pub(crate) struct AttitudePath {
    attitudes: Vec<Attitude>,
}

impl AttitudePath {
    /// The path through attitudes, with their signs made continuous and points between where steps
    /// are long.
    pub(crate) fn through(attitudes: impl IntoIterator<Item = Attitude>) -> Self {
        let mut path: Vec<Attitude> = Vec::new();
        for attitude in attitudes {
            let Some(last) = path.last().copied() else {
                path.push(attitude);
                continue;
            };
            let next = attitude.nearest_sign(&last);
            let turn = last.signed_turn_to(&next);
            let steps = parts_of(turn.norm(), STEP, MAX_STEPS).max(1);
            for step in 1..steps {
                path.push(last.retract(turn * (step as f64 / steps as f64)));
            }
            path.push(next);
        }
        Self { attitudes: path }
    }

    /// The attitudes.
    pub(crate) fn attitudes(&self) -> &[Attitude] {
        &self.attitudes
    }

    /// Greatest depth, rad, inside any of these cones, between the attitudes too: a narrow cone fits
    /// there.
    pub(crate) fn depth(&self, cones: &[ForbiddenCone]) -> f64 {
        -least_clearance(cones, &self.attitudes)
    }

    /// Greatest depth, rad, inside a cone.
    pub(crate) fn depth_in(&self, cone: &ForbiddenCone) -> f64 {
        self.depth(slice::from_ref(cone))
    }

    /// Whether this is the same path as another.
    pub(crate) fn is(&self, other: &Self) -> bool {
        let pairs = || self.attitudes.iter().zip(&other.attitudes);
        self.attitudes.len() == other.attitudes.len()
            && pairs().all(|(one, other)| one.signed_turn_to(other).norm() <= SAME_TURN)
    }

    /// The path pushed out of cones, one after the other, each to the side given with it; `None`
    /// where some cone is still entered in the end.
    pub(crate) fn pushed_out(&self, passed: &[(ForbiddenCone, Side)]) -> Option<Self> {
        let mut path = self.clone();
        for _ in 0..ROUNDS {
            for (cone, side) in passed {
                if path.depth_in(cone) > TOUCH {
                    path = path.pushed_out_of(cone, *side);
                }
            }
            if passed.iter().all(|(cone, _)| path.depth_in(cone) <= TOUCH) {
                return Some(path);
            }
        }
        None
    }

    fn pushed_out_of(&self, cone: &ForbiddenCone, side: Side) -> Self {
        let mut attitudes = self.attitudes.clone();
        let last = attitudes.len() - 1;
        let within: Vec<bool> = self
            .attitudes
            .iter()
            .map(|attitude| cone.depth(attitude) > -MARGIN)
            .collect();
        let mut next = 0;
        while let Some(first) = (next..=last).find(|i| within[*i]) {
            let beyond = (first..=last).find(|i| !within[*i]).unwrap_or(last + 1);
            let run = first.saturating_sub(1)..=beyond.min(last);
            let deepest = self.attitudes[run.clone()].iter();
            if deepest.map(|q| cone.depth(q)).fold(f64::MIN, f64::max) > 0.0 {
                lead_around(&mut attitudes[run], cone, side);
            }
            next = beyond;
        }
        Self::through(attitudes)
    }
}

/// Leads the boresight around a cone from the first to the last of these attitudes, which stay.
fn lead_around(attitudes: &mut [Attitude], cone: &ForbiddenCone, side: Side) {
    let frame = SurfaceFrame::of(cone);
    let [from, to] = [attitudes.first(), attitudes.last()]
        .map(|q| q.map(|q| frame.coordinates(&q.to_reference(cone.axis))));
    let (Some(from), Some(to)) = (from, to) else {
        return;
    };
    let ahead = (to[1] - from[1]).rem_euclid(TAU);
    let shorter = if ahead <= PI { ahead } else { ahead - TAU };
    let around = match side {
        Side::Shorter => shorter,
        Side::Longer => shorter - TAU.copysign(shorter),
    };
    let surface = (cone.half_angle + MARGIN).min(PI);
    let steps = (attitudes.len() - 1) as f64;
    for (i, attitude) in attitudes.iter_mut().enumerate() {
        let share = i as f64 / steps;
        if share <= 0.0 || share >= 1.0 {
            continue;
        }
        let rise = |end: f64, share: f64| end + (surface - end) * (share / RISE).min(1.0);
        let polar = rise(from[0], share).min(rise(to[0], 1.0 - share));
        let wanted = frame.direction(polar, from[1] + share * around);
        let boresight = attitude.to_reference(cone.axis);
        let turn = attitude.to_body(smallest_rotation(&boresight, &wanted));
        *attitude = attitude.retract(turn);
    }
}

/// Polar coordinates around the axis of a cone.
struct SurfaceFrame {
    axis: Vector3<f64>,
    across: [Vector3<f64>; 2],
}

impl SurfaceFrame {
    fn of(cone: &ForbiddenCone) -> Self {
        let axis = cone.direction;
        let first = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
        Self {
            axis,
            across: [first, axis.cross(&first)],
        }
    }

    /// Angle from the axis, and around it, rad.
    fn coordinates(&self, direction: &Vector3<f64>) -> [f64; 2] {
        let [x, y] = self.across.map(|across| across.dot(direction));
        [x.hypot(y).atan2(self.axis.dot(direction)), y.atan2(x)]
    }

    fn direction(&self, polar: f64, azimuth: f64) -> Vector3<f64> {
        let across = self.across[0] * azimuth.cos() + self.across[1] * azimuth.sin();
        self.axis * polar.cos() + across * polar.sin()
    }
}

/// Rotation vector of the smallest rotation from one unit vector to another.
fn smallest_rotation(from: &Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
    let across = from.cross(to);
    let sine = across.norm();
    let angle = sine.atan2(from.dot(to));
    if sine > 0.0 {
        across * (angle / sine)
    } else {
        // No rotation, or half a turn about any axis across.
        from.cross(&Vector3::ith(from.iamin(), 1.0)).normalize() * angle
    }
}

#[cfg(test)]
mod tests;
