//! Least times within polytopes are confirmed, larger ones are not. (`tests/examples/bound_trials.rs` has many more
//! cases.)

use super::super::polytope::PolytopeProver;
use super::*;
use crate::bounds::kinematic::RateBox;
use crate::bounds::polytope::RatePolytope;
use crate::model::attitude::Attitude;
use slewplan_tests::motions::half_spaces;
use slewplan_tests::random::Generator;
use std::f64::consts::PI;

/// By how much a least time is reduced before it is proved.
const MARGIN: f64 = 5e-5;

fn about(vector: Vector3<f64>) -> Attitude {
    Attitude::from_rotation_vector(vector)
}

#[test]
fn least_times_are_confirmed_and_larger_ones_are_not() {
    let mut random = Generator::new(9);
    let (mut proved, mut refuted) = (0, 0);
    for number in 0..24 {
        let half_spaces = half_spaces(number, &mut random);
        let limited = RatePolytope::within(&half_spaces).expect("limited in all directions");
        let prover = PolytopeProver::new(&half_spaces).expect("in general position");
        let angle = random.logarithmic(3e-2, PI);
        let turn = about(Vector3::from(random.direction()) * angle);
        let least = limited.least_time(&turn, 1e-4);
        let proof = prover.prove(&turn, least.lower_s * (1.0 - MARGIN));
        assert_eq!(proof, Ok(()), "polytope {number}, {turn:?}");
        proved += 1;
        match prover.prove(&turn, least.upper_s * (1.0 + 2e-4)) {
            Ok(()) => panic!("polytope {number}: more than the time of a motion is confirmed"),
            Err(Rejection::Faster { time_s, .. }) => {
                assert!(time_s >= least.lower_s * (1.0 - MARGIN));
                refuted += 1;
            }
            // Where the fastest motion rests, intervals do not find it.
            Err(Rejection::NotProved { .. }) => {}
            Err(other) => panic!("polytope {number}: {other}"),
        }
    }
    assert!(proved == 24 && refuted >= 6, "{refuted} refuted");
}

#[test]
fn boxes_are_polytopes_whose_least_times_are_known() {
    let mut random = Generator::new(19);
    for number in 0..60 {
        let rates = Vector3::from([(); 3].map(|()| random.logarithmic(0.15, 1.0)));
        let size = random.logarithmic(PI / 180.0, 3.0);
        let axis = match number % 3 {
            0 => Vector3::from(random.direction()),
            1 => Vector3::ith(random.below(3), 1.0),
            _ => {
                let off = random.logarithmic(1e-6, 1e-1);
                let near = Vector3::ith(random.below(3), 1.0);
                (near + Vector3::from(random.direction()) * off).normalize()
            }
        };
        let turn = about(axis * size);
        let table = RateBox::new(rates).expect("ordinary rates");
        let half_spaces: Vec<_> = (0..3).map(|i| Vector3::ith(i, 1.0 / rates[i])).collect();
        let prover = PolytopeProver::new(&half_spaces).expect("in general position");
        let least_s = table.lower_bound(&turn, 1e-4) * (1.0 - MARGIN);
        assert_eq!(
            prover.prove(&turn, least_s),
            Ok(()),
            "{number}: {rates} {turn:?}"
        );
    }
}

#[test]
fn half_spaces_that_enclose_nothing_are_no_polytope() {
    assert!(PolytopeProver::new(&[]).is_none());
    let flat = [Vector3::x(), Vector3::y(), Vector3::x() + Vector3::y()];
    assert!(PolytopeProver::new(&flat).is_none());
    assert!(
        PolytopeProver::new(&[Vector3::x(), Vector3::y(), Vector3::repeat(f64::NAN)]).is_none()
    );
}
