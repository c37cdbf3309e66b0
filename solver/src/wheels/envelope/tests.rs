use super::*;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::{
    AttitudeSpec, BoresightChoice, PointingSpec, ScenarioSpec, SpacecraftSpec, StateSpec,
    TargetSpec, WheelSpec,
};

/// Four wheels on the edges of a square pyramid, each with a capacity of 1 N m s.
fn pyramid() -> SpacecraftSpec {
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let wheel = |axis| WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: 0.01,
        max_torque_nm: 0.1,
        min_torque_nm: None,
        max_speed_rad_s: Some(100.0),
        enabled: true,
    };
    SpacecraftSpec {
        inertia_kg_m2: [[25.4, 0.0, 0.0], [0.0, 25.4, 0.0], [0.0, 0.0, 25.4]],
        wheels: [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]]
            .map(wheel)
            .into(),
        ..SpacecraftSpec::default()
    }
}

fn hold(spec: &SpacecraftSpec, locked: &[f64], momentum: Vector3<f64>) -> MomentumHold {
    let spacecraft = Spacecraft::try_new(spec, "").unwrap();
    let hold = hold_momentum(&spacecraft, 1.0, locked, momentum).unwrap();
    let carried = spacecraft.body_momentum(Vector3::zeros(), &hold.wheel_speed);
    assert!(
        (carried - momentum).norm() <= 1e-12 * momentum.norm(),
        "{carried}"
    );
    hold
}

#[test]
fn the_pyramid_reaches_the_published_radii_of_its_envelope() {
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let radii = [
        ("facet", Vector3::x(), 2.0 * s),
        ("vertex on the pyramid's axis", Vector3::z(), 4.0 * c),
        ("minor vertex", Vector3::new(2.0 * s, 0.0, 2.0 * c), 2.0),
    ];
    for (name, direction, radius) in radii {
        let hold = hold(&pyramid(), &[0.0; 4], direction.normalize() * radius);
        assert!((hold.load - 1.0).abs() < 1e-7, "{name}: {}", hold.load);
        assert!(hold.fits());
    }
    assert!(!hold(&pyramid(), &[0.0; 4], Vector3::x() * 1.634).fits());
}

#[test]
fn the_least_load_holds_a_momentum_beyond_the_pseudo_inverse() {
    // Wheels (1, 1, -1, 1) carry this; proportional saturation reaches only two thirds of it.
    let momentum = Vector3::new(
        2.0 * (2.0_f64 / 3.0).sqrt(),
        0.0,
        2.0 * (1.0_f64 / 3.0).sqrt(),
    );
    let hold = hold(&pyramid(), &[0.0; 4], momentum);
    for (speed, expected) in hold.wheel_speed.iter().zip([100.0, 100.0, -100.0, 100.0]) {
        assert!((speed - expected).abs() < 1e-5, "{:?}", hold.wheel_speed);
    }
}

#[test]
fn the_momentum_of_a_locked_wheel_is_part_of_the_total() {
    let mut spec = pyramid();
    spec.wheels[3].enabled = false;
    let locked = [0.0, 0.0, 0.0, 80.0];
    let momentum = Vector3::new(0.2, -0.1, 0.5);
    let hold = hold(&spec, &locked, momentum);
    assert!((hold.wheel_speed[3] - 80.0).abs() < f64::EPSILON);
}

#[test]
fn a_wheel_without_a_speed_limit_takes_most_of_the_momentum() {
    let mut spec = pyramid();
    spec.wheels[0].max_speed_rad_s = None;
    let momentum = Vector3::new(20.0, 0.0, 14.142_135_623_730_951);
    let hold = hold(&spec, &[0.0; 4], momentum);
    assert!(hold.load < 1e-3, "{}", hold.load);
    for wheel in &mut spec.wheels {
        wheel.max_speed_rad_s = None;
    }
    let hold = self::hold(&spec, &[0.0; 4], momentum);
    assert!(hold.load.total_cmp(&0.0).is_eq(), "{}", hold.load);
}

#[test]
fn no_momentum_needs_no_speed() {
    let hold = hold(&pyramid(), &[0.0; 4], Vector3::zeros());
    assert_eq!(hold.wheel_speed, [0.0; 4]);
}

fn problems(spec: &ScenarioSpec) -> Vec<Problem> {
    momentum_problems(&Scenario::try_new(spec).unwrap().scenario)
}

/// Experiment A with a full stored momentum along the reference x and y axes.
fn loaded() -> ScenarioSpec {
    let mut spec = experiment_a();
    spec.start.wheel_speed_rad_s = Some(vec![700.0, 700.0, 0.0]);
    let diagonal = AttitudeSpec::RollPitchYawDeg([0.0, 0.0, 45.0]);
    spec.targets[2].attitude = diagonal.clone();
    spec.targets[2].zero_rate_axes = None;
    spec.targets[4].attitude = diagonal;
    spec
}

#[test]
fn a_rest_beyond_the_envelope_is_reported_with_its_ratio() {
    let found = problems(&loaded());
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].code, Code::MomentumExceedsEnvelope);
    assert_eq!(found[0].pointer, "/targets/2");
    // 700 sqrt(2) / 710
    assert!(found[0].message.contains("1.3943"), "{}", found[0].message);
}

#[test]
fn the_end_is_tested_at_its_rate() {
    let mut spec = loaded();
    spec.targets.clear();
    assert_eq!(problems(&spec), []);
    let end = spec.end.as_mut().unwrap();
    end.attitude = AttitudeSpec::RollPitchYawDeg([0.0, 0.0, 45.0]);
    assert_eq!(problems(&spec)[0].pointer, "/end");
    // A turning body carries part of the momentum itself.
    let rate = 0.000_169 * 700.0 * std::f64::consts::SQRT_2 * 0.5 / 6.63;
    spec.end.as_mut().unwrap().body_rate_rad_s = Some([rate, 0.0, 0.0]);
    assert_eq!(problems(&spec), []);
}

#[test]
fn a_smaller_authority_gives_a_smaller_envelope() {
    let mut spec = experiment_a();
    spec.start.wheel_speed_rad_s = Some(vec![400.0, 300.0, 0.0]);
    // Body x along the stored momentum, so that one wheel has to take 500 rad/s.
    let along = 0.75_f64.atan().to_degrees();
    spec.targets[0].attitude = AttitudeSpec::RollPitchYawDeg([0.0, 0.0, along]);
    spec.targets[0].zero_rate_axes = None;
    assert_eq!(problems(&spec), []);
    spec.options.momentum_authority = 0.6;
    assert_eq!(problems(&spec)[0].pointer, "/targets/0");
}

/// A pyramid with a momentum along the edge of its envelope, and a target that is pointed with a free
/// roll.
fn pointed(momentum: Vector3<f64>, roll: [Option<f64>; 2]) -> ScenarioSpec {
    let craft = Spacecraft::try_new(&pyramid(), "").unwrap();
    let hold = hold_momentum(&craft, 1.0, &[0.0; 4], momentum).unwrap();
    let [roll_min_deg, roll_max_deg] = roll;
    ScenarioSpec {
        spacecraft: pyramid(),
        start: StateSpec {
            wheel_speed_rad_s: Some(hold.wheel_speed),
            ..StateSpec::default()
        },
        targets: vec![TargetSpec {
            id: "star".into(),
            // Body Z, about which the wheels stand, to +Y of the reference frame.
            pointing: Some(PointingSpec {
                boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
                direction: Some([0.0, 1.0, 0.0].into()),
                roll_min_deg,
                roll_max_deg,
                ..PointingSpec::default()
            }),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    }
}

/// The load at every degree of the roll of the only target.
fn loads(scenario: &Scenario) -> Vec<f64> {
    let target = &scenario.targets()[0];
    let pointing = target.pointing.as_ref().unwrap();
    let at = |degrees: i32| {
        let roll = f64::from(degrees).to_radians();
        let attitude = pointing.roll.rolled(&pointing.level, roll);
        let total = attitude.to_body(scenario.momentum());
        let craft = scenario.spacecraft();
        hold_momentum(craft, 1.0, &[0.0; 4], total).unwrap().load
    };
    (-180..180).map(at).collect()
}

#[test]
fn a_free_roll_is_refused_only_where_no_roll_is_held() {
    // Across the pyramid's axis the envelope reaches from 1.633 N m s at the facets to 2 / sqrt(3) * 1.633
    // at the edges between them. Along X of the reference frame all of the momentum turns with the roll.
    let mut decided = [0; 2];
    for size in [1.5, 1.63, 1.66, 1.7, 1.9, 2.3, 2.32, 2.6] {
        let spec = pointed(Vector3::x() * size, [None; 2]);
        let scenario = Scenario::try_new(&spec).unwrap().scenario;
        let least = loads(&scenario).into_iter().fold(f64::INFINITY, f64::min);
        let problems = momentum_problems(&scenario);
        assert_eq!(problems.is_empty(), least <= 1.0, "{size}: {least}");
        decided[usize::from(least <= 1.0)] += 1;
    }
    assert!(decided[0] >= 2 && decided[1] >= 2, "{decided:?}");
}

#[test]
fn limits_of_the_roll_leave_out_those_that_are_held() {
    let momentum = Vector3::x() * 1.9;
    let free = Scenario::try_new(&pointed(momentum, [None; 2]))
        .unwrap()
        .scenario;
    let loads = loads(&free);
    let mut refused = 0;
    for low in (-180..150).step_by(10) {
        let limits = [low, low + 20].map(|limit| Some(f64::from(limit)));
        let scenario = Scenario::try_new(&pointed(momentum, limits))
            .unwrap()
            .scenario;
        let first = usize::try_from(low + 180).unwrap();
        let is_held = loads[first..=first + 20].iter().any(|load| *load <= 1.0);
        let problems = momentum_problems(&scenario);
        assert_eq!(problems.is_empty(), is_held, "{low}");
        refused += problems.len();
        for problem in problems {
            assert_eq!(problem.pointer, "/targets/0");
            assert!(
                problem
                    .message
                    .contains("at the admissible roll of the least load")
            );
        }
    }
    assert!(refused > 4, "{refused}");
}
