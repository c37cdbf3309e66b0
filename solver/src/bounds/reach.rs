//! Lower bounds on slews whose rates are in a box that changes in time.
//!
//! The bounds of [`crate::bounds::kinematic`] and [`crate::bounds::polytope`] compare a slew with motions at rates that
//! are limited in the same way all the time, and pay for its ramps with the time that they cost at least. Here the
//! limits are taken as they are, `|w_i(t)| <= m_i(t; T)` with the [`RateEnvelope`], and a duration is a lower bound
//! because no motion within them makes the turn.
//!
//! # The argument
//!
//! 1. **One duration is enough.** A motion of duration `T' < T` within `m(.; T')`, slowed to `w(t T' / T) T' / T`, lasts
//!    `T` and is within `m(.; T)`: with `q = T' / T < 1` its limits are `q r_i <= r_i`, `q (b_i + a_i q t) <= b_i + a_i t`
//!    and `q (e_i + a_i (T' - q t)) <= e_i + a_i (T - t)`. So if no motion of duration `T` makes the turn, no shorter one
//!    does.
//! 2. **A larger, round set.** At every time the box `B(t)` is replaced by a compact convex `K(t)` around it
//!    (`rounded_box`), in which the point that supports a costate is unique, and a Lipschitz function of it. Away from
//!    walls it is the corner of the box. What is out of reach in `K` is so in `B`.
//! 3. **The least scale.** Suppose that a motion in `K` makes the turn `R` in `T`. Among the scales `L` for which one does
//!    with `w(t)` in `L K(t)` there is a least one, since these sets are compact, convex, and grow with `L`. Take `L`
//!    as a state that does not change, `X' = X S(L k)` with `k` in `K(t)`, and minimise it: by Pontryagin's principle
//!    there are a costate `M` fixed in inertial axes, `u = X^T M` in body axes, and one of `L`, `l' = -u . k`, with
//!    `l(0) = 0` and `l(T) = -c <= 0`, not all of them zero, so that `k(t)` maximises `u . k`. If `M` were zero, so would be
//!    `l` and `c`: so it is not. Hence `X' = X S(L k(X^T M, t))` with the support point `k` of `K(t)`, an ordinary
//!    differential equation that `M`, of length one, and `L <= 1` determine: **three numbers**.
//! 4. **From below** the scale is bounded by the least time `V_G(R)` in a norm `G` that is proved elsewhere: it is at most
//!    `L int_0^T max_{w in K(t)} G(w) dt`.
//! 5. **The covering** (`covering`): all `M` and `L` are covered by cells. The members of a cell are followed together
//!    (`tube`), from the begin on and, since the costate at the end is `R^T M`, from the end back. Backwards in time
//!    the motion `Z(t') = R^T X(T - t')` has the rates `-w` and the costate `-R^T M` at its begin, in body axes: the same
//!    equation with reversed limits. A cell is refuted if both sides cannot meet, else what cannot meet is cut off, or
//!    it is halved.
//!
//! Two facts refute most cells before their middle is followed. The **level** `h(u, t)`, the support function of `K(t)`,
//! changes along an extremal by `dh / dt` alone, the change of the limits: between the ramps it is the same on both
//! sides, and its change on the ramps is known well before the costates are. And where it is below all **saddles**
//! around a minimum, the costate stays on one side of them: on the rim `|u_i| / m_i = |u_j| / m_j >= |u_k| / m_k` of the
//! directions nearest to axis `i`, the support function of the box, `sum m |u|`, is at least
//! `min_j sqrt(m_i^2 + m_j^2)`: it is concave along the rim, between this at its ends and `sqrt(m_1^2 + m_2^2 + m_3^2)`.
//!
//! Attitudes that are missed by `d` at both ends make another turn within `2 d` of `R`: by so much the costates at the
//! end and the meeting may differ.
//!
//! Numbers are affine forms of the place in the cell with a rest (`form`), or intervals. What any operation leaves out,
//! rounding included, is in the rest, so what is excluded is proved: there is no second proof.

mod covering;
mod form;
mod meeting;
mod profile;
mod rests;
mod rounded_box;
#[cfg(test)]
mod tests;
mod tube;

use crate::bounds::kinematic::certificate::Certificate;
use crate::bounds::kinematic::ramps::stated;
use crate::bounds::kinematic::rate_envelope::RateEnvelope;
use crate::bounds::polytope::certificate::NormCertificate;
use covering::{Covered, Covering};
use nalgebra::{Matrix3, Vector3};
use profile::Profile;

/// Largest number of steps of a covering: some five seconds.
const MAX_STEPS: usize = 1_000_000;
/// Increase of a duration that is known to be excluded for the first trial.
const FIRST: f64 = 1.04;
/// Further increase where no extremal makes the turn.
const FURTHER: f64 = 1.03;
/// Share by which the second trial stays below the duration at which an extremal is expected.
const BELOW: f64 = 3e-4;
/// Relative gain for which there is no further trial.
const SMALL_GAIN: f64 = 2e-3;
/// Largest number of trials.
const MAX_TRIALS: usize = 8;
/// Scale below which the known bound is too weak to begin with.
const MIN_SCALE: f64 = 0.6;
/// Relative error allowed for the rounding of a few operations.
const ROUNDING: f64 = 1e-9;

/// The slews that a certificate is about, with limits that change in time.
#[derive(Debug)]
pub(crate) struct SlewsInBox {
    envelope: RateEnvelope,
    turn: Matrix3<f64>,
    /// By how much the turn may be another one, rad.
    missed: f64,
    norms: Vec<NormPremise>,
    rates: Vector3<f64>,
}

/// The least time of the turn in a norm, proved elsewhere.
#[derive(Debug)]
struct NormPremise {
    /// Half-spaces of the unit ball, s/rad, and those opposite to them.
    normals: Vec<Vector3<f64>>,
    /// Least time, less what missed attitudes save, s.
    least_s: f64,
}

impl SlewsInBox {
    /// The slews of a certificate for one turn whose least time is proved.
    pub(crate) fn of(certificate: &Certificate) -> Option<Self> {
        let [turn] = &certificate.turns[..] else {
            return None;
        };
        let missed = 2.0 * certificate.attitude_tolerance_rad * (1.0 + ROUNDING);
        let rates = certificate.box_rad_s;
        let normals = (0..3).map(|axis| Vector3::ith(axis, 1.0 / rates[axis]));
        Some(Self {
            envelope: RateEnvelope {
                limits: certificate.limits,
                ends: certificate.ends,
            },
            turn: turn.turn.matrix(),
            missed,
            norms: vec![NormPremise::new(normals.collect(), turn.least_s, missed)],
            rates,
        })
    }

    /// The same with the proved least time of the turn in another norm, whose certificate is in body axes; the columns
    /// of the matrix are the axes of this one.
    pub(crate) fn knowing(mut self, axes: &Matrix3<f64>, certificate: &NormCertificate) -> Self {
        let normals = certificate.facets.iter();
        let normals = normals.map(|facet| axes.tr_mul(&facet.normal)).collect();
        let least_s = certificate.turn.least_s;
        self.norms
            .push(NormPremise::new(normals, least_s, self.missed));
        self
    }

    /// The longest duration that is excluded, s, of some beyond a known bound; `None` if none is.
    pub(crate) fn longest_excluded_s(&self, known_s: f64) -> Option<f64> {
        let (mut longest, mut trial, mut open) = (known_s, known_s * FIRST, f64::INFINITY);
        let mut below = BELOW;
        for _ in 0..MAX_TRIALS {
            match self.exclude(stated(trial)) {
                Covered::Excluded => {
                    longest = stated(trial);
                    trial = f64::min(longest * FURTHER, 0.5 * (longest + open));
                }
                Covered::Open(scale) => {
                    // The duration whose whole box covers what this extremal does, and less at every trial.
                    open = trial;
                    let covered = self.envelope.effective(&self.rates, trial) * scale;
                    trial = self.envelope.duration_of(&self.rates, covered) * (1.0 - below);
                    below *= 2.0;
                }
                Covered::GivenUp => break,
            }
            if trial <= longest * (1.0 + SMALL_GAIN) {
                break;
            }
        }
        (longest > known_s).then_some(longest)
    }

    /// Whether no motion of this duration, s, or of a shorter one makes the turn.
    #[cfg(test)]
    pub(crate) fn excludes(&self, duration_s: f64) -> bool {
        self.exclude(duration_s) == Covered::Excluded
    }

    fn exclude(&self, duration_s: f64) -> Covered {
        self.exclude_within(duration_s, MAX_STEPS)
    }

    /// Tries to exclude a duration, s, in so many steps.
    fn exclude_within(&self, duration_s: f64, steps: usize) -> Covered {
        // Between equal attitudes a motion may last no time at all.
        if duration_s <= 0.0 {
            return Covered::GivenUp;
        }
        let profile = Profile::of(&self.envelope, duration_s);
        let scales = self
            .norms
            .iter()
            .map(|norm| norm.least_s / profile.covered(&norm.normals));
        let least = scales.fold(0.0, f64::max) * (1.0 - ROUNDING);
        if least >= 1.0 {
            return Covered::Excluded;
        }
        if least.is_nan() || least < MIN_SCALE {
            return Covered::GivenUp;
        }
        Covering::new(&profile, self.turn, self.missed, steps).exclude(least, 1.0)
    }
}

impl NormPremise {
    fn new(normals: Vec<Vector3<f64>>, least_s: f64, missed: f64) -> Self {
        let longest = normals.iter().map(Vector3::norm).fold(0.0, f64::max);
        Self {
            normals,
            least_s: least_s - missed * longest * (1.0 + ROUNDING),
        }
    }
}
