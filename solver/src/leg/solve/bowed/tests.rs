//! Bowed motions begin and end where they should, and are told apart.

use super::*;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::{Arrival, Resolution};
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spec::Accuracy;
use crate::model::waypoint::{Waypoint, WheelCondition};
use nalgebra::{DVector, Vector3};

#[test]
fn bowed_motions_arrive_at_rest_on_ways_of_their_own() {
    let spec = crate::model::scenario::reference::experiment_a();
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let dynamics = scenario.dynamics();
    let at_rest = |vector| Waypoint {
        attitude: Attitude::from_rotation_vector(vector),
        roll: None,
        rate: [RateCondition::Fixed(0.0); 3],
        wheels: WheelCondition::Free,
        costates: None,
    };
    let ends = [Vector3::new(0.1, 0.2, -0.3), Vector3::new(-0.4, 0.9, 0.5)].map(at_rest);
    let leg = LegProblem {
        dynamics: &dynamics,
        from: &ends[0],
        to: &ends[1],
        arrival: Arrival::Rotation,
        null: &DVector::zeros(0),
        extremals: &KinematicExtremals::of(&dynamics),
        resolution: Resolution::of(Accuracy::Standard, &dynamics),
    };
    let ways = Bow::around(&leg);
    assert_eq!(ways.len(), 4);
    let motions: Vec<_> = ways
        .iter()
        .map(|way| way.motion(&leg, 400, 500.0))
        .collect();
    for motion in &motions {
        let last = motion.attitudes.last().expect("nodes");
        assert!(last.angle_to(&ends[1].attitude) < 1e-12);
        assert!(motion.wheels[0].norm() < 1e-15 && motion.wheels[400].norm() < 1e-15);
        // The wheels' momenta are those of the rates at which the attitudes change.
        for node in [40, 133, 200, 350] {
            let turned = motion.attitudes[node - 1].signed_turn_to(&motion.attitudes[node + 1]);
            let rate = dynamics.rate(&motion.attitudes[node], &motion.wheels[node]);
            let expected = turned / (2.0 * motion.lengths[0]);
            assert!(
                (rate - expected).norm() < 1e-3 * rate.norm(),
                "{rate} {expected}"
            );
        }
    }
    assert!(apart(&motions[0], &motions[0]) < 1e-12);
    for other in &motions[1..] {
        assert!(apart(&motions[0], other) > 0.5);
    }
    // Slower on the same way is the same way.
    let mut slow = motions[0].clone();
    slow.lengths.iter_mut().for_each(|length| *length *= 3.0);
    assert!(apart(&motions[0], &slow) < 1e-9);
}
