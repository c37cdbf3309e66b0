//! The first starting guess: the shortest turn within a box of rates, ramped.
//!
//! Without inertia the fastest motion to an attitude consists of arcs at constant rates, and
//! [`RateBox::query`] finds it exactly. It has the shape of a near-optimal leg, off-axis excursions
//! and the better way round included, which a local solver does not find from the eigenaxis slew (a
//! symmetric stationary point). Where a rate jumps the wheels need time: the guess takes the mean
//! rate over the last ramp, so it begins and ends at rest and lasts one ramp longer. Its rate is
//! linear between the beginnings and ends of the ramps, where its nodes are.

use super::LegProblem;
use crate::bounds::kinematic::{RateArc, RateBox};
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use crate::model::dynamics::{Dynamics, along};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Relative accuracy of the least times: far below the effect of the ramps.
const TOLERANCE: f64 = 1e-4;
/// Nodes nearer to each other than this share of the duration are one.
const SAME_TIME: f64 = 1e-3;
/// Relative difference above which one length is longer than another; below it rounding decides,
/// and the first is chosen.
const LONGER: f64 = 1e-6;
/// Turn between an attitude and its target, rad, above which their quaternion signs differ.
const OTHER_SIGN: f64 = 1.0;

/// The part of the guesses that depends on the spacecraft alone, not on its momentum.
#[derive(Debug)]
pub(crate) struct KinematicExtremals {
    /// The axes of the box as columns, in body axes.
    axes: Matrix3<f64>,
    /// The greatest rates about them, rad/s.
    rates: Vector3<f64>,
    /// The time to reach them all, s.
    ramp: f64,
    /// Built when it is first needed, which takes milliseconds; `None` for extreme rates.
    table: OnceLock<Option<RateBox>>,
}

/// Arcs of constant rate, and the time over which its jumps are spread, s.
struct Ramped {
    arcs: Vec<RateArc>,
    ramp: f64,
}

impl KinematicExtremals {
    /// Those of a spacecraft.
    pub(crate) fn of(dynamics: &Dynamics) -> Self {
        let axes = dynamics.natural_axes();
        let accelerations = along(&axes, |axis| dynamics.axis_acceleration(axis));
        // No faster than a bang-bang about half a turn, where nothing limits the rates.
        let peaks = accelerations.map(|acceleration| (acceleration * PI).sqrt());
        let rates = along(&axes, |axis| dynamics.axis_rate(axis)).inf(&peaks);
        Self {
            axes,
            rates,
            ramp: rates.component_div(&accelerations).max(),
            table: OnceLock::new(),
        }
    }

    /// The guess for a leg; `None` where the extremal leads to the other sign of the quaternion, or
    /// there is none: no turn at all, or extreme rates.
    pub(super) fn guess(&self, leg: &LegProblem<'_>) -> Option<Profile> {
        let turn = leg.from.attitude.turn_to(&leg.to.attitude);
        let guess = self.ramped(&turn)?.lasting(leg.least_duration());
        let guess = guess.sampled(leg);
        let last = guess.attitudes.last()?;
        let arrived = leg.arrival.turn(last, &leg.to.attitude) < OTHER_SIGN;
        arrived.then_some(guess)
    }

    /// Duration of the guess for a turn in body axes, s.
    pub(crate) fn duration_s(&self, turn: &Attitude) -> Option<f64> {
        let ramped = self.ramped(turn)?;
        let arcs = ramped.arcs.iter().map(|arc| arc.duration_s);
        Some(arcs.sum::<f64>() + ramped.ramp)
    }

    /// The extremal of a turn in body axes.
    fn ramped(&self, turn: &Attitude) -> Option<Ramped> {
        let table = self
            .table
            .get_or_init(|| RateBox::new(self.rates))
            .as_ref()?;
        let shortest = table.query(&turn.seen_from(&self.axes)?, TOLERANCE);
        if shortest.upper_s == 0.0 {
            return None;
        }
        // A short leg never reaches the greatest rates: it lasts 2 sqrt(ramp V), half of it a ramp.
        let slower = (self.ramp / shortest.upper_s).sqrt().max(1.0);
        let slowed = |arc: RateArc| RateArc {
            rate_rad_s: self.axes * arc.rate_rad_s / slower,
            duration_s: arc.duration_s * slower,
        };
        Some(Ramped {
            arcs: shortest.arcs.into_iter().map(slowed).collect(),
            ramp: self.ramp / slower,
        })
    }
}

impl Ramped {
    /// The same motion, slowed down to a least duration, s.
    fn lasting(mut self, least: f64) -> Self {
        let arcs: f64 = self.arcs.iter().map(|arc| arc.duration_s).sum();
        let slower = least / (arcs + self.ramp);
        if slower > 1.0 {
            self.ramp *= slower;
            for arc in &mut self.arcs {
                arc.duration_s *= slower;
                arc.rate_rad_s /= slower;
            }
        }
        self
    }

    /// The motion at its nodes.
    fn sampled(&self, leg: &LegProblem<'_>) -> Profile {
        let times = self.node_times(leg.intervals());
        let mut profile = Profile::empty();
        for time in &times {
            let rate = (self.turned(*time) - self.turned(time - self.ramp)) / self.ramp;
            let attitude = self.attitude(&leg.from.attitude, time - 0.5 * self.ramp);
            profile
                .wheels
                .push(leg.dynamics.wheels_at(&attitude, &rate, leg.null));
            profile.attitudes.push(attitude);
        }
        profile.lengths = times.windows(2).map(|t| t[1] - t[0]).collect();
        profile
    }

    /// Times of the nodes, s: where ramps begin and end as far as there are intervals for them, the
    /// longest intervals cut where there are more.
    fn node_times(&self, intervals: usize) -> Vec<f64> {
        let cuts = self.ramp_ends(intervals);
        let part = |(cut, count): (&[f64], &usize)| (cut[1] - cut[0]) / *count as f64;
        let mut counts = vec![1_usize; cuts.len() - 1];
        for _ in counts.iter().sum::<usize>()..intervals {
            let longest = first_longest(cuts.windows(2).zip(&counts).map(part));
            counts[longest] += 1;
        }
        let mut times = vec![0.0];
        for (cut, count) in cuts.windows(2).zip(&counts) {
            let part = part((cut, count));
            times.extend((1..*count).map(|i| cut[0] + part * i as f64));
            times.push(cut[1]);
        }
        times
    }

    /// Times at which ramps begin or end, s, from zero to the duration; the shortest pairs of
    /// intervals are joined until at most `most` are left.
    fn ramp_ends(&self, most: usize) -> Vec<f64> {
        let mut time = 0.0;
        let mut ends = vec![0.0, self.ramp];
        for arc in &self.arcs {
            time += arc.duration_s;
            ends.extend([time, time + self.ramp]);
        }
        ends.sort_by(f64::total_cmp);
        let duration = time + self.ramp;
        ends.dedup_by(|later, earlier| *later - *earlier < SAME_TIME * duration);
        while ends.len() - 1 > most {
            let joined = ends.windows(3).map(|ends| (ends[2] - ends[0]).recip());
            ends.remove(1 + first_longest(joined));
        }
        if let Some(last) = ends.last_mut() {
            *last = duration;
        }
        ends
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
            let length = arc.duration_s.min(*left);
            *left -= length;
            (length > 0.0).then_some((arc.rate_rad_s, length))
        })
    }
}

/// The position of the largest of some positive numbers.
fn first_longest(lengths: impl Iterator<Item = f64>) -> usize {
    let mut longest = (0, 0.0);
    for (i, length) in lengths.enumerate() {
        if length > longest.1 * (1.0 + LONGER) {
            longest = (i, length);
        }
    }
    longest.0
}
