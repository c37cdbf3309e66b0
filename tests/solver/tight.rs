//! Changes of a description that must not change the duration at the tight accuracy setting.

use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::spec::{Accuracy, AttitudeSpec, ScenarioSpec};
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{agree, plan_of, scenario_of};
use slewplan_tests::suite::leg;

const TOLERANCE: f64 = 1e-6;

/// Legs of the random suite without rate limits per axis: on principal axes and not, three to six
/// wheels, with and without momentum.
const LEGS: [(u64, u64); 4] = [(0, 7), (1, 4), (3, 10), (6, 13)];

fn tight(spacecraft: u64, number: u64) -> ScenarioSpec {
    let mut spec = leg(spacecraft, number);
    spec.options.accuracy = Accuracy::Tight;
    spec
}

fn duration(spec: &ScenarioSpec) -> f64 {
    plan_of(spec).total_time_s
}

/// Scaling inertia, wheels' inertia and torque together does not change the motion.
#[test]
fn the_unit_of_mass_does_not_change_the_duration() {
    for (spacecraft, number) in LEGS {
        let spec = tight(spacecraft, number);
        let expected = duration(&spec);
        for k in (-6..=6).filter(|k| *k != 0) {
            let factor = 10.0_f64.powi(k);
            let mut scaled = spec.clone();
            for row in &mut scaled.spacecraft.inertia_kg_m2 {
                *row = row.map(|entry| entry * factor);
            }
            for wheel in &mut scaled.spacecraft.wheels {
                wheel.inertia_kg_m2 *= factor;
                wheel.max_torque_nm *= factor;
            }
            let found = duration(&scaled);
            assert!(
                agree(found, expected, TOLERANCE),
                "{:?} scaled by 1e{k}: {found} instead of {expected} s",
                spec.name
            );
        }
    }
}

/// The same spacecraft described in body axes that are turned.
fn turned(spec: &ScenarioSpec, turn: &Attitude) -> ScenarioSpec {
    let scenario = scenario_of(spec);
    let mut spec = spec.clone();
    let matrix = turn.matrix();
    let inertia = matrix * scenario.spacecraft().inertia() * matrix.transpose();
    let inertia = (inertia + inertia.transpose()) * 0.5;
    spec.spacecraft.inertia_kg_m2 = [0, 1, 2].map(|i| [0, 1, 2].map(|j| inertia[(i, j)]));
    for wheel in &mut spec.spacecraft.wheels {
        wheel.axis = turn.to_reference(wheel.axis.into()).into();
    }
    let back = turn.turn_to(&Attitude::identity());
    let attitude =
        |attitude: &Attitude| AttitudeSpec::Quaternion(attitude.then_in_body(&back).xyzw());
    spec.start.attitude = attitude(&scenario.start().attitude);
    spec.targets[0].attitude = attitude(&scenario.targets()[0].attitude);
    spec
}

#[test]
fn turned_body_axes_do_not_change_the_duration() {
    let mut generator = Generator::new(41);
    for (spacecraft, number) in LEGS {
        let spec = tight(spacecraft, number);
        let expected = duration(&spec);
        for _ in 0..3 {
            let turn = Attitude::from_xyzw(generator.quaternion()).expect("unit length");
            let found = duration(&turned(&spec, &turn));
            assert!(
                agree(found, expected, TOLERANCE),
                "{:?} in other axes: {found} instead of {expected} s",
                spec.name
            );
        }
    }
}

#[test]
fn without_momentum_both_directions_of_a_leg_take_the_same_time() {
    // Three wheels: their momenta at rest are zero at either end.
    for (spacecraft, number) in [(0, 7), (0, 11), (8, 3), (8, 9)] {
        let spec = tight(spacecraft, number);
        let mut back = spec.clone();
        back.start.attitude = spec.targets[0].attitude.clone();
        back.targets[0].attitude = spec.start.attitude.clone();
        let (forth, back) = (duration(&spec), duration(&back));
        assert!(agree(forth, back, TOLERANCE), "{forth} and {back} s");
    }
}
