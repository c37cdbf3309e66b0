//! Rolls all over their range, and an estimate of the slews between them.

use crate::math::bang_coast_bang::BangCoastBang;
use crate::math::rounding::parts_of;
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use crate::model::roll::RollArcs;
use crate::model::waypoint::Waypoint;
use std::f64::consts::TAU;

/// Rolls where every one is admissible.
const ALL_AROUND: usize = 24;

/// A waypoint, described from rolls all over its arcs; once where the roll is given.
pub(super) struct Grid {
    pub(super) waypoints: Vec<Waypoint>,
    /// Whether the last roll is beside the first.
    is_closed: bool,
}

impl Grid {
    pub(super) fn of(end: &Waypoint) -> Self {
        let all_around = |i: usize| TAU * i as f64 / ALL_AROUND as f64;
        let (rolls, is_closed): (Vec<f64>, bool) = match &end.roll {
            None => (vec![0.0], false),
            Some(RollArcs { arcs, .. }) if arcs.is_empty() => {
                ((0..ALL_AROUND).map(all_around).collect(), true)
            }
            Some(RollArcs { arcs, .. }) => {
                let along = |[least, greatest]: &[f64; 2]| {
                    let (least, width) = (*least, greatest - least);
                    let parts = parts_of(width, all_around(1), ALL_AROUND).max(1);
                    (0..=parts).map(move |i| least + width * i as f64 / parts as f64)
                };
                (arcs.iter().flat_map(along).collect(), false)
            }
        };
        Self {
            waypoints: rolls.into_iter().map(|roll| end.rolled(roll)).collect(),
            is_closed,
        }
    }

    /// Durations, s, of the slews about the eigenaxis from every roll to every roll of another waypoint.
    pub(super) fn durations_to(&self, to: &Self, dynamics: &Dynamics) -> Vec<Vec<f64>> {
        let row = |from: &Waypoint| {
            let leg = |to: &Waypoint| eigenaxis_s(dynamics, &from.attitude, &to.attitude);
            to.waypoints.iter().map(leg).collect()
        };
        self.waypoints.iter().map(row).collect()
    }

    /// A roll and its neighbours, by their numbers.
    pub(super) fn around(&self, at: usize) -> impl Iterator<Item = usize> + '_ {
        let count = self.waypoints.len();
        let beside = [at + count - 1, at + count, at + count + 1].into_iter();
        beside.filter_map(move |at| {
            let inside = (count..2 * count).contains(&at);
            (self.is_closed || inside).then_some(at % count)
        })
    }
}

/// Duration, s, of the slew about the eigenaxis from rest to rest without stored momentum.
fn eigenaxis_s(dynamics: &Dynamics, from: &Attitude, to: &Attitude) -> f64 {
    let turn = from.signed_turn_to(&to.nearest_sign(from));
    let angle = turn.norm();
    if angle == 0.0 {
        return 0.0;
    }
    let axis = turn / angle;
    let (acceleration, rate) = (dynamics.axis_acceleration(&axis), dynamics.axis_rate(&axis));
    BangCoastBang::fastest(angle, acceleration, rate).duration()
}
