//! The limits of the rates over the duration of a motion: linear between the kinks.

use super::form::{Form, VectorForm, each, long};
use super::rounded_box::{WAIST, box_supports, level_form};
use crate::bounds::interval::Interval;
use crate::bounds::kinematic::rate_envelope::RateEnvelope;
use nalgebra::Vector3;

/// Relative increase of the limits, far above the rounding of kinks and durations.
const RAISED: f64 = 1e-9;
/// Share of the duration below which two kinks are one: the limits between them are lower by much less than what they
/// are raised by.
const SAME: f64 = 1e-13;
/// Parts in which a ramp is followed.
const SHORT: u32 = 4;
/// Parts of a piece for the integral of the box norm.
const PARTS: u32 = 16;
/// Relative error allowed for the rounding of a sum of hundreds of terms.
const ROUNDING: f64 = 1e-9;

/// A piece between kinks, on which the limits change linearly.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// Its duration, s.
    pub(super) length: f64,
    /// Limits at its begin and end, rad/s.
    pub(super) limits: [[f64; 3]; 2],
}

impl Piece {
    fn reversed(&self) -> Self {
        Self {
            length: self.length,
            limits: [self.limits[1], self.limits[0]],
        }
    }

    /// Parts of equal length of a ramp.
    fn cut(&self) -> Vec<Self> {
        let width = self.length / f64::from(SHORT);
        let at = |part: u32| self.at(f64::from(part) / f64::from(SHORT));
        let parts = (0..SHORT).map(|part| Self {
            length: width,
            limits: [
                at(part),
                if part + 1 == SHORT {
                    self.limits[1]
                } else {
                    at(part + 1)
                },
            ],
        });
        parts.collect()
    }

    /// Whether the limits do not change.
    pub(super) fn is_constant(&self) -> bool {
        self.limits[0].map(f64::to_bits) == self.limits[1].map(f64::to_bits)
    }

    /// The limits at a share of the piece, up to a few units in the last place.
    pub(super) fn at(&self, share: f64) -> [f64; 3] {
        let [from, to] = self.limits;
        each(|i| from[i] + (to[i] - from[i]) * share)
    }
}

/// The limits, followed from either end to a place between.
#[derive(Debug, Clone)]
pub(super) struct Profile {
    /// Pieces from the begin to the meeting, and from the end to it, backwards in time.
    pub(super) sides: [Vec<Piece>; 2],
    /// Number of pieces of either side before the limits are constant until the meeting; `None` where they are not the
    /// same on both sides then.
    pub(super) ramps: Option<[usize; 2]>,
}

impl Profile {
    pub(super) fn of(envelope: &RateEnvelope, duration: f64) -> Self {
        let mut times = envelope.kinks(duration).to_vec();
        times.dedup_by(|b, a| *b - *a <= SAME * duration);
        let last = times.len() - 1;
        times[last] = duration;
        let at = |t: f64| each(|i| envelope.available(i, t, duration) * (1.0 + RAISED));
        let mut pieces: Vec<_> = times
            .windows(2)
            .map(|t| {
                let mut limits = [at(t[0]), at(t[1])];
                for i in 0..3 {
                    // Limits that differ by rounding alone are one.
                    let [a, b] = [limits[0][i], limits[1][i]];
                    if (a - b).abs() <= 0.1 * RAISED * a.max(b) {
                        limits[0][i] = a.max(b);
                        limits[1][i] = a.max(b);
                    }
                }
                Piece {
                    length: t[1] - t[0],
                    limits,
                }
            })
            .collect();
        // Met in the middle of a constant piece that is in both halves, else of the duration.
        let half = 0.5 * duration;
        let constant = (0..pieces.len())
            .filter(|k| pieces[*k].is_constant())
            .max_by(|a, b| pieces[*a].length.total_cmp(&pieces[*b].length));
        let mut begin = 0.0;
        let mut starts = vec![];
        for piece in &pieces {
            starts.push(begin);
            begin += piece.length;
        }
        let cut = constant
            .unwrap_or_else(|| starts.iter().rposition(|start| *start <= half).unwrap_or(0));
        let share = ((half - starts[cut]) / pieces[cut].length).clamp(0.1, 0.9);
        let piece = pieces[cut];
        let middle = piece.at(share);
        let first = Piece {
            length: piece.length * share,
            limits: [piece.limits[0], middle],
        };
        let second = Piece {
            length: piece.length - piece.length * share,
            limits: [middle, piece.limits[1]],
        };
        let rest = pieces.split_off(cut);
        let mut forward = pieces;
        forward.push(first);
        let mut backward: Vec<_> = rest[1..].iter().rev().map(Piece::reversed).collect();
        backward.push(second.reversed());
        let ramps = piece
            .is_constant()
            .then(|| [forward.len() - 1, backward.len() - 1]);
        let Some(ramps) = ramps else {
            return Self {
                sides: [forward, backward],
                ramps,
            };
        };
        let cut = |side: Vec<Piece>, ramps: usize| -> Vec<Piece> {
            let short = side[..ramps].iter().flat_map(Piece::cut);
            short.chain(side[ramps..].iter().copied()).collect()
        };
        let sides = [cut(forward, ramps[0]), cut(backward, ramps[1])];
        Self {
            ramps: Some([sides[0].len() - 1, sides[1].len() - 1]),
            sides,
        }
    }

    /// The limits between the ramps, where they are constant.
    pub(super) fn constant_limits(&self) -> Option<[f64; 3]> {
        self.ramps.map(|ramps| self.sides[0][ramps[0]].limits[0])
    }

    /// The level after pieces that begin with some level and costates, from the largest change of these.
    pub(super) fn level_after(
        ramps: &[Piece],
        mut level: Form,
        costate: &VectorForm,
        scale: &Form,
    ) -> Form {
        let sizes = costate.map(|u| level_form(&u));
        // The sine of the largest angle between the costate and an axis.
        let sines = costate.map(|u| {
            let least = u.hull().abs().low.min(1.0);
            (1.0 - least * least).sqrt() + 1e-15
        });
        // Angles by which the rates across an axis may have turned the costate.
        let mut turned = [0.0; 3];
        let scale = scale.hull().high;
        for piece in ramps {
            let most = each(|i| piece.limits[0][i].max(piece.limits[1][i]));
            let all: f64 = most.iter().sum();
            let most = most.map(|m| m + WAIST * (all - m));
            for i in 0..3 {
                let across = long([0.0, most[(i + 1) % 3], most[(i + 2) % 3]]);
                let (before, further) = (turned[i], piece.length * scale * across);
                turned[i] = before + further;
                let growth = piece.limits[1][i] - piece.limits[0][i];
                if growth != 0.0 {
                    // The limit grows at a constant pace; cos(x + d) is within sin x d + d^2 / 2 of cos x.
                    let first = sines[i] * (before + 0.5 * further);
                    let second =
                        0.5 * (before * before + before * further + further * further / 3.0);
                    let mean = sizes[i].inflated((first + second) * (1.0 + 1e-9));
                    level = level.plus(&mean.scaled(growth));
                }
            }
        }
        level
    }

    /// An upper bound on what a motion within the rounded box covers in the norm whose unit ball is bounded by `f . w = 1`
    /// for these vectors, s/rad, and those opposite to them.
    pub(super) fn covered(&self, normals: &[Vector3<f64>]) -> f64 {
        let supports: Vec<_> = normals.iter().map(box_supports).collect();
        // The norm of the farthest point: the largest of the supports across the facets, linear along a piece.
        let most = |m: [f64; 3]| {
            let supported = supports
                .iter()
                .map(|shares| (0..3).map(|i| shares[i] * m[i]).sum());
            supported.fold(0.0, f64::max)
        };
        let mut covered = 0.0;
        for piece in self.sides.iter().flatten() {
            let width = piece.length / f64::from(PARTS);
            for part in 0..PARTS {
                // Convex along the piece: below its chord.
                let ends =
                    [0, 1].map(|end| most(piece.at(f64::from(part + end) / f64::from(PARTS))));
                covered += 0.5 * (ends[0] + ends[1]) * width;
            }
        }
        covered * (1.0 + ROUNDING)
    }
}

/// Numbers within a few units in the last place of those given.
pub(super) fn around(limits: [f64; 3]) -> [Interval; 3] {
    limits.map(|m| Interval::around(m, 8.0 * f64::EPSILON * m))
}
