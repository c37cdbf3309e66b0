//! Rate limits in the middle of intervals.
//!
//! Between nodes the wheel momenta are linear, but stored momentum turns in body axes and bends the
//! rates. Imposed at nodes alone a rate limit would be exceeded between them by
//! `|H| theta^2 / (8 J)` where the body turns by `theta`, and the program would exploit that: by
//! long intervals, and by rates about one axis that alternate from interval to interval. With the
//! middle limited too, the mean of a rate over an interval keeps its limit to that order. The rows
//! are multiplied by the length of the interval, `tau limit -+ W >= 0`, so that they stay regular
//! where it vanishes.

use super::Transcription;
use super::attitude_link::LinkTerms;
use super::rows::LimitRow;
use crate::nlp::{Chain, Link, LinkModel, MAX_CONTROLS, MAX_STATES};
use nalgebra::{Matrix3, Vector3};

/// Rate, in units of the limit of its norm, that rounds off the norm's corner at zero.
const CORNER: f64 = 1e-4;

/// The rate in the middle by each variable of the interval.
type Slopes = [Vector3<f64>; MAX_STATES + MAX_CONTROLS];

/// A rate limit in the middle of an interval.
#[derive(Debug, Clone)]
pub(super) struct MiddleRow {
    side: Side,
    limit: f64,
    /// Index among the shares of [`crate::model::dynamics::Dynamics::limit_shares`].
    share: usize,
}

/// The quantity of the rate `W` that is limited.
#[derive(Debug, Clone)]
enum Side {
    /// `limit tau + direction . W >= 0`.
    Along(Vector3<f64>),
    /// `limit tau - |W| / unit >= 0`, the norm rounded off at zero.
    Norm { unit: f64 },
}

impl Side {
    /// The summand beside `limit tau`, its derivative by `W`, and minus its second derivative.
    fn of(&self, rate: &Vector3<f64>) -> (f64, Vector3<f64>, Option<Matrix3<f64>>) {
        match self {
            Self::Along(direction) => (direction.dot(rate), *direction, None),
            Self::Norm { unit } => {
                let norm = rate.norm().hypot(CORNER * unit);
                let direction = rate / norm;
                let across = Matrix3::identity() - direction * direction.transpose();
                (
                    -norm / unit,
                    direction / -*unit,
                    Some(across / (norm * unit)),
                )
            }
        }
    }
}

impl Transcription {
    /// Number of rows in the middle of an interval.
    pub(crate) fn middle_limits(&self) -> usize {
        self.middle_rows.len()
    }

    /// The rows that belong to limits at nodes; none without momentum.
    pub(super) fn middle_rows_of(&self, limits: &[LimitRow]) -> Vec<MiddleRow> {
        if !self.dynamics.has_momentum() {
            return Vec::new();
        }
        let rates = self.wheels()..self.wheels() + 3;
        let limits = limits.iter().filter(|limit| rates.contains(&limit.share));
        let row = |limit: &LimitRow| {
            let direction = self.dynamics.inertia.tr_mul(&limit.row.momentum);
            MiddleRow {
                side: Side::Along(direction / self.scales.time),
                limit: limit.limit,
                share: limit.share,
            }
        };
        let most = self.dynamics.max_rate_norm;
        let norm = most.is_finite().then(|| MiddleRow {
            side: Side::Norm {
                unit: most * self.scales.time,
            },
            limit: 1.0,
            share: self.wheels() + 3,
        });
        limits.map(row).chain(norm).collect()
    }

    /// Whether the derivatives of rows depend on the rate.
    pub(super) fn bends_in_the_middle(&self) -> bool {
        let mut rows = self.middle_rows.iter();
        rows.any(|row| matches!(row.side, Side::Norm { .. }))
    }

    /// The rate in the middle of an interval, times its length, where it is limited.
    pub(super) fn middle_rate(&self, link: &Link<'_>) -> Vector3<f64> {
        if self.middle_rows.is_empty() {
            Vector3::zeros()
        } else {
            self.turn_map.middle(&self.turn_inputs(link))
        }
    }

    /// Values of the rows of one interval.
    pub(crate) fn middle_margins(&self, link: &Link<'_>) -> impl Iterator<Item = f64> {
        let rate = self.middle_rate(link);
        let tau = link.control[self.wheels()];
        let reserves = self.reserves.at(link.node);
        let rows = self.middle_rows.iter();
        rows.map(move |row| row.limit * (1.0 - reserves[row.share]) * tau + row.side.of(&rate).0)
    }

    /// The covector that weighs the rate in the middle in the Lagrangian: the rows' slopes times
    /// minus their multipliers.
    pub(super) fn middle_pull(&self, rate: &Vector3<f64>, z: &[f64]) -> Vector3<f64> {
        let rows = self.middle_rows.iter().zip(z);
        rows.map(|(row, z)| row.side.of(rate).1 * -z).sum()
    }

    /// Writes the derivatives of the rows with these multipliers, and adds their curvature beside
    /// that of the rate itself.
    pub(super) fn write_middle_rows(
        &self,
        terms: &LinkTerms<'_>,
        (node, first): (usize, usize),
        z: &[f64],
        out: &mut LinkModel,
    ) {
        if z.is_empty() {
            return;
        }
        let (vars, length) = (out.vars, self.state_dim() + self.wheels());
        let slopes = self.middle_slopes(terms);
        let reserves = self.reserves.at(node);
        for (i, (middle, z)) in self.middle_rows.iter().zip(z).enumerate() {
            let (_, direction, bend) = middle.side.of(&terms.middle_rate);
            let row = &mut out.inequality_jacobian[(first + i) * vars..][..vars];
            for (out, slope) in row.iter_mut().zip(&slopes) {
                *out = direction.dot(slope);
            }
            row[length] += middle.limit * (1.0 - reserves[middle.share]);
            if let Some(bend) = bend {
                for a in 0..vars {
                    let image = bend * slopes[a] * *z;
                    for b in 0..=a {
                        out.hessian[a * vars + b] += slopes[b].dot(&image);
                    }
                }
            }
        }
    }

    fn middle_slopes(&self, terms: &LinkTerms<'_>) -> Slopes {
        let (controls, tau) = (self.state_dim(), terms.tau);
        let [by_begin, by_end, by_momentum] = terms.middle;
        let mut slopes = [Vector3::zeros(); MAX_STATES + MAX_CONTROLS];
        let turned = by_momentum * terms.momentum.cross_matrix() * (tau * self.scales.angle);
        for axis in 0..3 {
            slopes[axis] = turned.column(axis).into_owned();
        }
        let (both, end) = ((by_begin + by_end) * -tau, by_end * -tau);
        for (i, gain) in self.rate_gain.iter().enumerate() {
            slopes[3 + i] = both * gain;
            slopes[controls + i] = end * gain;
        }
        slopes[controls + self.wheels()] =
            by_momentum * terms.momentum - by_begin * terms.begin - by_end * terms.end;
        slopes
    }
}
