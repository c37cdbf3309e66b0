//! Problems with known answers whose elapsed time, effort and interval length are states.
//!
//! A cart of unit mass goes from rest at zero to rest at one under piecewise constant acceleration.

use super::TIGHT;
use crate::nlp::NlpReport;
use crate::nlp::{Chain, InteriorPoint, Iterate, Link, LinkModel, LinkMultipliers, LinkValues};

/// Least length of a free interval: an interval of no length has no determined acceleration, and
/// the journey with one interval less is then another stationary point.
const SHORTEST: f64 = 0.01;

/// The quantity that a [`Metered`] journey minimises, the other one being given.
#[derive(Clone, Copy)]
pub(crate) enum Least {
    /// The effort `sum a^2 tau`; the journey takes exactly this long.
    EffortWithin(f64),
    /// The duration; the effort is at most this.
    TimeWith(f64),
}

/// Free interval lengths, with elapsed time and effort so far as states:
/// `x = (place, speed, time, effort)`, `v = (a, tau)`.
pub(crate) struct Metered {
    pub(crate) least: Least,
    pub(crate) intervals: usize,
}

/// The common interval length of a [`Sampled`] journey.
#[derive(Clone, Copy)]
pub(crate) enum Period {
    /// Unknown: the duration is minimised with `|a| <= 1`.
    Free,
    /// Given: the effort is minimised.
    Given(f64),
}

/// Equal interval lengths, carried from node to node as a state: `x = (place, speed, length)`,
/// `v = a`.
pub(crate) struct Sampled {
    pub(crate) period: Period,
    pub(crate) intervals: usize,
    /// How often the condition on the place at the end is stated.
    pub(crate) repeats: usize,
}

impl Metered {
    /// A start that leaves all links open.
    pub(crate) fn guess(&self) -> Iterate {
        let share = 1.0 / self.intervals as f64;
        let points = (0..=self.intervals).flat_map(|k| [k as f64 * share, 0.0, 0.0, 0.0]);
        let controls = (0..self.intervals).flat_map(|k| [0.5, share * (1.0 + 0.1 * k as f64)]);
        Iterate::cold(points.collect(), controls.collect())
    }

    /// Effort of the best `n` constant accelerations in a time: the least distance from the
    /// straight line `6 (1 - 2 t)` that is best without sampling.
    pub(crate) fn least_effort(intervals: usize, time: f64) -> f64 {
        12.0 / (time.powi(3) * (1.0 - (intervals as f64).powi(-2)))
    }
}

impl Sampled {
    /// A start that leaves all links open.
    pub(crate) fn guess(&self) -> Iterate {
        let share = 1.0 / self.intervals as f64;
        let points = (0..=self.intervals).flat_map(|k| [k as f64 * share, 0.0, share]);
        Iterate::cold(points.collect(), vec![0.1; self.intervals])
    }
}

/// Solves from a start with default settings.
pub(crate) fn solve<C: Chain>(chain: &C, mut iterate: Iterate) -> (NlpReport, Iterate) {
    let mut engine = InteriorPoint::new(chain, TIGHT);
    let report = engine.solve(chain, &mut iterate, &|| None);
    (report, iterate)
}

fn add(point: &[f64], step: &[f64], moved: &mut [f64]) {
    for ((out, value), by) in moved.iter_mut().zip(point).zip(step) {
        *out = value + by;
    }
}

impl Chain for Metered {
    fn intervals(&self) -> usize {
        self.intervals
    }

    fn point_len(&self) -> usize {
        4
    }

    fn state_dim(&self) -> usize {
        4
    }

    fn control_dim(&self) -> usize {
        2
    }

    fn equalities(&self, node: usize) -> usize {
        match self.least {
            _ if node == 0 => 4,
            Least::EffortWithin(_) if node == self.intervals => 3,
            Least::TimeWith(_) if node == self.intervals => 2,
            _ => 0,
        }
    }

    fn inequalities(&self, node: usize) -> usize {
        usize::from(node < self.intervals || matches!(self.least, Least::TimeWith(_)))
    }

    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]) {
        add(point, step, moved);
    }

    fn values(&self, link: &Link<'_>, out: &mut LinkValues) {
        let [place, speed, time, effort] = *link.point else {
            unreachable!("four states")
        };
        out.cost = 0.0;
        if let [a, tau] = *link.control {
            out.gap[0] = place + speed * tau + 0.5 * a * tau * tau - link.next[0];
            out.gap[1] = speed + a * tau - link.next[1];
            out.gap[2] = time + tau - link.next[2];
            out.gap[3] = effort + a * a * tau - link.next[3];
            out.inequality[0] = tau - SHORTEST;
            if link.node == 0 {
                out.equality.copy_from_slice(link.point);
            }
            return;
        }
        out.equality[0] = place - 1.0;
        out.equality[1] = speed;
        match self.least {
            Least::EffortWithin(duration) => {
                out.cost = effort;
                out.equality[2] = time - duration;
            }
            Least::TimeWith(most) => {
                out.cost = time;
                out.inequality[0] = most - effort;
            }
        }
    }

    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        for (i, row) in out.equality_jacobian.chunks_exact_mut(4).enumerate() {
            row[i] = 1.0;
        }
        if let [a, tau] = *link.control {
            let speed = link.point[1];
            let rows = [
                [1.0, tau, 0.0, 0.0, 0.5 * tau * tau, speed + a * tau],
                [0.0, 1.0, 0.0, 0.0, tau, a],
                [0.0, 0.0, 1.0, 0.0, 0.0, 1.0],
                [0.0, 0.0, 0.0, 1.0, 2.0 * a * tau, a * a],
            ];
            out.link_jacobian.copy_from_slice(rows.as_flattened());
            out.inequality_jacobian[5] = 1.0;
            let [place, speed, _, effort] = *duals.gap else {
                unreachable!("four states")
            };
            out.hessian[5 * 6 + 1] = place;
            out.hessian[4 * 6 + 4] = 2.0 * tau * effort;
            out.hessian[5 * 6 + 4] = place * tau + speed + 2.0 * a * effort;
            out.hessian[5 * 6 + 5] = place * a;
            return;
        }
        match self.least {
            Least::EffortWithin(_) => out.gradient[3] = 1.0,
            Least::TimeWith(_) => {
                out.gradient[2] = 1.0;
                out.inequality_jacobian[3] = -1.0;
            }
        }
    }
}

impl Chain for Sampled {
    fn intervals(&self) -> usize {
        self.intervals
    }

    fn point_len(&self) -> usize {
        3
    }

    fn state_dim(&self) -> usize {
        3
    }

    fn control_dim(&self) -> usize {
        1
    }

    fn equalities(&self, node: usize) -> usize {
        match self.period {
            Period::Given(_) if node == 0 => 3,
            Period::Free if node == 0 => 2,
            _ if node == self.intervals => 1 + self.repeats,
            _ => 0,
        }
    }

    fn inequalities(&self, node: usize) -> usize {
        match self.period {
            Period::Free if node < self.intervals => 3,
            _ => 0,
        }
    }

    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]) {
        add(point, step, moved);
    }

    fn values(&self, link: &Link<'_>, out: &mut LinkValues) {
        let [place, speed, length] = *link.point else {
            unreachable!("three states")
        };
        out.cost = 0.0;
        if let [a] = *link.control {
            out.gap[0] = place + speed * length + 0.5 * a * length * length - link.next[0];
            out.gap[1] = speed + a * length - link.next[1];
            out.gap[2] = length - link.next[2];
            match self.period {
                Period::Free => {
                    out.cost = length;
                    out.inequality.copy_from_slice(&[1.0 - a, 1.0 + a, length]);
                }
                Period::Given(_) => out.cost = a * a * length,
            }
        }
        if link.node == 0 {
            out.equality[0] = place;
            out.equality[1] = speed;
            if let Period::Given(period) = self.period {
                out.equality[2] = length - period;
            }
        } else if link.node == self.intervals {
            out.equality.fill(place - 1.0);
            out.equality[0] = speed;
        }
    }

    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        for (i, row) in out.equality_jacobian.chunks_exact_mut(3).enumerate() {
            let last = [1, 0][usize::from(i > 0)];
            row[if link.node == 0 { i } else { last }] = 1.0;
        }
        let [a] = *link.control else { return };
        let (speed, length) = (link.point[1], link.point[2]);
        let rows = [
            [1.0, length, speed + a * length, 0.5 * length * length],
            [0.0, 1.0, a, length],
            [0.0, 0.0, 1.0, 0.0],
        ];
        out.link_jacobian.copy_from_slice(rows.as_flattened());
        let (place, speed) = (duals.gap[0], duals.gap[1]);
        out.hessian[2 * 4 + 1] = place;
        out.hessian[2 * 4 + 2] = place * a;
        out.hessian[3 * 4 + 2] = place * length + speed;
        match self.period {
            Period::Free => {
                out.gradient[2] = 1.0;
                out.inequality_jacobian[3] = -1.0;
                out.inequality_jacobian[4 + 3] = 1.0;
                out.inequality_jacobian[8 + 2] = 1.0;
            }
            Period::Given(_) => {
                out.gradient[2] = a * a;
                out.gradient[3] = 2.0 * a * length;
                out.hessian[3 * 4 + 2] += 2.0 * a;
                out.hessian[3 * 4 + 3] = 2.0 * length;
            }
        }
    }
}
