//! Slews with a drift: stored momentum turns the spacecraft at a rate that is constant in space.
//!
//! Let the body rate be `w = v + R^T W` with a vector `W` that is constant in the reference frame,
//! the *drift*, and let it be `v` whose components and accelerations are limited. Then
//! `Q = exp(-W t) R` obeys `Q' = Q S(v)`: relative to axes that turn with the drift the motion has
//! limited rates, but the turn that it has to make depends on its duration,
//!
//! ```text
//!   Q(T) = exp(-W_0 T) R_rel,     W_0 the drift in the body axes at the beginning.
//! ```
//!
//! So `V_p(Q(T)) <= s(T)` for the duration `T` of every such slew (`super::ramps`). Durations are
//! excluded from zero upwards. `V` obeys the triangle inequality, and `Q(T)^-1 Q(T + d)` is a turn
//! by `-W_f d`, with `W_f` the drift in body axes at the end. So `V_p(Q(T + d)) >= V_p(Q(T)) - l d`
//! with `l = max_i |W_f,i| / p_i`; by inversion the same holds with `W_0`. As `s` is nondecreasing,
//! no slew has a duration in `[T, T']` if `s(T') + l (T' - T) < V_p(Q(T))`. Once all durations
//! below `T` are excluded, by any box, the next step starts at `T`.
//!
//! Where attitudes are missed by `E_0` and `E_1`, the drift in body axes is `E_0^T W_0` at the
//! beginning, and the turn to be made is `E_0^T Q(T) E_1`: as much less counts as without a drift.
//!
//! Of several boxes, in several axes and relative to several drifts, those are tried that promise most, as in
//! [`super::strongest`]: what one excludes is where the others go on, and a box is left out in which a known motion
//! makes the turn that is left in what it allows.

use super::certificate::CertifiedTurn;
use super::ramps::{DEFLATION, SlewBound, TriedBox, rounded_down};
use super::rate_envelope::RateEnvelope;
use super::strongest::{SMALL_GAIN, quick_times};
use crate::model::attitude::Attitude;
use nalgebra::Vector3;

/// Rounds over all boxes, most of which exclude nothing more after the first.
const MAX_ROUNDS: usize = 4;
/// Turns smaller than this, rad, are not distinguished from the identity because of rounding.
const NO_TURN: f64 = 1e-8;

/// A slew as it is seen in the axes and relative to the drift of a bound.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriftingSlew<'a> {
    /// Gives the boxes; any boxes are valid.
    pub(crate) bound: &'a SlewBound,
    /// The turn that it makes, in body axes.
    pub(crate) turn: Attitude,
    /// The drift at the beginning, rad/s, body axes.
    pub(crate) drift: Vector3<f64>,
    /// Limits of the rate relative to axes that turn with the drift. Its ends are relative to them too: a slew
    /// from rest starts with the negative drift.
    pub(crate) envelope: RateEnvelope,
}

/// Durations that a box excludes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exclusion {
    /// Number of the view that has the box.
    pub(crate) view: usize,
    /// The box of rates, rad/s.
    pub(crate) box_rad_s: Vector3<f64>,
    /// What is left of the turn for the least of the durations.
    pub(crate) left: CertifiedTurn,
    /// The least and the greatest of them, s.
    pub(crate) range_s: [f64; 2],
}

/// A lower bound on the duration of a slew.
#[derive(Debug)]
pub(crate) struct DriftBound {
    /// The bound, s.
    pub(crate) duration_s: f64,
    /// The durations that it rests on, from the known ones upwards.
    pub(crate) steps: Vec<Exclusion>,
}

/// Lower bound on the duration of a slew that is seen in several ways, of which shorter durations than
/// `known_s` are excluded already, by whatever argument. Where none are, the first view should have no drift.
///
/// The result is valid for any number of least times that are computed at most, and any tolerance of them.
pub(crate) fn drifting_bound(
    seen: &[DriftingSlew<'_>],
    known_s: f64,
    (mut left, tolerance): (usize, f64),
) -> DriftBound {
    let candidates = most_promising_first(seen, known_s);
    let (mut excluded, mut steps) = (known_s, Vec::new());
    for _ in 0..MAX_ROUNDS {
        let before = excluded;
        for (view, tried) in &candidates {
            let slew = &seen[*view];
            while left > 0 && slew.promises_more(tried, excluded) {
                left -= 1;
                let (turn, next) = slew.raised(tried, excluded, tolerance);
                let gained = next > excluded * (1.0 + SMALL_GAIN);
                if next > excluded * (1.0 + DEFLATION) {
                    steps.push(Exclusion {
                        view: *view,
                        box_rad_s: tried.rates,
                        left: turn,
                        range_s: [excluded, next],
                    });
                    excluded = next;
                }
                if !gained {
                    break;
                }
            }
        }
        if excluded <= before * (1.0 + SMALL_GAIN) {
            break;
        }
    }
    DriftBound {
        duration_s: rounded_down(excluded).max(known_s),
        steps,
    }
}

/// All boxes with the numbers of the views that have them, by the ratio of the time that the turn is expected to take to that which
/// they allow in a duration that all share.
fn most_promising_first<'a>(seen: &[DriftingSlew<'a>], known_s: f64) -> Vec<(usize, &'a TriedBox)> {
    let Some(first) = seen.first() else {
        return Vec::new();
    };
    let limits = &first.bound.boxes[0];
    let expected = first.expected_s(limits, 0.0);
    let reference = if known_s > 0.0 {
        known_s
    } else {
        first.envelope.duration_of(&limits.rates, expected)
    };
    let boxes = seen
        .iter()
        .enumerate()
        .flat_map(|(view, slew)| slew.bound.boxes.iter().map(move |tried| (view, tried)));
    let promise = |(view, tried): &(usize, &TriedBox)| {
        let slew = &seen[*view];
        let allowed = slew.envelope.effective(&tried.rates, reference);
        slew.expected_s(tried, reference) / allowed
    };
    let mut promised: Vec<_> = boxes.map(|one| (promise(&one), one)).collect();
    promised.sort_by(|one, other| other.0.total_cmp(&one.0));
    promised.into_iter().map(|(_, one)| one).collect()
}

impl DriftingSlew<'_> {
    /// What is left of the turn for a duration, s, relative to the drift.
    fn left_after(&self, duration: f64) -> Attitude {
        Attitude::from_rotation_vector(-self.drift * duration).then_in_body(&self.turn)
    }

    /// The least time of that turn within a box, s, by a guess.
    fn expected_s(&self, tried: &TriedBox, duration: f64) -> f64 {
        let [attained, least] = quick_times(tried, &self.left_after(duration));
        (0.5 * (attained + least) - self.bound.missed_time(tried)).max(0.0)
    }

    /// Whether a box may exclude more than a duration, s.
    fn promises_more(&self, tried: &TriedBox, excluded: f64) -> bool {
        let [attained, _] = quick_times(tried, &self.left_after(excluded));
        let needed = self
            .envelope
            .effective(&tried.rates, excluded * (1.0 + SMALL_GAIN));
        attained - self.bound.missed_time(tried) > needed
    }

    /// The duration that a box excludes with all shorter ones, s, once those below another one are, and what is
    /// left of the turn there.
    fn raised(&self, tried: &TriedBox, excluded: f64, tolerance: f64) -> (CertifiedTurn, f64) {
        let rates = &tried.rates;
        let left = tried.certified(&self.left_after(excluded), tolerance);
        let least = self.bound.left_of(tried, left.least_s);
        if least * rates.min() < NO_TURN {
            return (left, excluded);
        }
        let speed = |drift: &Vector3<f64>| drift.abs().component_div(rates).max();
        let slope = speed(&self.drift).min(speed(&self.turn.to_body(self.drift)));
        let next = self
            .envelope
            .longest_short_of(rates, least, slope, excluded);
        (left, (next * (1.0 - DEFLATION)).max(excluded))
    }
}
