//! One norm: its polytope, and how much of it a slew can cover in a time.

use crate::bounds::kinematic::certificate::CertifiedTurn;
use crate::bounds::kinematic::inversion::last_below;
use crate::bounds::kinematic::rate_envelope::RateEnvelope;
use crate::bounds::polytope::RatePolytope;
use crate::bounds::polytope::certificate::{
    FacetPremise, FramePremise, NormCertificate, PROOF_MARGIN,
};
use crate::bounds::polytope::trapezoid::Trapezoid;
use crate::model::attitude::Attitude;
use nalgebra::{Matrix3, Vector3};

/// Parts of the time between two kinks: the limits are replaced by linear ones above them on each.
const PARTS: usize = 2;

/// A norm of rates with what limits it during a slew.
#[derive(Debug)]
pub(super) struct Norm {
    polytope: RatePolytope,
    /// For each pair of facets, the limits of its component relative to its distance.
    facets: Vec<FacetLimits>,
    /// A frame with the limits along its axes.
    boxed: Option<(Matrix3<f64>, RateEnvelope)>,
}

#[derive(Debug)]
struct FacetLimits {
    premise: FacetPremise,
    /// Absolute components along the axes of the frame, relative to its distance.
    shares: Vector3<f64>,
}

impl Norm {
    /// The norm whose unit ball has the facets `f . w = 1`; `None` where that is no polytope.
    pub(super) fn new(
        half_spaces: &[Vector3<f64>],
        boxed: Option<(Matrix3<f64>, RateEnvelope)>,
        limits: impl Fn(&Vector3<f64>) -> Trapezoid,
    ) -> Option<Self> {
        let polytope = RatePolytope::within(half_spaces)?;
        let facets = half_spaces.iter().map(|f| FacetLimits {
            premise: FacetPremise {
                normal: *f,
                share: limits(f),
            },
            shares: boxed.map_or_else(Vector3::zeros, |(axes, _)| axes.tr_mul(f).abs()),
        });
        Some(Self {
            facets: facets.collect(),
            boxed,
            polytope,
        })
    }

    /// By how much a bound, s, may rise at most: the ratio of the time of the turn by a rotation vector, rad, at a
    /// constant rate to what a slew of that duration covers.
    pub(super) fn promise(&self, vector: &Vector3<f64>, known_s: f64) -> f64 {
        if known_s <= 0.0 {
            return f64::INFINITY;
        }
        self.polytope.constant_rate_s(vector) / self.covered(known_s)
    }

    /// The larger of a bound, s, and that of this norm on a turn whose ends are missed by an angle, rad, each.
    pub(super) fn raised(&self, turn: &Attitude, missed: f64, known_s: f64, tolerance: f64) -> f64 {
        let least = self.certifiable_time(turn, tolerance) - self.polytope.slowest_s(2.0 * missed);
        if least <= self.covered(known_s) {
            return known_s;
        }
        last_below(known_s, least, least, |duration| self.covered(duration))
    }

    /// The certificate of a bound, s, that this norm gives.
    pub(super) fn certificate(
        &self,
        turn: &Attitude,
        missed: f64,
        bound_s: f64,
        tolerance: f64,
    ) -> NormCertificate {
        NormCertificate {
            facets: self.facets.iter().map(|facet| facet.premise).collect(),
            frame: self.boxed.map(|(axes, envelope)| FramePremise {
                axes,
                limits: envelope.limits,
                ends: envelope.ends,
            }),
            turn: CertifiedTurn {
                turn: *turn,
                least_s: self.certifiable_time(turn, tolerance),
            },
            attitude_tolerance_rad: missed,
            duration_s: bound_s,
        }
    }

    /// The least time of a turn, s, with the margin that its verification needs.
    fn certifiable_time(&self, turn: &Attitude, tolerance: f64) -> f64 {
        self.polytope.least_time(turn, tolerance).lower_s * (1.0 - PROOF_MARGIN)
    }

    /// `s(T)`, from above.
    fn covered(&self, duration: f64) -> f64 {
        let mut times = vec![0.0, duration];
        times.extend(
            self.facets
                .iter()
                .flat_map(|facet| facet.premise.share.kinks(duration)),
        );
        if let Some((_, boxed)) = &self.boxed {
            times.extend(boxed.kinks(duration));
        }
        times.sort_by(f64::total_cmp);
        let part = |pair: &[f64]| {
            let length = (pair[1] - pair[0]) / PARTS as f64;
            if length <= 0.0 {
                return 0.0;
            }
            let parts = (0..PARTS).map(|part| {
                let from = pair[0] + length * part as f64;
                self.covered_between([from, from + length], duration)
            });
            parts.sum()
        };
        times.windows(2).map(part).sum()
    }

    /// The same between two times without a kink between them. Each facet has one of its two limits, both linear
    /// there; the largest of linear functions is below the chord between its ends.
    fn covered_between(&self, times: [f64; 2], duration: f64) -> f64 {
        let boxed = self.boxed.as_ref().map(|(_, boxed)| {
            times.map(|time| Vector3::from_fn(|axis, _| boxed.available(axis, time, duration)))
        });
        let mut largest = [0.0_f64; 2];
        for facet in &self.facets {
            let mut limits = times.map(|time| facet.premise.share.at(time, duration));
            if let Some(boxed) = &boxed {
                let other = boxed.map(|rates| rates.dot(&facet.shares));
                if other[0] + other[1] < limits[0] + limits[1] {
                    limits = other;
                }
            }
            for (most, limit) in largest.iter_mut().zip(limits) {
                *most = most.max(limit);
            }
        }
        0.5 * (largest[0] + largest[1]) * (times[1] - times[0])
    }
}
