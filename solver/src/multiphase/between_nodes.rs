//! Limits inside intervals, where the program imposes them at the nodes only.

use crate::attitude::Attitude;
use crate::dynamics::Dynamics;
use crate::profile::Profile;

/// Parts of an interval at whose ends the limits are looked at: a long interval may turn by a
/// radian, and the stored momentum with it.
const SAMPLES: usize = 16;

/// Greatest relative excess over speed and rate limits inside intervals. Wheel momenta are linear
/// there, but the turn of the stored momentum bends the rates.
pub(super) fn excess_between_nodes(dynamics: &Dynamics, profile: &Profile) -> f64 {
    if !dynamics.has_momentum() {
        // Rates are linear between nodes, and so is every limit, or convex.
        return 0.0;
    }
    let mut worst = 0.0_f64;
    for k in 0..profile.intervals() {
        let usage = usage_inside(dynamics, profile, k);
        let peak = peak(&usage);
        if peak > usage[0].max(usage[SAMPLES]) {
            worst = worst.max(peak - 1.0);
        }
    }
    worst
}

/// Usage of the limits at even times of an interval, both ends included.
fn usage_inside(dynamics: &Dynamics, profile: &Profile, k: usize) -> Vec<f64> {
    let (from, to) = (&profile.wheels[k], &profile.wheels[k + 1]);
    let step = profile.lengths[k] / SAMPLES as f64;
    let wheels = |at: f64| from + (to - from) * (at / SAMPLES as f64);
    let mut attitudes = vec![profile.attitudes[k]];
    for i in 0..SAMPLES {
        let q = attitudes[i];
        let rate = dynamics.rate(&q, &wheels(i as f64));
        let middle = q.retract(rate * (step / 2.0));
        let rate = dynamics.rate(&middle, &wheels(i as f64 + 0.5));
        attitudes.push(q.retract(rate * step));
    }
    // The midpoint rule drifts by little; the known end takes most of that away.
    let drift = attitudes[SAMPLES]
        .signed_turn_to(&profile.attitudes[k + 1].nearest_sign(&attitudes[SAMPLES]));
    let usage = |(i, q): (usize, &Attitude)| {
        let at = i as f64;
        let (q, wheels) = (q.retract(drift * (at / SAMPLES as f64)), wheels(at));
        dynamics.speed_usage(&dynamics.rate(&q, &wheels), &wheels)
    };
    attitudes.iter().enumerate().map(usage).collect()
}

/// Greatest value of samples and of the parabolas through each three of them.
fn peak(samples: &[f64]) -> f64 {
    let highest = samples.iter().copied().fold(0.0, f64::max);
    samples.windows(3).fold(highest, |highest, three| {
        let (slope, bend) = (three[2] - three[0], 2.0 * three[1] - three[0] - three[2]);
        let inside = bend > 0.0 && slope.abs() <= 2.0 * bend;
        let vertex = three[1] + slope * slope / (8.0 * bend);
        if inside { highest.max(vertex) } else { highest }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_between_samples_is_found_and_one_outside_is_not() {
        let arc = |top: f64| -> Vec<f64> {
            let at = |i: i32| 1.005 - 0.5 * (f64::from(i) / 16.0 - top).powi(2);
            (0..=16).map(at).collect()
        };
        for top in [0.03, 0.47, 0.97] {
            assert!((peak(&arc(top)) - 1.005).abs() < 1e-12);
        }
        assert!(peak(&arc(1.1)) <= 1.0);
    }
}
