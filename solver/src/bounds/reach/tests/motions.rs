//! Durations of motions that exist, and durations that are too short.

use super::super::SlewsInBox;
use super::super::covering::Covered;
use super::number;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::bounds::kinematic::rate_envelope::RateEnvelope;
use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

const FREE: f64 = f64::INFINITY;
/// Stopped up to the tolerance of the verification.
const STOPPED: f64 = 1e-7;

fn limits() -> SlewLimits {
    SlewLimits {
        rates_rad_s: Vector3::new(0.0181, 0.0135, 0.0125),
        accelerations_rad_s2: Vector3::new(0.00152, 0.00113, 0.00105),
    }
}

/// The slews that make a turn, and the bound on them by a box that does not change.
fn slews(limits: SlewLimits, ends: EndRates, turn: &Attitude) -> (SlewsInBox, f64) {
    let bound = SlewBound::new(limits, ends).expect("ordinary limits");
    let certificate = bound.missing(1e-6).certificate(&[*turn], 1e-4);
    let slews = SlewsInBox::of(&certificate).expect("one turn");
    (slews, certificate.duration_s)
}

/// The turn of the motion along corners of the box that a costate supports, or whose signs do not change.
fn extremal(
    envelope: &RateEnvelope,
    duration: f64,
    costate: &Vector3<f64>,
    switches: bool,
) -> Attitude {
    let steps = 40_000;
    let h = duration / f64::from(steps);
    let mut turn = Matrix3::identity();
    for step in 0..steps {
        let t = (f64::from(step) + 0.5) * h;
        let u = if switches {
            turn.transpose() * costate
        } else {
            *costate
        };
        let rate = Vector3::from_fn(|i, _| envelope.available(i, t, duration).copysign(u[i]));
        turn *= Rotation3::new(rate * h).matrix();
    }
    let q = UnitQuaternion::from_matrix(&turn);
    Attitude::from_xyzw([q.i, q.j, q.k, q.w]).expect("a turn")
}

#[test]
fn of_no_turn_no_duration_is_excluded() {
    let ends = EndRates {
        begin_rad_s: Vector3::new(FREE, FREE, STOPPED),
        end_rad_s: Vector3::new(FREE, FREE, STOPPED),
    };
    let (slews, _) = slews(limits(), ends, &Attitude::identity());
    assert_eq!(slews.longest_excluded_s(0.0), None);
}

#[test]
fn no_motion_within_the_limits_is_excluded() {
    let mut random = SplitMix::new(5);
    let (mut tried, mut open) = (0, 0);
    for number_of in 0..24 {
        let mut limits = limits();
        let mut ends = [Vector3::repeat(FREE); 2];
        for i in 0..3 {
            limits.rates_rad_s[i] *= number(&mut random, 0.8, 1.25);
            limits.accelerations_rad_s2[i] *= number(&mut random, 0.6, 1.6);
            for end in &mut ends {
                if random.below(2) == 0 {
                    end[i] = STOPPED;
                }
            }
        }
        let ends = EndRates {
            begin_rad_s: ends[0],
            end_rad_s: ends[1],
        };
        let duration = number(&mut random, 20.0, 60.0);
        let costate = Vector3::from_fn(|_, _| number(&mut random, -1.0, 1.0)).normalize();
        let envelope = RateEnvelope { limits, ends };
        let turn = extremal(&envelope, duration, &costate, number_of % 3 > 0);
        let (slews, bound) = slews(limits, ends, &turn);
        assert!(bound <= duration, "{bound} {duration}");
        for longer in [1.0 + 1e-6, 1.002] {
            tried += 1;
            match slews.exclude_within(duration * longer, 60_000) {
                Covered::Excluded => panic!("{limits:?} {ends:?} {duration} {turn:?} is excluded"),
                Covered::Open(scale) => {
                    assert!(scale < 1.0);
                    open += 1;
                }
                Covered::GivenUp => {}
            }
        }
    }
    // Those that are given up prove nothing of the test.
    assert!(open > tried / 2, "{open} of {tried}");
}

#[test]
fn slews_with_one_ramp_time_are_bounded_by_their_own_duration() {
    let mut limits = limits();
    limits.accelerations_rad_s2 = limits.rates_rad_s / 12.0;
    let ends = EndRates {
        begin_rad_s: Vector3::repeat(STOPPED),
        end_rad_s: Vector3::repeat(STOPPED),
    };
    let turn = Attitude::from_rotation_vector(Vector3::new(0.5, -0.25, 0.4));
    // The bound of the box is the least duration here, up to its margins.
    let (slews, least_s) = slews(limits, ends, &turn);
    assert!(!slews.excludes(least_s * 1.0001));
    assert!(slews.excludes(least_s * 0.985));
}

#[test]
fn a_component_that_stops_costs_time() {
    let ends = EndRates {
        begin_rad_s: Vector3::repeat(STOPPED),
        end_rad_s: Vector3::new(FREE, FREE, STOPPED),
    };
    let about = |axis: Vector3<f64>, degrees: f64| {
        Attitude::from_rotation_vector(axis * degrees.to_radians())
    };
    let turn = about(Vector3::z(), 10.0).then_in_body(&about(Vector3::x(), 15.0));
    let (slews, boxed_s) = slews(limits(), ends, &turn);
    let excluded_s = slews.longest_excluded_s(boxed_s).expect("a better bound");
    assert!(excluded_s > 1.08 * boxed_s, "{excluded_s} {boxed_s}");
    assert!(slews.excludes(excluded_s));
    assert!(!slews.excludes(1.15 * boxed_s));
}

#[test]
fn a_tiny_turn_has_no_better_bound() {
    let turn = Attitude::from_rotation_vector(Vector3::new(1e-6, 1e-6, 0.0));
    let ends = EndRates::at_rest();
    let (slews, _) = slews(limits(), ends, &turn);
    assert_eq!(slews.longest_excluded_s(0.01), None);
}
