//! The constructed leg, which exists wherever the wheels can hold the momentum.

use super::*;
use crate::leg::multiphase::keeps_limits_inside;
use crate::model::spec::{Accuracy, StateSpec, WheelSpec};
use proptest::prelude::*;

/// Wheels of a pyramid whose spin axes rise by this angle, rad, from a plane.
fn pyramid(count: usize, rise: f64) -> Vec<WheelSpec> {
    let wheel = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / count as f64;
        WheelSpec {
            axis: [
                rise.cos() * angle.cos(),
                rise.cos() * angle.sin(),
                rise.sin(),
            ],
            normalize_axis: true,
            inertia_kg_m2: 0.01,
            max_torque_nm: 0.1,
            min_torque_nm: Some(-0.07),
            max_speed_rad_s: Some(400.0),
            enabled: true,
        }
    };
    (0..count).map(wheel).collect()
}

/// Momentum, N m s, that the wheels of a pyramid hold in every direction: the least support of the
/// zonotope over the directions across pairs of axes.
fn sphere(dynamics: &Dynamics) -> f64 {
    let mut least = f64::INFINITY;
    for one in &dynamics.actuators {
        for other in &dynamics.actuators {
            if let Some(across) = one.axis.cross(&other.axis).try_normalize(1e-9) {
                let wheels = dynamics.actuators.iter();
                let held = wheels
                    .map(|wheel| across.dot(&wheel.axis).abs() * wheel.inertia * wheel.max_speed);
                least = least.min(held.sum());
            }
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn inside_the_sphere_every_turn_is_constructed(
        count in 3_usize..7,
        rise in 0.3_f64..1.1,
        share in 0.0_f64..0.97,
        stored in prop::array::uniform3(-1.0_f64..1.0),
        turn in prop::array::uniform3(-1.8_f64..1.8),
        limit_deg_s in 0.05_f64..3.0,
        rates in prop::array::uniform2(0.0_f64..0.3),
    ) {
        let limit = limit_deg_s.to_radians();
        let mut dynamics = dynamics(|spec| {
            spec.spacecraft.inertia_kg_m2 = [[100.0, 3.0, 2.0], [3.0, 120.0, -4.0], [2.0, -4.0, 80.0]];
            spec.spacecraft.wheels = pyramid(count, rise);
            spec.spacecraft.max_body_rate_rad_s = [Some(limit), None, Some(2.0 * limit)];
            spec.start = StateSpec::default();
        });
        let direction = Vector3::from(stored).try_normalize(1e-3).unwrap_or(Vector3::x());
        dynamics.momentum = direction * (share * sphere(&dynamics));
        let null = DVector::zeros(count - 3);
        let end = |attitude: Attitude, rate: f64| Waypoint {
            attitude,
            roll: None,
            rate: [RateCondition::Fixed(rate * limit), RateCondition::Free, RateCondition::Fixed(0.0)],
            wheels: WheelCondition::Free,
            costates: None,
        };
        // Rates at the ends only where the wheels can hold their momentum too.
        let room = if share < 0.6 { 1.0 } else { 0.0 };
        let from = end(Attitude::identity(), rates[0] * room);
        let to = end(Attitude::from_rotation_vector(turn.into()), -rates[1] * room);
        let leg = LegProblem {
            dynamics: &dynamics,
            from: &from,
            to: &to,
            arrival: Arrival::Rotation,
            null: &null,
            extremals: &KinematicExtremals::of(&dynamics),
            resolution: Resolution::of(Accuracy::Standard, &dynamics),
        };
        let solution = steered(&leg).expect("a solution");
        prop_assert_eq!(solution.status, NlpStatus::Constructed);
        let profile = &solution.profile;
        let last = profile.intervals();
        prop_assert_eq!(&solution.intervals, &vec![last]);
        prop_assert!(profile.attitudes[last].turn_to(&to.attitude).angle_to(&Attitude::identity()) < 1e-9);
        for (node, place) in [(0, &from), (last, &to)] {
            let rate = dynamics.rate(&profile.attitudes[node], &profile.wheels[node]);
            let RateCondition::Fixed(wanted) = place.rate[0] else { unreachable!() };
            prop_assert!((rate.x - wanted).abs() < 1e-9 && rate.z.abs() < 1e-9, "{rate}");
        }
        prop_assert!(keeps_limits_inside(&dynamics, profile));
        for (pair, length) in profile.wheels.windows(2).zip(&profile.lengths) {
            prop_assert!(dynamics.torque_usage(&((&pair[1] - &pair[0]) / *length)) <= 1.0);
        }
    }
}
