//! The bound on a slew with stored momentum, from the docs of [`crate::bounds::kinematic::drift`].
//!
//! ```text
//!   s(T') + l (T' - T) <= V(Q(T)) - missed,     l = max_i |W_i| / p_i,
//! ```
//!
//! excludes every duration from `T` to `T'`, with the drift `W` at either end of the slew. The least time `V` of what
//! is left of the turn after `T` is proved like that of any turn, and `s` is bounded from above as without a drift.

use super::{Rejection, check_limits, check_missed, check_times, link, malformed, prover_within};
use crate::bounds::interval::Interval;
use crate::bounds::kinematic::certificate::{DriftCertificate, ExcludedDurations};
use nalgebra::Vector3;

/// Verifies the certificate of a bound on a slew with stored momentum.
///
/// # Errors
///
/// The first [`Rejection`]; the turn of a [`Rejection::Faster`] is what is left of it in the range of durations with
/// that number.
pub fn verify_drift(certificate: &DriftCertificate) -> Result<(), Rejection> {
    let DriftCertificate {
        steps,
        attitude_tolerance_rad,
        duration_s,
    } = certificate;
    check_times([*duration_s])?;
    check_missed(*attitude_tolerance_rad)?;
    let mut excluded_s = 0.0;
    for (place, step) in steps.iter().enumerate() {
        if excluded_s >= *duration_s {
            break;
        }
        check_times([step.from_s, step.to_s, step.left.least_s])?;
        if step.from_s > excluded_s {
            return Err(Rejection::Open { excluded_s });
        }
        let to_s = step.to_s.min(*duration_s);
        verify_range(step, to_s, *attitude_tolerance_rad)
            .map_err(|rejection| rejection.of_turn(place))?;
        excluded_s = to_s.max(excluded_s);
    }
    if excluded_s < *duration_s {
        return Err(Rejection::Open { excluded_s });
    }
    Ok(())
}

/// Verifies that no slew has a duration from the least of a range to another one of it, s.
fn verify_range(
    step: &ExcludedDurations,
    to_s: f64,
    attitude_tolerance_rad: f64,
) -> Result<(), Rejection> {
    let rates = &step.box_rad_s;
    check_limits(&step.limits, &step.ends)?;
    let mut prover = prover_within(rates)?;
    let drifts = step.drifts_rad_s.each_ref();
    if drifts
        .iter()
        .any(|drift| !drift.iter().all(|x| x.is_finite()))
    {
        return malformed("drifts must be finite");
    }
    let [begin, end] = drifts.map(|drift| relative_speed(drift, rates));
    let moved = Interval::exactly(to_s) - Interval::exactly(step.from_s);
    let needed = Interval::exactly(link::at_most(&step.limits, &step.ends, rates, to_s))
        + begin.least(end) * moved;
    let missed_s = link::missed(rates, attitude_tolerance_rad);
    let least_s = (Interval::exactly(step.left.least_s) - missed_s).low;
    if to_s > 0.0 && needed.high > least_s {
        let needed_s = needed.high;
        return Err(Rejection::Link { least_s, needed_s });
    }
    prover.prove(&step.left.turn, step.left.least_s)
}

/// By how much the least time of a turn changes at most per time of a drift.
fn relative_speed(drift: &Vector3<f64>, rates: &Vector3<f64>) -> Interval {
    let shares = (0..3).map(|i| Interval::exactly(drift[i].abs()) / Interval::exactly(rates[i]));
    let most = shares.fold(0.0, |most, share| f64::max(most, share.high));
    Interval::exactly(most)
}
