//! The shortest turns within a box of body rates, enclosed by proved bounds.
//!
//! `V(R)` is the least time in which `R' = R S(w)`, `|w_i| <= r_i`, leads from the identity to a
//! rotation `R`. The problem has no inertia and is faster than any slew within the box; [`ramps`]
//! derives bounds on slews from it. `V` is invariant under inversion and under conjugation by half
//! turns about the body axes, obeys the triangle inequality, and does not rise when a rate rises.
//! The conventions are those of [`crate::model::attitude`]; both signs of a quaternion are one
//! rotation.
//!
//! # The extremals
//!
//! By Pontryagin's principle there is a vector `A` fixed in space such that, with the costate
//! `M = R^T A`, the rate maximises `M . w` over the box, `M' = M x w`, and `h = sum_i r_i |M_i|` is
//! constant. (There is no abnormal case: the maximum is positive unless `M = 0`.) Let
//! `c = (r_1, r_2, r_3)` be scaled to length one, `m = |M|` by components (the *folded* costate),
//! and `s` the product of the signs of `M`. As `M_a w_b` carries the signs of both, `m' = s m x c`:
//! the folded costate runs along the circle `{m . c = h}` (a *level*) at unit speed, in the sense
//! `-s`. Where the circle leaves the positive octant (at a *wall*, see `levels`) one sign flips,
//! hence `s`, hence the sense: the folded costate is reflected. So it oscillates between two walls,
//! all arcs between flips have the same duration, and the two axes flip alternately. At `M_j = 0`
//! the crossing is transversal unless `|M_k| / c_k = |M_l| / c_l`, the saddle of `h` at which `M`
//! is parallel to a face diagonal.
//!
//! So every extremal is an *arc sequence*: arcs of constant rate, each at a corner of the box, or,
//! during a *dwell*, on a face diagonal. Its first and last arcs are its *terminal arcs*, the
//! others its interior. There are
//!
//! * **regular** sequences: interior arcs of one duration `D` between terminal arcs that are no
//!   longer than `D`. The gap between two walls lies about an axis `i` that never flips (three
//!   *vertex* families, `D` down to zero), or, once the walls of the largest rates have vanished,
//!   on the far side of that axis, or is all of the circle except one wall;
//! * **singular** sequences on the level of a saddle: there `M` may rest, which implies a rate
//!   parallel to the face diagonal; between visits of the saddle the level determines the durations
//!   of the arcs. A dwell of length `d` is a turn by `exp(d h A)` *in space*; these turns commute,
//!   so all dwells of an extremal can be moved to the first visit without changing its end or its
//!   time;
//! * turns about one body axis at its full rate (`M` along it), and sequences of one or two arcs.
//!
//! Each has at most three free durations. Every arc sequence with non-negative durations is a
//! motion within the box, so superfluous sequences or too wide ranges do no harm; only a missing
//! sequence would.
//!
//! A sequence is left out in three cases. Its fixed arcs last longer than any turn needs
//! (`longest_time`). Some of its fixed arcs can be replaced by a clearly faster turn, so that no
//! shortest motion contains them. It is a vertex sequence of many flips, which keeps `M` within a
//! narrow cone about the axis, of half-angle `e`; then the swing away from the axis stays below
//! `2 e` and the rate of twist below `c_i + tan(e) hypot(c_j, c_k)`, which bounds the time from
//! below (`SequenceSearch::by_twist`). This bound rises with the number of flips and ends the
//! enumeration.
//!
//! # One equation per sequence
//!
//! With the turn `P(p)` of the interior as a function of its parameter `p` (`D` or the length of
//! the dwell), `R = exp(t_0 c_0) P exp(t_f c_f)`. The terminal turns leave `c_0` and `c_f`
//! unchanged, so
//!
//! ```text
//!   f(p) = c_0 . P(p) c_f - c_0 . R c_f = 0
//! ```
//!
//! With one free arc this is a sinusoid, whose roots have closed forms. Otherwise cells
//! `[p - b, p + b]` are narrowed with `|f''| <= (sum of the speeds)^2`, a bound on the second
//! derivative of any product of rotations. The terminal arcs then follow in closed form
//! (`terminal_arcs`). Over a cell the interior stays within the angle
//! `|velocity| b + (sum of the speeds)^2 b^2 / 2` of its centre, which encloses the terminal arcs
//! and so the time. Cells whose time is no less than the best motion's are dropped. The minimum of
//! the bounds of the remaining cells and of the best time is a lower bound on `V`.
//!
//! # Rounding
//!
//! Quaternions of sequences are products of at most some thousand turns, accurate to 1e-12. The
//! equation is tested with a margin of 1e-10 rad, by which the enclosure of the interior is widened
//! too, so that rounding cannot lose a root. `C1 + C2 <= 1` is used and not recomputed, so terminal
//! arcs are as accurate as the interior. Nearly equal rates are raised to equality (`V` only
//! falls). Results are reduced by 1e-9 for the last few operations. Mathematical libraries differ
//! in the last bit between platforms: reports should round a bound down to six digits.
//! [`crate::bounds::certify`] proves bounds again, with its own list of extremals and in interval
//! arithmetic.
//!
//! # Sources
//!
//! Pontryagin's maximum principle is standard; the enumeration is derived above. Swing and twist:
//! the decomposition `q = q_swing q_twist` about a body axis.

pub mod certificate;
pub(crate) mod drift;
mod extremal;
mod interior;
pub(crate) mod inversion;
mod levels;
pub mod limits;
pub mod ramps;
pub(crate) mod rate_envelope;
mod search;
mod sequences;
mod singular;
pub(crate) mod strongest;
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

/// Largest number of dwelling sequences; rates whose ratios are so extreme that there are more are
/// refused.
const MAX_SEQUENCES: usize = 200_000;
/// Relative reduction of a lower bound for the rounding of its last operations.
const DEFLATION: f64 = 1e-9;

/// A box of body rates with the extremals of the turns within it. Building it takes milliseconds;
/// it can be shared between threads.
#[derive(Debug, Clone)]
pub struct RateBox {
    levels: Levels,
    /// Normalised rates are the true ones divided by this, which is never less than the true norm,
    /// rad/s.
    speed: f64,
    /// Largest ratio of a normalised rate, scaled back, to the true one: at least one.
    stretch: f64,
    /// The least normalised rate.
    slowest: f64,
    /// The regular sequences.
    families: Vec<SequenceFamily>,
    /// Sequences with one free arc, sorted by the sum of their fixed arcs.
    closed_forms: Vec<ClosedFormSequence>,
    /// Number of these that have no fixed arcs; they are tried before the families.
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

/// The least time of a turn, enclosed, with a motion that attains the upper value.
#[derive(Debug, Clone, PartialEq)]
pub struct ShortestTurn {
    /// No motion within the box is faster, s.
    pub lower_s: f64,
    /// Duration of the motion, s.
    pub upper_s: f64,
    /// The motion, in order.
    pub arcs: Vec<RateArc>,
    /// Number of cells of the branch and bound.
    pub cells: usize,
}

impl RateBox {
    /// The box `|w_i| <= rates_i`, rad/s. `None` unless all rates are positive and finite, or when
    /// they differ so much that there are too many extremals to store.
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
            stretch: (0..3).fold(1.0, |largest, i| f64::max(largest, c[i] * speed / rates[i])),
            slowest: c[0].min(c[1]).min(c[2]),
            families,
            closed_forms,
            levels,
        })
    }

    /// The least time of a turn (either sign of the quaternion) to a relative tolerance, with a
    /// motion that reaches the turn to about 1e-12 rad.
    ///
    /// For small turns the two values may differ by more than the tolerance, by the time in which
    /// the slowest rate turns by 3e-7 rad; they enclose the least time in any case.
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

    /// The lower value of [`Self::query`] alone, s, without allocation.
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

/// Rates of which no two are nearly but not exactly equal: the smaller one of such a pair is
/// raised, so that times only fall.
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

/// A normalised time within which every turn can be made: by turns about the two fastest axes `a`
/// and `b` in the order `a b a`. The first and last of these need at most half a turn together, the
/// middle one at most half a turn.
fn longest_time(c: &[f64; 3]) -> f64 {
    let mut sorted = *c;
    sorted.sort_by(f64::total_cmp);
    PI / sorted[2] + PI / sorted[1]
}
