//! Slews of a spacecraft that turns in space by itself: what stored momentum does.
//!
//! Let the body rate be `w = v + R^T W` with a vector `W` that is constant in the reference frame, the
//! *drift*, and let it be `v` whose components and accelerations are limited. Then `Q = exp(-W t) R`
//! obeys `Q' = Q S(v)`: seen from axes that turn with the drift the motion is an ordinary one, only
//! the turn that it has to make depends on its duration,
//!
//! ```text
//!   Q(T) = exp(-W_0 T) R_rel,     W_0 the drift in the body axes at the beginning.
//! ```
//!
//! So `V_p(Q(T)) <= s(T)` for the duration `T` of every such slew (`super::ramps`). Durations are
//! excluded from zero upwards: as `V` obeys the triangle inequality and `Q(T)^-1 Q(T + d)` is a turn by
//! `-W_f d`, the drift in body axes at the end, `V_p(Q(T + d)) >= V_p(Q(T)) - l d` with
//! `l = max_i |W_f,i| / p_i`; by inversion the same holds with `W_0`. With `s` nondecreasing, no slew
//! takes a time in `[T, T']` if `s(T') + l (T' - T) < V_p(Q(T))`. Once all durations below `T` are
//! excluded, by whatever box, the next step starts there.

use super::limits::EndRates;
use super::ramps::{DEFLATION, SlewBound, certifiable_time, rounded_down};
use super::rate_envelope::RateEnvelope;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;

/// Most steps of a march.
const STEPS: usize = 60;
/// Turns smaller than this, rad, are not told from none: rounding of the turn counts.
const NO_TURN: f64 = 1e-8;

impl SlewBound {
    /// A duration, s, that no slew undercuts that makes a turn in body axes (as in
    /// [`Self::lower_bound_s`]) while it drifts: limits are those of the rate relative to axes that
    /// turn with a constant rate in space, `drift_rad_s`, here in body axes at the beginning.
    /// `ends` are those of the relative rate, too: a slew from rest starts with the drift. The boxes
    /// are those made for the ends in [`Self::new`]; any are valid.
    ///
    /// The result is within the tolerance of what this argument gives, relative, and valid for any.
    #[must_use]
    pub fn drifting_lower_bound_s(
        &self,
        turn: &Attitude,
        drift_rad_s: &Vector3<f64>,
        ends: EndRates,
        tolerance: f64,
    ) -> f64 {
        let envelope = RateEnvelope {
            ends,
            ..self.envelope
        };
        let at_end = turn.to_body(*drift_rad_s);
        let mut excluded = 0.0;
        for _ in 0..STEPS {
            let left = Attitude::from_rotation_vector(-drift_rad_s * excluded).then_in_body(turn);
            let next = self.boxes.iter().fold(excluded, |next, (rates, table)| {
                let least = certifiable_time(table, &left, tolerance);
                if least * rates.min() < NO_TURN {
                    return next;
                }
                let speed = |drift: &Vector3<f64>| drift.abs().component_div(rates).max();
                let slope = speed(drift_rad_s).min(speed(&at_end));
                f64::max(
                    next,
                    envelope.longest_short_of(rates, least, slope, excluded),
                )
            });
            let done = next - excluded <= tolerance * next;
            excluded = next;
            if done {
                break;
            }
        }
        rounded_down(excluded * (1.0 - DEFLATION))
    }
}
