//! The shortest turns within a box of body rates, enclosed by proved bounds.
//!
//! `V(R)` is the least time in which `R' = R S(w)`, `|w_i| <= r_i`, leads from the identity to a
//! rotation `R`: a problem without inertia, faster than any slew within the box ([`ramps`] makes
//! that a bound on slews). `V` is invariant under inversion and under conjugation by half turns about
//! the body axes, obeys the triangle inequality, and falls when a rate rises. The conventions are
//! those of [`crate::model::attitude`]; both signs of a quaternion are one rotation.
//!
//! # The extremals
//!
//! By Pontryagin's principle there is a vector `A` fixed in space such that, with `M = R^T A`, the
//! rate maximises `M . w` over the box, `M' = M x w`, and `h = sum_i r_i |M_i|` is constant. (No
//! abnormal case: the maximum is positive unless `M = 0`.) Let `c = (r_1, r_2, r_3)` be scaled to
//! length one, `m = |M|` by components, and `s` the product of the signs of `M`. As `M_a w_b` carries
//! the signs of both, `m' = s m x c`: the folded point `m` runs along one circle `{m . c = h}` at unit
//! speed, in the sense `-s`. Where the circle leaves the positive octant (a *wall*, see `levels`) one
//! sign flips, hence `s`, hence the sense: the point is reflected. So it swings between two walls, all
//! arcs between flips last equally long, and the two axes flip in turn. At `M_j = 0` the crossing is
//! transversal unless `|M_k| / c_k = |M_l| / c_l`, the saddle of `h` on which `M` is parallel to a
//! face diagonal. Hence:
//!
//! * **regular** sequences: a first arc, interior arcs of one duration `D`, a last arc; neither outer arc
//!   is longer than `D`. The gap between two walls lies about an axis `i` that never flips (three
//!   *vertex* families, `D` down to zero), or, once the walls of the largest rates have vanished, on
//!   the far side of that axis, or is all of the circle but one wall;
//! * **singular** sequences on the level of a saddle: there `M` may rest, which forces a rate parallel to
//!   the face diagonal; between visits the arcs have durations that the level fixes. A dwell of
//!   length `d` is a turn by `exp(d h A)` *in space*; these commute, so all dwells of an extremal can
//!   be moved to the first visit without changing its end or its time;
//! * turns about one body axis at its full rate (`M` along it), and one or two arcs.
//!
//! Each has at most three free durations. Every sequence with non-negative durations is a motion within
//! the box, so sequences too many, or ranges too wide, change nothing; only a missing one would.
//!
//! Sequences are left out for three reasons. Their fixed arcs last longer than *every* turn needs at most
//! (`longest_time`). Some of their fixed arcs can be replaced by a clearly faster turn, so that no
//! shortest motion contains them. Vertex sequences of many flips keep `M` in a narrow cone about the axis,
//! of half-angle `e`; then the swing away from it stays below `2 e` and the rate of twist below
//! `c_i + tan(e) hypot(c_j, c_k)`, which bounds their time from below (`SequenceSearch::by_twist`); the bound
//! rises with the number of flips and ends the enumeration.
//!
//! # One equation per sequence
//!
//! With the interior `P(p)` of the parameter `p` (`D` or the dwell), `R = exp(t_0 c_0) P exp(t_f c_f)`
//! and the first and last turns leave `c_0` and `c_f` as they are, so
//!
//! ```text
//!   f(p) = c_0 . P(p) c_f - c_0 . R c_f = 0
//! ```
//!
//! For one free arc this is a sinusoid with closed roots; else cells `[p - b, p + b]` shrink by
//! `|f''| <= (sum of the speeds)^2`, which bounds second derivatives of any product of rotations. The
//! outer arcs then follow in closed form (`terminal_arcs`). Over a cell the interior stays within the angle
//! `|velocity| b + (sum of the speeds)^2 b^2 / 2` of its centre, which encloses the outer arcs and so
//! the time. Cells whose time is no less than the best motion's are dropped; the least bound of the
//! cells that were kept, or the best time if that is less, is a lower bound on `V`.
//!
//! # Rounding
//!
//! Quaternions of sequences are products of at most some thousand turns, correct to 1e-12; the equation
//! is tested with a margin of 1e-10 rad, which also widens what is known of the interior, so it is
//! not lost to rounding. `C1 + C2 <= 1` is used instead of being recomputed, so outer arcs are as good
//! as the interior. Nearly equal rates are raised to equality (`V` only falls). Results are deflated
//! by 1e-9 for the last few operations. Mathematical libraries differ in the last bit between
//! platforms: reports should round a bound down to six digits. [`crate::bounds::certify`] proves bounds again,
//! with its own list of extremals and in intervals.
//!
//! # Sources
//!
//! Pontryagin's maximum principle is standard; the enumeration is derived above. Swing and twist: the
//! decomposition `q = q_swing q_twist` about a body axis.

pub mod certificate;
mod drift;
mod extremal;
mod interior;
mod levels;
pub mod limits;
pub mod ramps;
mod rate_envelope;
mod search;
mod sequences;
mod singular;
mod terminal_arcs;
#[cfg(test)]
mod tests;
mod turns;

use crate::math::quaternion::Quat;
use crate::model::attitude::Attitude;
use levels::{EQUAL, Levels};
use nalgebra::Vector3;
use search::SequenceSearch;
use sequences::{ClosedFormSequence, FIRST, SequenceFamily};
use std::f64::consts::PI;

/// Most dwelling sequences of a ratio of rates: extreme ratios are refused rather than served slowly.
const MAX_SEQUENCES: usize = 200_000;
/// Taken off a lower bound for the rounding of its last operations.
const DEFLATION: f64 = 1e-9;

/// A box of body rates with the extremals of the turns within it: built once (milliseconds), shared
/// between threads, asked often.
#[derive(Debug, Clone)]
pub struct RateBox {
    levels: Levels,
    /// Normalised rates are the true ones divided by this, which is never less than the true norm.
    speed: f64,
    /// How much smaller than the normalised ones some true rates are, at most: not below one.
    stretch: f64,
    /// The least normalised rate.
    slowest: f64,
    /// Sequences of gaps.
    families: Vec<SequenceFamily>,
    /// Sequences with one free arc, those without fixed arcs first, then by the sum of these.
    closed_forms: Vec<ClosedFormSequence>,
    /// How many of them are tried before the families.
    promising: usize,
}

/// An arc of a motion at a constant rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateArc {
    /// Body rate, rad/s.
    pub rate_rad_s: Vector3<f64>,
    /// Duration, s.
    pub duration_s: f64,
}

/// The least time of a turn, enclosed, and a motion that takes the upper value.
#[derive(Debug, Clone, PartialEq)]
pub struct ShortestTurn {
    /// No motion within the box is faster, s.
    pub lower_s: f64,
    /// Time of the arcs, s.
    pub upper_s: f64,
    /// The motion, in order.
    pub arcs: Vec<RateArc>,
    /// Cells of the branch and bound: the work that it took.
    pub cells: usize,
}

impl RateBox {
    /// The box `|w_i| <= rates_i`, rad/s. `None` unless all rates are positive and finite, or when
    /// they are so different that there are too many extremals to keep.
    #[must_use]
    pub fn new(rates: Vector3<f64>) -> Option<Self> {
        let largest = rates.max();
        if !rates.iter().all(|rate| rate.is_finite() && *rate > 0.0) {
            return None;
        }
        let raised = raised_to_equality(rates / largest);
        let speed = raised.norm() * largest;
        let c: [f64; 3] = (raised / raised.norm()).into();
        let levels = Levels::new(c);
        let families = SequenceFamily::all(&levels);
        let mut closed_forms = singular::sequences(&levels, longest_time(&c), MAX_SEQUENCES)?;
        let promising = closed_forms.partition_point(|sequence| sequence.fixed == 0.0);
        let two_flips = families
            .iter()
            .flat_map(|family| (0..FIRST.len()).filter_map(|first| family.two_flips(&c, first)));
        closed_forms.splice(promising..promising, two_flips);
        Some(Self {
            promising: closed_forms.partition_point(|sequence| sequence.fixed == 0.0),
            speed,
            stretch: (0..3).fold(1.0, |most, i| f64::max(most, c[i] * speed / rates[i])),
            slowest: c[0].min(c[1]).min(c[2]),
            families,
            closed_forms,
            levels,
        })
    }

    /// The least time of a turn (either sign of the quaternion) to a relative tolerance, with a
    /// motion that takes it to about 1e-12 rad.
    ///
    /// For small turns the two values may differ by more than the tolerance, by the time in which the
    /// slowest rate turns by 3e-7 rad; they enclose the least time all the same.
    #[must_use]
    pub fn query(&self, turn: &Attitude, tolerance: f64) -> ShortestTurn {
        let q = canonical(turn);
        let mut search = SequenceSearch::new(self, &q, tolerance);
        search.run();
        let arcs: Vec<RateArc> = extremal::arcs(self, &q, search.best)
            .into_iter()
            .map(|(rate, duration)| RateArc {
                rate_rad_s: Vector3::from(rate) * (self.speed / self.stretch),
                duration_s: duration * (self.stretch / self.speed),
            })
            .collect();
        let upper_s: f64 = arcs.iter().map(|arc| arc.duration_s).sum();
        ShortestTurn {
            lower_s: self.lower(&search).min(upper_s),
            upper_s,
            arcs,
            cells: search.cells,
        }
    }

    /// The lower value of [`Self::query`] alone, s; nothing is allocated.
    #[must_use]
    pub fn lower_bound(&self, turn: &Attitude, tolerance: f64) -> f64 {
        let mut search = SequenceSearch::new(self, &canonical(turn), tolerance);
        search.run();
        self.lower(&search)
    }

    fn lower(&self, search: &SequenceSearch<'_>) -> f64 {
        let kept = search.lower.min(search.upper).max(search.floor());
        kept * (1.0 - DEFLATION) / self.speed
    }
}

/// The sign with a non-negative scalar part.
fn canonical(turn: &Attitude) -> Quat {
    let q = turn.xyzw();
    if q[3] < 0.0 { q.map(|x| -x) } else { q }
}

/// Rates of which no two are nearly, but not quite, equal: the smaller ones are raised, so times
/// only fall.
fn raised_to_equality(mut rates: Vector3<f64>) -> Vector3<f64> {
    // Twice, as raising one may bring it next to a third.
    for _ in 0..2 {
        for i in 0..3 {
            for j in 0..3 {
                if rates[i] < rates[j] && rates[i] > rates[j] * (1.0 - EQUAL) {
                    rates[i] = rates[j];
                }
            }
        }
    }
    rates
}

/// A time within which every turn can be made, normalised: turns about the two fastest axes `a` and
/// `b` in the order `a b a`, of which the outer two need at most half a turn together and the middle
/// one at most half a turn.
fn longest_time(c: &[f64; 3]) -> f64 {
    let mut sorted = *c;
    sorted.sort_by(f64::total_cmp);
    PI / sorted[2] + PI / sorted[1]
}
