//! The strongest bound is that of trying every box, as long as few are worth it.

use super::*;
use crate::bounds::certify;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::math::random::SplitMix;
use crate::model::random::{between, direction};
use nalgebra::Vector3;

const TOLERANCE: f64 = 1e-4;

fn random_vector(random: &mut SplitMix, low: f64, high: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| between(random, low, high))
}

#[test]
fn few_boxes_give_what_all_give() {
    let mut random = SplitMix::new(31);
    for case in 0..60 {
        let bounds: Vec<_> = (0..=(case % 2))
            .map(|_| {
                let limits = SlewLimits {
                    rates_rad_s: random_vector(&mut random, 0.02, 0.06),
                    accelerations_rad_s2: random_vector(&mut random, 0.002, 0.006),
                };
                SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits")
            })
            .collect();
        let turns: Vec<_> = bounds
            .iter()
            .map(|_| direction(&mut random) * between(&mut random, 0.01, 3.0))
            .map(Attitude::from_rotation_vector)
            .collect();
        let mut alternatives = Alternatives::default();
        for (bound, turn) in bounds.iter().zip(&turns) {
            alternatives.add(bound, *turn, GivenAway::default());
        }
        let all = bounds
            .iter()
            .zip(&turns)
            .map(|(bound, turn)| bound.lower_bound_s(&[*turn], TOLERANCE));
        let all = all.fold(0.0, f64::max);
        let found = alternatives.strongest(TOLERANCE).expect("a bound");
        assert!(found.bound_s <= all, "case {case}");
        assert!(
            found.bound_s >= all * (1.0 - 1e-2),
            "case {case}: {} of {all}",
            found.bound_s
        );
        let certificate = alternatives.certificate(&found, TOLERANCE);
        assert_eq!(certificate.duration_s.to_bits(), found.bound_s.to_bits());
        assert_eq!(certify::verify(&certificate), Ok(()), "case {case}");
    }
}

#[test]
fn no_turn_has_a_bound_of_zero_and_no_alternatives_have_none() {
    assert_eq!(Alternatives::default().strongest(TOLERANCE), None);
    let limits = SlewLimits {
        rates_rad_s: Vector3::repeat(0.05),
        accelerations_rad_s2: Vector3::repeat(0.005),
    };
    let bound = SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits");
    let bound = bound.missing(1e-6);
    let mut alternatives = Alternatives::default();
    alternatives.add(&bound, Attitude::identity(), GivenAway::default());
    let found = alternatives.strongest(TOLERANCE).expect("a bound");
    assert!(found.bound_s.abs() <= 0.0);
}
