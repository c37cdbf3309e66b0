//! Each premise of a certificate, tightened beyond what the scenario supports.

use super::*;
use crate::bounds::certify;
use crate::bounds::kinematic::certificate::DriftCertificate;
use crate::model::scenario::reference::experiment_a;
use crate::tour::planner::places::Places;

/// A scenario with a locked, spinning wheel and bounded rates at its first target.
fn scenario() -> Scenario {
    let mut spec = experiment_a();
    spec.spacecraft.inertia_kg_m2 = [[6.6, 0.3, -0.2], [0.3, 8.9, 0.1], [-0.2, 0.1, 9.6]];
    spec.spacecraft.max_body_rate_norm_rad_s = Some(0.05);
    let mut locked = spec.spacecraft.wheels[1].clone();
    locked.enabled = false;
    spec.spacecraft.wheels.push(locked);
    spec.start.wheel_speed_rad_s = Some(vec![0.0, -100.0, 0.0, 100.0]);
    for wheel in &mut spec.spacecraft.wheels {
        wheel.min_torque_nm = Some(-0.006);
    }
    let target = &mut spec.targets[0];
    target.zero_rate_axes = None;
    target.rate_min_rad_s = Some([Some(-0.03), None, Some(0.0)]);
    target.rate_max_rad_s = Some([Some(0.0), Some(0.01), Some(0.0)]);
    Scenario::try_new(&spec).expect("valid").scenario
}

/// A part of the expected objection, and a change of a certificate.
type Case<C> = (&'static str, fn(&mut C));

/// Asserts that a certificate is rejected after each of the changes.
fn assert_rejected<C: Clone>(
    good: &C,
    cases: &[Case<C>],
    check: impl Fn(&C) -> Result<(), &'static str>,
) {
    for (expected, change) in cases {
        let mut bad = good.clone();
        change(&mut bad);
        let message = check(&bad).expect_err(expected);
        assert!(
            message.contains(expected),
            "{message} instead of {expected}"
        );
    }
}

#[test]
fn tightened_premises_are_rejected() {
    let scenario = scenario();
    let places = Places::of(&scenario);
    assert!(!places.dynamics.has_momentum());
    let route = [Place::Start, Place::Target(0)];
    let [from, to] = route.map(|place| places.waypoint(place));
    let (axes, good) = places.certified.certificate(&from, &to).expect("a bound");
    assert_eq!(check(&scenario, route, &axes, &good), Ok(()));
    let backwards = [route[1], route[0]];
    check(&scenario, backwards, &axes, &good).expect_err("another turn");
    let cases: [Case<Certificate>; 8] = [
        ("met more exactly", |c| c.attitude_tolerance_rad = 0.999e-6),
        ("rates below", |c| c.limits.rates_rad_s /= 1.000_001_1),
        ("at the beginning below", |c| c.ends.begin_rad_s.x = 0.0),
        ("rates below", |c| c.limits.rates_rad_s.z *= 0.999),
        ("accelerations below", |c| {
            c.limits.accelerations_rad_s2.x *= 0.999;
        }),
        ("at the end below", |c| c.ends.end_rad_s.x = 0.0),
        ("another turn", |c| {
            c.turns[0].turn = c.turns[0].turn.turn_to(&c.turns[0].turn);
        }),
        ("one turn", |c| c.turns.push(c.turns[0])),
    ];
    assert_rejected(&good, &cases, |bad| check(&scenario, route, &axes, bad));
    let message = check(&scenario, route, &(axes * 1.001), &good).expect_err("axes");
    assert!(message.contains("orthonormal"), "{message}");
}

#[test]
fn tightened_premises_of_norms_are_rejected() {
    let scenario = Scenario::try_new(&experiment_a()).expect("valid").scenario;
    let places = Places::of(&scenario);
    let route = [Place::Target(0), Place::Target(1)];
    let [from, to] = route.map(|place| places.waypoint(place));
    let angle = from.attitude.angle_to(&to.attitude);
    let beyond = places.certified.beyond([&from, &to], angle, 1.0);
    let beyond = beyond.expect("a bound");
    let good = beyond.certificate.expect("a certificate");
    assert_eq!(check_norm(&scenario, route, &good), Ok(()));
    assert_eq!(certify::verify_norm(&good), Ok(()));
    let backwards = [route[1], route[0]];
    check_norm(&scenario, backwards, &good).expect_err("another turn");
    let cases: [Case<NormCertificate>; 7] = [
        ("met more exactly", |c| c.attitude_tolerance_rad = 0.999e-6),
        ("rates below", |c| c.facets[0].share.most *= 0.999),
        ("accelerations below", |c| c.facets[1].share.slope *= 0.999),
        ("at the beginning below", |c| {
            c.facets[0].share.ends[0] = 0.0;
        }),
        ("at the end below", |c| c.facets[0].share.ends[1] = 0.0),
        ("rates below", |c| {
            let frame = c.frame.as_mut().expect("a frame");
            frame.limits.rates_rad_s.y *= 0.999;
        }),
        ("orthonormal", |c| {
            c.frame.as_mut().expect("a frame").axes *= 1.001;
        }),
    ];
    assert_rejected(&good, &cases, |bad| check_norm(&scenario, route, bad));
    let damages: [fn(&mut NormCertificate); 3] = [
        |c| c.duration_s *= 1.001,
        |c| c.turn.least_s *= 1.01,
        |c| c.facets.truncate(2),
    ];
    for damage in damages {
        let mut bad = good.clone();
        damage(&mut bad);
        certify::verify_norm(&bad).expect_err("a damaged certificate");
    }
}

#[test]
fn tightened_premises_with_momentum_are_rejected() {
    let mut spec = experiment_a();
    spec.spacecraft.inertia_kg_m2 = [[8.7, 0.1, -0.2], [0.1, 8.9, 0.1], [-0.2, 0.1, 9.2]];
    spec.spacecraft.max_body_rate_rad_s = [None; 3];
    spec.start.wheel_speed_rad_s = Some(vec![1500.0, -1000.0, 600.0]);
    for wheel in &mut spec.spacecraft.wheels {
        wheel.max_speed_rad_s = Some(2000.0);
    }
    spec.options.momentum_authority = 0.9;
    spec.targets[0].zero_rate_axes = Some([true; 3]);
    spec.targets[1].zero_rate_axes = Some([true; 3]);
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let places = Places::of(&scenario);
    assert!(places.dynamics.has_momentum());
    let momentum = &places.dynamics.momentum;
    let drifting = (2..5).find_map(|target| {
        let route = [1, target].map(Place::Target);
        let [from, to] = route.map(|place| places.waypoint(place));
        let good = places.certified.drift_certificate(&from, &to, momentum)?;
        let is_drifting = good.steps.iter().any(|step| step.share > 0.0);
        (is_drifting && good.steps.len() > 1).then_some((route, good))
    });
    let (route, good) = drifting.expect("a drift helps");
    assert_eq!(check_drift(&scenario, route, &good), Ok(()));
    assert_eq!(certify::verify_drift(&good), Ok(()));
    let backwards = [route[1], route[0]];
    check_drift(&scenario, backwards, &good).expect_err("another turn");
    let cases: [Case<DriftCertificate>; 8] = [
        ("met more exactly", |c| c.attitude_tolerance_rad = 0.999e-6),
        ("rates below", |c| c.steps[0].limits.rates_rad_s.z *= 0.999),
        ("accelerations below", |c| {
            c.steps[0].limits.accelerations_rad_s2.x *= 0.999;
        }),
        ("at the beginning below", |c| {
            c.steps[0].ends.begin_rad_s.x = 0.0;
        }),
        ("at the end below", |c| c.steps[0].ends.end_rad_s.x = 0.0),
        ("another turn", |c| c.steps[1].from_s *= 0.999),
        ("another drift", |c| {
            for step in &mut c.steps {
                step.drifts_rad_s[0] *= 0.999;
                step.share += 1e-6;
            }
        }),
        ("orthonormal", |c| c.steps[0].axes *= 1.001),
    ];
    assert_rejected(&good, &cases, |bad| check_drift(&scenario, route, bad));
    // From rest to rest the chord of the growth of the rates counts.
    let route = [0, 1].map(Place::Target);
    let [from, to] = route.map(|place| places.waypoint(place));
    let good = places.certified.drift_certificate(&from, &to, momentum);
    let mut good = good.expect("a bound");
    assert_eq!(check_drift(&scenario, route, &good), Ok(()));
    good.steps[0].limits.accelerations_rad_s2 *= 1.0 - 1e-4;
    let message =
        check_drift(&scenario, route, &good).expect_err("a chord that is not steep enough");
    assert!(message.contains("accelerations below"), "{message}");
}

#[test]
fn the_largest_component_of_a_box_is_at_a_corner() {
    let open = (f64::NEG_INFINITY, f64::INFINITY);
    let cases = [
        (Vector3::x(), [(-0.05, 0.0), open, open], 0.05),
        (Vector3::x(), [(0.02, 0.03), (0.0, 0.0), (0.0, 0.0)], 0.03),
        (
            Vector3::new(0.6, -0.8, 0.0),
            [(-1.0, 2.0), (-3.0, 1.0), open],
            3.6,
        ),
        (
            Vector3::new(0.6, 0.8, 0.0),
            [(0.0, 1.0), open, (0.0, 0.0)],
            f64::INFINITY,
        ),
        (
            Vector3::new(0.6, 0.8, 0.0),
            [open, open, (0.0, 0.0)],
            f64::INFINITY,
        ),
    ];
    for (direction, ranges, expected) in cases {
        let found = over_corners(&direction, &ranges);
        let same = found.total_cmp(&expected).is_eq() || (found - expected).abs() < 1e-12;
        assert!(same, "{direction} {ranges:?}: {found}");
    }
}
