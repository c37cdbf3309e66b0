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

use super::ramps::{DEFLATION, SlewBound, rounded_down};
use super::rate_envelope::RateEnvelope;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;

/// Largest number of steps.
const MAX_STEPS: usize = 60;
/// Turns smaller than this, rad, are not distinguished from the identity because of rounding.
const NO_TURN: f64 = 1e-8;

impl SlewBound {
    /// Lower bound, s, on the duration of a slew with a drift that makes a turn in body axes (as in
    /// [`Self::lower_bound_s`]). The envelope is that of the rate relative to axes that turn at a
    /// constant rate in space, `drift_rad_s`, given in body axes at the beginning; so are the rates at the
    /// ends: a slew from rest starts with the negative drift. The boxes are those of [`Self::new`]; any
    /// boxes are valid. Durations below `known_s` are excluded already, by whatever argument.
    ///
    /// The result is valid for any tolerance, and within the relative tolerance of the best bound
    /// that this argument gives.
    pub(crate) fn drifting_lower_bound_s(
        &self,
        turn: &Attitude,
        drift_rad_s: &Vector3<f64>,
        envelope: &RateEnvelope,
        known_s: f64,
        tolerance: f64,
    ) -> f64 {
        let at_end = turn.to_body(*drift_rad_s);
        let mut excluded = known_s;
        for _ in 0..MAX_STEPS {
            let left = Attitude::from_rotation_vector(-drift_rad_s * excluded).then_in_body(turn);
            let next = self.boxes.iter().fold(excluded, |next, tried| {
                let rates = &tried.rates;
                let least = self.least_time(tried, &left, tolerance);
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
        rounded_down(excluded * (1.0 - DEFLATION)).max(known_s)
    }
}
