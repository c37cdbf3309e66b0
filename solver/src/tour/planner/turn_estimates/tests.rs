//! Estimated durations against motions about one axis.

use super::*;
use crate::model::attitude::Attitude;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::AttitudeSpec;

/// The estimated durations, s, of the turns from the start at rest to 0.5 rad and on to 1.5 rad about the x axis,
/// and the largest rate, rad/s, and acceleration, rad/s², about it.
fn turns(zero_rate_axes: [bool; 3]) -> ([f64; 2], [f64; 2]) {
    let mut spec = experiment_a();
    spec.targets.truncate(2);
    for (target, turn) in spec.targets.iter_mut().zip([0.5, 1.5]) {
        let turned = Attitude::from_rotation_vector(Vector3::new(turn, 0.0, 0.0));
        target.attitude = AttitudeSpec::Quaternion(turned.xyzw());
        target.zero_rate_axes = Some(zero_rate_axes);
    }
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let places = Places::of(&scenario);
    let estimates = TurnEstimates::of(&places);
    let [first, second] = [0, 1].map(Place::Target);
    let times = [
        estimates.duration_s(Place::Start, first),
        estimates.duration_s(first, second),
    ];
    (times, [estimates.rates[0], estimates.accelerations[0]])
}

#[test]
fn turns_between_rests_have_two_ramps() {
    let ([first_s, second_s], [rate, acceleration]) = turns([true; 3]);
    let ramps_s = rate / acceleration;
    assert!((first_s - 0.5 / rate - ramps_s).abs() < 1e-9, "{first_s}");
    assert!((second_s - 1.0 / rate - ramps_s).abs() < 1e-9, "{second_s}");
}

#[test]
fn a_free_rate_needs_no_ramp() {
    let ([first_s, second_s], [rate, acceleration]) = turns([false, false, true]);
    let ramp_s = 0.5 * rate / acceleration;
    assert!((first_s - 0.5 / rate - ramp_s).abs() < 1e-9, "{first_s}");
    assert!((second_s - 1.0 / rate).abs() < 1e-9, "{second_s}");
}
