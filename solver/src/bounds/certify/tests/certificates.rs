//! Certificates are confirmed and damaged ones rejected. (`tests/examples/bound_trials.rs` has many
//! more cases.)

use super::*;
use crate::bounds::kinematic::RateBox;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::model::attitude::Attitude;
use proptest::prelude::*;

const PAPER: [f64; 3] = [0.018_098_04, 0.013_482_02, 0.012_460_02];

fn turn(vector: [f64; 3]) -> Attitude {
    Attitude::from_rotation_vector(vector.into())
}

fn certified(turn: &Attitude, least_s: f64) -> CertifiedTurn {
    CertifiedTurn {
        turn: *turn,
        least_s,
    }
}

fn ratios() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        3 => prop::array::uniform3(0.2..1.0_f64),
        1 => Just(PAPER),
        1 => Just([1.0; 3]),
        1 => Just([1.0, 1.0 - 1e-7, 1.0 - 3e-7]),
        1 => Just([0.4, 0.4, 1.0]),
        1 => Just([0.4, 1.0, 1.0]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn least_times_are_confirmed_and_larger_ones_refuted(rates in ratios(), vector in prop::array::uniform3(-2.0..2.0_f64), small in prop::bool::weighted(0.2)) {
        let target = turn(vector.map(|x| if small { 0.02 * x } else { x }));
        let table = RateBox::new(rates.into()).expect("ordinary rates");
        let answer = table.query(&target, 1e-6);
        let rates = rates.into();
        let room = 1.0 - 2e-6;
        prop_assert_eq!(verify_turn(&rates, &certified(&target, answer.lower_s * room)), Ok(()));
        // The two lists of extremals have the same minimum.
        let more = answer.upper_s * (1.0 + 1e-5);
        match verify_turn(&rates, &certified(&target, more)) {
            Err(Rejection::Faster { time_s, .. }) => {
                prop_assert!(time_s < more);
                prop_assert!(time_s >= answer.lower_s * (1.0 - 1e-6));
            }
            other => prop_assert!(false, "{:?} for {:?}", other, answer),
        }
    }

    #[test]
    fn turns_about_and_near_an_axis_are_confirmed(rates in ratios(), axis in 0..3_usize, angle in 0.02..3.1_f64, off in -3.0..-1.0_f64, vector in prop::array::uniform3(-1.0..1.0_f64)) {
        let table = RateBox::new(rates.into()).expect("ordinary rates");
        let about = Vector3::ith(axis, angle);
        for target in [about, about + Vector3::from(vector) * 10.0_f64.powf(off)] {
            let target = Attitude::from_rotation_vector(target);
            let least_s = table.lower_bound(&target, 1e-4) * (1.0 - 2e-6);
            prop_assert_eq!(verify_turn(&rates.into(), &certified(&target, least_s)), Ok(()));
        }
    }

    #[test]
    fn certificates_of_slews_are_confirmed_and_damaged_ones_rejected(
        rates in ratios(),
        ramps in prop::array::uniform3(0.1..2.0_f64),
        first in prop::array::uniform3(-1.5..1.5_f64),
        second in prop::option::of(prop::array::uniform3(-1.5..1.5_f64)),
        free in 0..8_u8,
        damage in 0..5_u8,
    ) {
        let rates = Vector3::from(rates);
        // Ramp times in units of the time for a radian at the largest rate.
        let limits = SlewLimits {
            rates_rad_s: rates,
            accelerations_rad_s2: rates.component_div(&(Vector3::from(ramps) / rates.max())),
        };
        let end = Vector3::from_fn(|i, _| if free >> i & 1 == 1 { f64::INFINITY } else { 0.0 });
        let ends = EndRates { begin_rad_s: Vector3::zeros(), end_rad_s: end };
        let turns: Vec<_> = std::iter::once(first).chain(second).map(turn).collect();
        let bound = SlewBound::new(limits, ends).expect("ordinary limits");
        let good = bound.certificate(&turns, 1e-4);
        prop_assert_eq!(good.duration_s.to_bits(), bound.lower_bound_s(&turns, 1e-4).to_bits());
        prop_assert_eq!(verify(&good), Ok(()));

        let mut bad = good.clone();
        match damage {
            0 => bad.duration_s *= 1.0 + 1e-5,
            1 => bad.turns[0].least_s *= 1.0 + 1e-3,
            2 => bad.limits.accelerations_rad_s2 *= 1.001,
            3 => bad.box_rad_s *= 1.001,
            _ => bad.turns[0].turn = Attitude::identity(),
        }
        let rejection = verify(&bad).expect_err("the certificate is damaged");
        match damage {
            0 => prop_assert!(matches!(rejection, Rejection::Link { .. }), "{}", rejection),
            1 | 4 => prop_assert!(matches!(rejection, Rejection::Faster { turn: 0, .. }), "{}", rejection),
            _ => {}
        }
    }
}

#[test]
fn certificates_with_invalid_numbers_are_malformed() {
    let limits = SlewLimits {
        rates_rad_s: PAPER.into(),
        accelerations_rad_s2: Vector3::from(PAPER) / 12.0,
    };
    let bound = SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits");
    let good = bound.certificate(&[turn([0.3, 0.4, -0.5])], 1e-4);
    assert_eq!(verify(&good), Ok(()));
    let damages: [fn(&mut Certificate); 5] = [
        |bad| bad.limits.rates_rad_s.x = 0.0,
        |bad| bad.ends.end_rad_s.y = f64::NAN,
        |bad| bad.turns[0].least_s = f64::NAN,
        |bad| bad.duration_s = f64::INFINITY,
        |bad| bad.box_rad_s.z = -1.0,
    ];
    for damage in damages {
        let mut bad = good.clone();
        damage(&mut bad);
        assert!(
            matches!(verify(&bad), Err(Rejection::Malformed { .. })),
            "{bad:?}"
        );
    }
}

#[test]
fn the_identity_takes_no_time() {
    let rates = Vector3::from(PAPER);
    assert_eq!(
        verify_turn(&rates, &certified(&Attitude::identity(), 0.0)),
        Ok(())
    );
    assert!(matches!(
        verify_turn(&rates, &certified(&Attitude::identity(), 1.0)),
        Err(Rejection::Faster { .. })
    ));
}
