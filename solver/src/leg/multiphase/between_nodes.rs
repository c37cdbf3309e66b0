//! Limits inside intervals: the program imposes them at nodes and in the middle of intervals only.

use super::LIMIT_TOLERANCE;
use crate::leg::profile::Profile;
use crate::leg::transcription::ConeDepth;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use crate::model::dynamics::Dynamics;
use nalgebra::DVector;

/// Equal parts of an interval at whose ends the limits are evaluated: the body may turn by a radian
/// on a long interval, and the stored momentum turns with it in body axes.
const SAMPLES: usize = 16;

/// Whether no limit is exceeded between the nodes of a motion.
pub(crate) fn keeps_limits_inside(dynamics: &Dynamics, profile: &Profile) -> bool {
    let excesses = excess_between_nodes(dynamics, profile);
    excesses.iter().all(|excess| *excess <= LIMIT_TOLERANCE)
}

/// Relative excess over every speed and rate limit inside every interval, in the order of
/// [`Dynamics::limit_shares`]; empty without momentum. Wheel momenta are linear there, but the
/// turn of the stored momentum bends the rates.
pub(super) fn excess_between_nodes(dynamics: &Dynamics, profile: &Profile) -> Vec<f64> {
    if !dynamics.has_momentum() {
        // Rates are linear between nodes, and so is every limit, or convex.
        return Vec::new();
    }
    (0..profile.intervals())
        .flat_map(|k| shares_inside(dynamics, profile, k))
        .map(|shares| excess_inside(&shares))
        .collect()
}

/// Depths, rad, of the motion inside every cone at both ends of every interval, and of the deepest
/// point between them where no end is as deep; the cones of one interval after the other.
pub(super) fn depths_between_nodes(dynamics: &Dynamics, profile: &Profile) -> Vec<ConeDepth> {
    if dynamics.cones.is_empty() {
        return Vec::new();
    }
    let inside = |k: usize| {
        let begin = std::iter::once(profile.attitudes[k]);
        let attitudes: Vec<_> = begin
            .chain(attitudes_inside(dynamics, profile, k))
            .collect();
        depths_inside(&dynamics.cones, &attitudes)
    };
    (0..profile.intervals()).flat_map(inside).collect()
}

/// Depths, rad, inside every cone along an interval, of which these are the attitudes at even times,
/// both ends included.
pub(crate) fn depths_inside(cones: &[ForbiddenCone], attitudes: &[Attitude]) -> Vec<ConeDepth> {
    let depth = |cone: &ForbiddenCone| {
        let depths: Vec<f64> = attitudes.iter().map(|q| cone.depth(q)).collect();
        let at_ends = [depths[0], depths[depths.len() - 1]];
        let peak = peak(&depths);
        ConeDepth {
            at_ends,
            between: (peak > at_ends[0].max(at_ends[1])).then_some(peak),
        }
    };
    cones.iter().map(depth).collect()
}

/// Greatest depth between nodes, rad, at least zero.
pub(crate) fn deepest(depths: &[ConeDepth]) -> f64 {
    let between = depths.iter().filter_map(|depth| depth.between);
    between.fold(0.0, f64::max)
}

/// Excess over one of the peak of a share's absolute value, where the peak lies between the ends;
/// `shares` are samples at even times, both ends included.
pub(crate) fn excess_inside(shares: &[f64]) -> f64 {
    let over = |sign: f64| {
        let usage: Vec<_> = shares.iter().map(|share| sign * share).collect();
        let peak = peak(&usage);
        if peak > usage[0].max(usage[usage.len() - 1]) {
            (peak - 1.0).max(0.0)
        } else {
            0.0
        }
    };
    over(1.0).max(over(-1.0))
}

/// Every limit's share at even times of an interval, both ends included.
fn shares_inside(dynamics: &Dynamics, profile: &Profile, k: usize) -> Vec<Vec<f64>> {
    let mut shares = vec![Vec::with_capacity(SAMPLES + 1); dynamics.wheel_count() + 4];
    for (q, wheels) in states_inside(dynamics, profile, k) {
        let rate = dynamics.rate(&q, &wheels);
        for (series, share) in shares.iter_mut().zip(dynamics.limit_shares(&rate, &wheels)) {
            series.push(share);
        }
    }
    shares
}

/// Attitudes at even times of an interval, without its begin.
pub(crate) fn attitudes_inside(
    dynamics: &Dynamics,
    profile: &Profile,
    k: usize,
) -> impl Iterator<Item = Attitude> {
    let states = states_inside(dynamics, profile, k).into_iter();
    states.skip(1).map(|(attitude, _)| attitude)
}

/// Attitudes and wheel momenta at even times of an interval, both ends included.
fn states_inside(
    dynamics: &Dynamics,
    profile: &Profile,
    k: usize,
) -> Vec<(Attitude, DVector<f64>)> {
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
    // Spread the small drift of the midpoint rule, known at the end, over the samples.
    let drift = attitudes[SAMPLES]
        .signed_turn_to(&profile.attitudes[k + 1].nearest_sign(&attitudes[SAMPLES]));
    let nodes = attitudes.iter().enumerate();
    nodes
        .map(|(i, q)| {
            let at = i as f64;
            (q.retract(drift * (at / SAMPLES as f64)), wheels(at))
        })
        .collect()
}

/// Greatest value of samples and of the parabolas through each three of them.
fn peak(samples: &[f64]) -> f64 {
    let highest = samples.iter().copied().fold(f64::MIN, f64::max);
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
