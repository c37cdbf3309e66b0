//! Bounds on slews with limited accelerations.

use super::super::drift::{DriftingSlew, drifting_bound};
use super::super::limits::{EndRates, SlewLimits};
use super::super::ramps::SlewBound;
use super::super::rate_envelope::RateEnvelope;
use super::{PAPER, rate_box, turn};
use crate::model::attitude::Attitude;
use nalgebra::Vector3;
use slewplan_tests::random::Generator;

const FREE: f64 = f64::INFINITY;

fn ends(begin: [f64; 3], end: [f64; 3]) -> EndRates {
    EndRates {
        begin_rad_s: begin.into(),
        end_rad_s: end.into(),
    }
}

/// Limits with one ramp time for all axes.
fn equal(rates: [f64; 3], ramp: f64) -> SlewLimits {
    SlewLimits {
        rates_rad_s: rates.into(),
        accelerations_rad_s2: Vector3::from(rates) / ramp,
    }
}

fn bound(limits: SlewLimits, ends: EndRates, turns: &[Attitude]) -> f64 {
    SlewBound::new(limits, ends)
        .expect("ordinary limits")
        .lower_bound_s(turns, 1e-6)
}

fn assert_close(value: f64, expected: f64) {
    assert!(
        (value / expected - 1.0).abs() < 3e-6,
        "{value} instead of {expected}"
    );
}

#[test]
fn equal_ramps_have_closed_forms() {
    let ramp = 11.88;
    for vector in [[0.2, -1.0, 0.7], [0.01, 0.02, 0.03], [0.05, 0.0, 0.1]] {
        let v = rate_box(PAPER).lower_bound(&turn(vector), 1e-6);
        let limits = equal(PAPER, ramp);
        let rest = if v >= ramp {
            v + ramp
        } else {
            2.0 * (ramp * v).sqrt()
        };
        assert_close(bound(limits, EndRates::at_rest(), &[turn(vector)]), rest);
        let half = if v >= 0.5 * ramp {
            v + 0.5 * ramp
        } else {
            (2.0 * ramp * v).sqrt()
        };
        for one in [ends([0.0; 3], [FREE; 3]), ends([FREE; 3], [0.0; 3])] {
            assert_close(bound(limits, one, &[turn(vector)]), half);
        }
        assert_close(
            bound(limits, ends([FREE; 3], [FREE; 3]), &[turn(vector)]),
            v,
        );
    }
}

#[test]
fn the_ramps_of_a_tour_with_free_targets_count_once() {
    let turns = [
        turn([0.5, 0.2, -1.0]),
        turn([1.0, -0.4, 0.3]),
        turn([0.0, 0.9, 0.1]),
    ];
    let v: f64 = turns
        .iter()
        .map(|turn| rate_box(PAPER).lower_bound(turn, 1e-6))
        .sum();
    assert_close(
        bound(equal(PAPER, 10.0), EndRates::at_rest(), &turns),
        v + 10.0,
    );
}

#[test]
fn a_turn_about_a_stopped_axis_includes_its_ramps() {
    // A turn about z, with z the only component that is stopped.
    let limits = equal([1.0, 1.0, 1.0], 0.2);
    let z_only = ends([FREE, FREE, 0.0], [FREE, FREE, 0.0]);
    let plain = rate_box([1.0; 3]).lower_bound(&turn([0.0, 0.0, 0.6]), 1e-6);
    let bound = bound(limits, z_only, &[turn([0.0, 0.0, 0.6])]);
    assert!(bound > plain + 0.05, "{bound} is hardly more than {plain}");
}

/// Random rates within limits.
fn share_of(limits: &SlewLimits, generator: &mut Generator) -> Vector3<f64> {
    limits
        .rates_rad_s
        .component_mul(&Vector3::from(generator.vector(-1.0, 1.0)))
}

/// Duration, end rates and final attitude of a random ramped motion: rates change linearly between
/// values within the limits, slowly enough for the limits of the accelerations.
fn ramped_motion(generator: &mut Generator, limits: &SlewLimits) -> (f64, EndRates, Attitude) {
    let mut rate = share_of(limits, generator);
    if generator.below(3) == 0 {
        rate.fill(0.0);
    }
    let begin = rate;
    let (mut at, mut duration) = (Attitude::identity(), 0.0);
    for leg in 0..3 {
        let mut next = share_of(limits, generator);
        if leg == 2 {
            next[generator.below(3)] = 0.0;
        }
        let ramp = (next - rate)
            .abs()
            .component_div(&limits.accelerations_rad_s2)
            .max();
        let hold = generator.between(0.0, 2.0) * ramp;
        let steps = 400;
        for step in 0..steps {
            let share = (f64::from(step) + 0.5) / f64::from(steps);
            at = at.retract((rate + (next - rate) * share) * (ramp / f64::from(steps)));
        }
        at = at.retract(next * hold);
        duration += ramp + hold;
        rate = next;
    }
    (duration, ends(begin.abs().into(), rate.abs().into()), at)
}

#[test]
fn no_ramped_motion_beats_the_bound() {
    let mut generator = Generator::new(9);
    let mut closest = 0.0;
    for accelerations in [[0.5, 0.5, 0.5], [0.2, 1.0, 3.0], [4.0, 0.3, 0.6]] {
        let limits = SlewLimits {
            rates_rad_s: Vector3::new(1.0, 0.8, 0.6),
            accelerations_rad_s2: accelerations.into(),
        };
        for _ in 0..20 {
            let (duration, ends, target) = ramped_motion(&mut generator, &limits);
            let least = bound(limits, ends, &[target]);
            assert!(least <= duration, "{least} against {duration}, {ends:?}");
            closest = f64::max(closest, least / duration);
        }
    }
    assert!(closest > 0.3, "the bounds are loose: {closest}");
}

#[test]
fn bounds_on_single_axis_rest_to_rest_slews_are_nearly_exact() {
    // About one axis the optimal rate is a triangle or a trapezoid.
    let limits = SlewLimits {
        rates_rad_s: Vector3::new(1.0, 0.05, 0.05),
        accelerations_rad_s2: Vector3::new(0.5, 0.025, 0.025),
    };
    for (angle, duration) in [(0.02, 0.4), (0.5, 2.0)] {
        let least = bound(limits, EndRates::at_rest(), &[turn([angle, 0.0, 0.0])]);
        assert!(
            least <= duration && least > 0.98 * duration,
            "{least} instead of {duration}"
        );
    }
}

#[test]
fn bad_limits_are_refused() {
    let good = equal([1.0; 3], 1.0);
    let bad_limits = [[0.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, f64::NAN]];
    for bad in bad_limits {
        let limits = SlewLimits {
            accelerations_rad_s2: bad.into(),
            ..good
        };
        assert!(
            SlewBound::new(limits, EndRates::at_rest()).is_none(),
            "{bad:?}"
        );
        let limits = SlewLimits {
            rates_rad_s: bad.into(),
            ..good
        };
        assert!(
            SlewBound::new(limits, EndRates::at_rest()).is_none(),
            "{bad:?}"
        );
    }
    assert!(SlewBound::new(good, ends([-1.0, 0.0, 0.0], [0.0; 3])).is_none());
    assert!(SlewBound::new(good, ends([0.0; 3], [f64::NAN, 0.0, 0.0])).is_none());
    assert!(bound(good, EndRates::at_rest(), &[Attitude::identity()]).abs() < f64::MIN_POSITIVE);
}

#[test]
fn the_bound_with_zero_drift_equals_the_bound_without() {
    let limits = SlewLimits {
        rates_rad_s: Vector3::new(1.0, 0.8, 0.6),
        accelerations_rad_s2: Vector3::new(0.4, 1.0, 2.0),
    };
    let bound = SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits");
    for vector in [[0.2, -1.0, 0.7], [0.01, 0.02, 0.03], [2.0, 0.5, -1.0]] {
        let turn = turn(vector);
        let plain = bound.lower_bound_s(&[turn], 1e-6);
        let seen = DriftingSlew {
            bound: &bound,
            turn,
            drift: Vector3::zeros(),
            envelope: bound.envelope,
        };
        let marched = drifting_bound(&[seen], 0.0, (99, 1e-6)).duration_s;
        assert_close(marched, plain);
    }
}

#[test]
fn no_drifting_motion_beats_the_bound() {
    let mut generator = Generator::new(11);
    let limits = SlewLimits {
        rates_rad_s: Vector3::new(1.0, 0.8, 0.6),
        accelerations_rad_s2: Vector3::new(0.7, 2.0, 3.0),
    };
    let any = SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits");
    let mut sharper = 0;
    for _ in 0..60 {
        let (duration, ends, relative) = ramped_motion(&mut generator, &limits);
        let drift = Vector3::from(generator.direction()) * generator.between(0.0, 0.5);
        // The turn of the drift in space precedes that of the relative motion.
        let target = Attitude::from_rotation_vector(drift * duration).then_in_body(&relative);
        let seen = DriftingSlew {
            bound: &any,
            turn: target,
            drift,
            envelope: RateEnvelope { limits, ends },
        };
        let least = drifting_bound(&[seen], 0.0, (99, 1e-4)).duration_s;
        assert!(least <= duration, "{least} against {duration}, {ends:?}");
        // A plain box that contains the drift in all directions gives a weaker bound.
        let wider = SlewLimits {
            rates_rad_s: limits.rates_rad_s.add_scalar(drift.norm()),
            ..limits
        };
        let free = EndRates {
            begin_rad_s: Vector3::repeat(FREE),
            end_rad_s: Vector3::repeat(FREE),
        };
        sharper += i32::from(least > bound(wider, free, &[target]));
    }
    assert!(sharper > 40, "{sharper} of 60 only");
}

#[test]
fn a_turn_along_the_drift_takes_the_time_of_the_summed_rates() {
    // About the only fast axis, at the rate 1 plus the drift.
    let limits = equal([1.0, 0.05, 0.05], 1e-6);
    let bound = SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits");
    for drift in [0.5, -0.5] {
        let expected = 1.0 / (1.0 + drift);
        let drift = Vector3::new(drift, 0.0, 0.0);
        let seen = DriftingSlew {
            bound: &bound,
            turn: turn([1.0, 0.0, 0.0]),
            drift,
            envelope: bound.envelope,
        };
        let least = drifting_bound(&[seen], 0.0, (99, 1e-6)).duration_s;
        assert!(
            least <= expected && least > 0.98 * expected,
            "{least} instead of {expected}"
        );
    }
}
