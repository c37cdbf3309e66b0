//! Which fields of a scenario enter the identity of a leg.

use super::*;
use crate::model::cone::Applies;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::{
    Accuracy, AttitudeEquivalence, AttitudeSpec, BoresightSpec, ConeSpec, OptionsSpec,
    PointingSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec, WheelSpec,
};
use crate::tour::order::Place;

/// Which of the two legs get another identity when a field changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effect {
    None,
    /// The leg from the start only.
    First,
    /// The leg between targets only.
    Second,
    Both,
}

type Row = (&'static str, Effect, fn(&mut ScenarioSpec));

/// The names of all fields of some types; does not compile when a field is missing.
macro_rules! fields {
    ($($kind:ident { $($field:ident),+ $(,)? })+) => {{
        $(let _ = |all: $kind| { let $kind { $($field: _),+ } = all; };)+
        [$($(concat!(stringify!($kind), ".", stringify!($field))),+),+]
    }};
}

/// A change of every field with its effect. New fields must be entered here.
const TABLE: &[Row] = &[
    ("ScenarioSpec.name", Effect::None, |s| {
        s.name = Some("other".into());
    }),
    ("ScenarioSpec.epoch", Effect::None, |s| {
        s.epoch = Some("2027-01-01T00:00:00Z".into());
    }),
    ("ScenarioSpec.time_system", Effect::None, |s| {
        s.time_system = "TAI".parse().ok();
    }),
    ("ScenarioSpec.reference_frame", Effect::None, |s| {
        s.reference_frame = "ICRF".parse().ok();
    }),
    ("ScenarioSpec.spacecraft", Effect::Both, |s| {
        s.spacecraft.wheels.push(wheel([0.0, 1.0, 1.0]));
        speeds(s).push(0.0);
    }),
    ("ScenarioSpec.start", Effect::Both, |s| {
        s.start.attitude = turned(1.2);
    }),
    ("ScenarioSpec.end", Effect::None, |s| s.end = None),
    ("ScenarioSpec.targets", Effect::None, |s| {
        s.targets.truncate(2);
    }),
    ("ScenarioSpec.latest_end_s", Effect::None, |s| {
        s.latest_end_s = Some(900.0);
    }),
    ("ScenarioSpec.keep_out", Effect::None, |s| {
        s.keep_out.clear();
    }),
    ("ScenarioSpec.keep_in", Effect::None, |s| {
        s.keep_in = s.keep_out.clone();
    }),
    ("ScenarioSpec.options", Effect::Both, |s| {
        s.options.torque_authority = 0.8;
    }),
    ("SpacecraftSpec.inertia_kg_m2", Effect::Both, |s| {
        s.spacecraft.inertia_kg_m2[1][1] += 1e-6;
    }),
    ("SpacecraftSpec.max_body_rate_rad_s", Effect::Both, |s| {
        s.spacecraft.max_body_rate_rad_s[2] = None;
    }),
    (
        "SpacecraftSpec.max_body_rate_norm_rad_s",
        Effect::Both,
        |s| {
            s.spacecraft.max_body_rate_norm_rad_s = Some(0.031);
        },
    ),
    ("SpacecraftSpec.wheels", Effect::Both, |s| {
        s.spacecraft.wheels.swap(0, 1);
    }),
    ("SpacecraftSpec.boresights", Effect::None, |s| {
        s.spacecraft.boresights.push(BoresightSpec {
            name: "two".into(),
            axis: [1.0, 0.0, 0.0],
        });
    }),
    ("WheelSpec.axis", Effect::Both, |s| {
        s.spacecraft.wheels[0].axis[1] = 0.01;
    }),
    ("WheelSpec.normalize_axis", Effect::Both, |s| {
        s.spacecraft.wheels[3].normalize_axis = false;
    }),
    ("WheelSpec.inertia_kg_m2", Effect::Both, |s| {
        s.spacecraft.wheels[2].inertia_kg_m2 *= 1.001;
    }),
    ("WheelSpec.max_torque_nm", Effect::Both, |s| {
        s.spacecraft.wheels[2].max_torque_nm *= 1.001;
    }),
    ("WheelSpec.min_torque_nm", Effect::Both, |s| {
        s.spacecraft.wheels[2].min_torque_nm = Some(-0.01);
    }),
    ("WheelSpec.max_speed_rad_s", Effect::Both, |s| {
        s.spacecraft.wheels[2].max_speed_rad_s = None;
    }),
    ("WheelSpec.enabled", Effect::Both, |s| {
        s.spacecraft.wheels[4].enabled = true;
    }),
    ("BoresightSpec.name", Effect::None, |s| {
        s.spacecraft.boresights[0].name = "eye".into();
        s.keep_out[0].boresight = "eye".into();
    }),
    ("BoresightSpec.axis", Effect::None, |s| {
        s.spacecraft.boresights[0].axis = [0.0, 1.0, 0.0];
    }),
    ("StateSpec.attitude", Effect::Both, |s| {
        s.start.attitude = turned(0.3);
    }),
    ("StateSpec.body_rate_rad_s", Effect::Both, |s| {
        s.start.body_rate_rad_s = Some([0.0, 1e-3, 0.0]);
    }),
    ("StateSpec.wheel_speed_rad_s", Effect::Both, |s| {
        speeds(s)[0] += 1.0;
    }),
    // Of the end only, to which neither leg leads.
    ("StateSpec.pointing", Effect::None, |s| {
        s.end = Some(StateSpec {
            pointing: Some(PointingSpec::default()),
            ..StateSpec::default()
        });
    }),
    ("TargetSpec.id", Effect::None, |s| {
        s.targets[1].id = "renamed".into();
        s.targets[2].after = vec!["renamed".into()];
    }),
    ("TargetSpec.attitude", Effect::Both, |s| {
        s.targets[0].attitude = turned(0.4);
    }),
    ("TargetSpec.pointing", Effect::Both, |s| {
        s.targets[0].pointing = Some(PointingSpec::default());
    }),
    ("TargetSpec.zero_rate_axes", Effect::Second, |s| {
        s.targets[1].zero_rate_axes = Some([true, true, false]);
    }),
    ("TargetSpec.rate_min_rad_s", Effect::Both, |s| {
        s.targets[0].rate_min_rad_s = Some([Some(0.0), Some(-2e-3), Some(0.0)]);
    }),
    ("TargetSpec.rate_max_rad_s", Effect::Both, |s| {
        s.targets[0].rate_max_rad_s = Some([Some(0.0), None, Some(0.0)]);
    }),
    // A target with a dwell or settle time implies rest.
    ("TargetSpec.dwell_s", Effect::Second, |s| {
        s.targets[1].dwell_s = 5.0;
    }),
    ("TargetSpec.settle_s", Effect::Second, |s| {
        s.targets[1].settle_s = 5.0;
    }),
    ("TargetSpec.position", Effect::None, |s| {
        s.targets[0].position = Some(1);
    }),
    ("TargetSpec.after", Effect::None, |s| {
        s.targets[2].after.clear();
    }),
    ("TargetSpec.windows", Effect::None, |s| {
        s.targets[0].windows = Some(Vec::new());
    }),
    ("TargetSpec.value", Effect::None, |s| {
        s.targets[0].value = Some(2.0);
    }),
    ("ConeSpec.boresight", Effect::None, |s| {
        s.spacecraft.boresights.push(BoresightSpec {
            name: "two".into(),
            axis: [1.0, 0.0, 0.0],
        });
        s.keep_out[0].boresight = "two".into();
    }),
    ("ConeSpec.direction", Effect::None, |s| {
        s.keep_out[0].direction = [0.0, 1.0, 0.0].into();
    }),
    ("ConeSpec.half_angle_deg", Effect::None, |s| {
        s.keep_out[0].half_angle_deg = 11.0;
    }),
    ("ConeSpec.applies", Effect::None, |s| {
        s.keep_out[0].applies = Applies::AtTargets;
    }),
    ("OptionsSpec.accuracy", Effect::Both, |s| {
        s.options.accuracy = Accuracy::Tight;
    }),
    ("OptionsSpec.attitude_equivalence", Effect::Both, |s| {
        s.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    }),
    ("OptionsSpec.time_limit_s", Effect::None, |s| {
        s.options.time_limit_s = Some(7.0);
    }),
    ("OptionsSpec.node_limit", Effect::None, |s| {
        s.options.node_limit = Some(7);
    }),
    ("OptionsSpec.relative_gap", Effect::None, |s| {
        s.options.relative_gap = 0.1;
    }),
    ("OptionsSpec.alternatives", Effect::None, |s| {
        s.options.alternatives = 3;
    }),
    ("OptionsSpec.torque_authority", Effect::Both, |s| {
        s.options.torque_authority = 0.9;
    }),
    ("OptionsSpec.momentum_authority", Effect::Both, |s| {
        s.options.momentum_authority = 0.9;
    }),
    ("OptionsSpec.seed", Effect::None, |s| s.options.seed = 7),
];

fn wheel(axis: [f64; 3]) -> WheelSpec {
    WheelSpec {
        axis,
        ..experiment_a().spacecraft.wheels[0].clone()
    }
}

fn turned(angle: f64) -> AttitudeSpec {
    let turn = Attitude::from_rotation_vector(Vector3::new(angle, -0.2, 0.5 * angle));
    AttitudeSpec::Quaternion(turn.xyzw())
}

fn speeds(spec: &mut ScenarioSpec) -> &mut Vec<f64> {
    spec.start.wheel_speed_rad_s.as_mut().expect("speeds")
}

/// A scenario with five wheels, of which one is locked and spinning, with momentum, and with limits
/// and conditions of every kind.
fn everything() -> ScenarioSpec {
    let mut spec = experiment_a();
    spec.spacecraft.wheels.push(wheel([1.0, 1.0, 1.0]));
    spec.spacecraft.wheels.push(WheelSpec {
        enabled: false,
        ..wheel([0.0, 1.0, -1.0])
    });
    spec.spacecraft.max_body_rate_norm_rad_s = Some(0.03);
    spec.spacecraft.boresights = vec![BoresightSpec {
        name: "camera".into(),
        axis: [0.0, 0.0, 1.0],
    }];
    spec.keep_out = vec![ConeSpec {
        boresight: "camera".into(),
        direction: [1.0, 0.0, 0.0].into(),
        half_angle_deg: 10.0,
        applies: Applies::Report,
    }];
    spec.start.wheel_speed_rad_s = Some(vec![30.0, -40.0, 20.0, 10.0, 60.0]);
    spec.targets.truncate(3);
    spec.targets[0] = TargetSpec {
        zero_rate_axes: None,
        rate_min_rad_s: Some([Some(0.0), Some(-1e-3), Some(0.0)]),
        rate_max_rad_s: Some([Some(0.0), Some(3e-3), Some(0.0)]),
        ..spec.targets[0].clone()
    };
    spec.targets[2].after = vec![spec.targets[1].id.clone()];
    spec
}

/// The identities of the legs from the start to the first target, and from there to the second.
fn identities(spec: &ScenarioSpec) -> [String; 2] {
    let scenario = match Scenario::try_new(spec) {
        Ok(valid) => valid.scenario,
        Err(problems) => panic!("{problems:?}"),
    };
    let places = Places::of(&scenario);
    let route = [Place::Start, Place::Target(0), Place::Target(1)];
    let [start, first, second] = route.map(|place| places.waypoint(place));
    [(&start, &first), (&first, &second)]
        .map(|(from, to)| CanonicalLeg::of(&places, from, to).identity)
}

#[test]
fn the_identity_tells_the_cones_in_any_order_and_repeated() {
    let mut spec = everything();
    let second = ConeSpec {
        boresight: "camera".into(),
        direction: [0.0, 1.0, 0.5].into(),
        half_angle_deg: 20.0,
        applies: Applies::Always,
    };
    spec.keep_out[0].applies = Applies::Always;
    spec.keep_out.push(second);
    let around = |spec: &ScenarioSpec| {
        let scenario = Scenario::try_new(spec).expect("valid").scenario;
        let places = Places::of(&scenario);
        let ends = [0, 1].map(|target| places.waypoint(Place::Target(target)));
        CanonicalLeg::around_cones(&places, &ends[0], &ends[1])
    };
    let leg = around(&spec);
    assert_eq!(leg.dynamics.cones.len(), 2);
    assert_eq!(cones_of(&leg.identity), leg.dynamics.cones);
    assert_eq!(cones_of(&identities(&spec)[1]), []);
    spec.keep_out.reverse();
    assert_eq!(around(&spec).identity, leg.identity);
    spec.keep_out.push(spec.keep_out[0].clone());
    assert_eq!(around(&spec).dynamics.cones, leg.dynamics.cones);
    assert_eq!(around(&spec).identity, leg.identity);
    spec.keep_out.pop();
    spec.keep_in.push(spec.keep_out.remove(0));
    assert_ne!(around(&spec).identity, leg.identity);
}

#[test]
fn every_field_changes_the_identities_that_it_should_and_no_other() {
    let unchanged = identities(&everything());
    for (field, effect, change) in TABLE {
        let mut spec = everything();
        change(&mut spec);
        assert_ne!(spec, everything(), "{field} is not changed");
        let changed = identities(&spec);
        let found = match [changed[0] != unchanged[0], changed[1] != unchanged[1]] {
            [false, false] => Effect::None,
            [true, false] => Effect::First,
            [false, true] => Effect::Second,
            [true, true] => Effect::Both,
        };
        assert_eq!(found, *effect, "{field}");
    }
}

#[test]
fn the_table_lists_every_field() {
    let mut all = fields! {
        ScenarioSpec {
            name, epoch, time_system, reference_frame, spacecraft, start, end, targets, latest_end_s, keep_out, keep_in, options,
        }
        SpacecraftSpec {
            inertia_kg_m2, max_body_rate_rad_s, max_body_rate_norm_rad_s, wheels, boresights,
        }
        WheelSpec {
            axis, normalize_axis, inertia_kg_m2, max_torque_nm, min_torque_nm, max_speed_rad_s, enabled,
        }
        BoresightSpec { name, axis }
        StateSpec { attitude, pointing, body_rate_rad_s, wheel_speed_rad_s }
        TargetSpec {
            id, attitude, pointing, zero_rate_axes, rate_min_rad_s, rate_max_rad_s, dwell_s, settle_s, position,
            after, windows, value,
        }
        ConeSpec { boresight, direction, half_angle_deg, applies }
        OptionsSpec {
            accuracy, attitude_equivalence, time_limit_s, node_limit, relative_gap, alternatives,
            torque_authority, momentum_authority, seed,
        }
    };
    let mut entered: Vec<_> = TABLE.iter().map(|(field, ..)| *field).collect();
    all.sort_unstable();
    entered.sort_unstable();
    assert_eq!(entered, all);
}

#[test]
fn legs_that_differ_in_momentum_alone_have_different_identities() {
    // Three wheels have no null space, and both targets leave the wheels free.
    let with = |speeds: [f64; 3]| {
        let mut spec = experiment_a();
        spec.start.wheel_speed_rad_s = Some(speeds.into());
        identities(&spec)[1].clone()
    };
    let known = [[0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, -9.0]].map(with);
    for (i, one) in known.iter().enumerate() {
        assert!(!known[..i].contains(one), "{one}");
    }
}

/// Stored legs are found by this text in later versions. A change of it makes all stored legs
/// unreachable and needs a new `VERSION`.
#[test]
fn the_identity_of_a_leg_is_written_as_before() {
    let mut spec = experiment_a();
    spec.targets[0].attitude = AttitudeSpec::Quaternion([0.0, 0.0, -0.6, -0.8]);
    let expected = "leg-10;Resolution { intervals: 12, polished: false };Rotation;\
        6.629831e0,0e0,0e0,0e0,8.899831e0,0e0,0e0,0e0,9.629831000000001e0,;1e0,0e0,0e0,;\
        1.69e-4,-1.01e-2,1.01e-2,7.1e2,;0e0,1e0,0e0,;1.69e-4,-1.01e-2,1.01e-2,7.1e2,;\
        0e0,0e0,1e0,;1.69e-4,-1.01e-2,1.01e-2,7.1e2,;0e0,0e0,0e0,;4e-2,4e-2,4e-2,;inf,;\
        0e0,0e0,0e0,;0e0,0e0,-6e-1,8e-1,;;free;free;0e0,;wheels free;0e0,;0e0,;0e0,;\
        fixed 0e0,0e0,0e0,;";
    assert_eq!(identities(&spec)[0], expected);
}

#[test]
fn reversing_a_wheel_axis_changes_the_identity() {
    let mut turned = everything();
    turned.spacecraft.wheels[1].axis = [0.0, -1.0, 0.0];
    assert_ne!(identities(&turned)[1], identities(&everything())[1]);
}

#[test]
fn rounding_in_the_null_space_does_not_change_the_identity() {
    let second = |bias: f64| {
        let mut spec = everything();
        spec.spacecraft.wheels.truncate(4);
        // Across the null space, and along it: the fourth wheel lies between the other three.
        let (share, across) = (bias / 3_f64.sqrt(), [30.0, -40.0, 10.0]);
        let [x, y, z] = across.map(|speed: f64| speed - share);
        spec.start.wheel_speed_rad_s = Some(vec![x, y, z, bias]);
        identities(&spec)[1].clone()
    };
    assert_eq!(second(1e-15), second(0.0));
    assert_eq!(second(40.0), second(40.0 + 1e-14));
    assert_ne!(second(40.0), second(40.1));
    assert_ne!(second(0.0), second(1e-9));
}

#[test]
fn the_sign_of_a_quaternion_changes_the_identity_only_under_quaternion_equivalence() {
    // The scalar part of a half turn is zero and does not fix its sign.
    let half = |axis: [f64; 3]| {
        let [x, y, z] = axis;
        AttitudeSpec::Quaternion([x, y, z, 0.0])
    };
    let cases = [
        turned(0.4),
        half([1.0, 0.0, 0.0]),
        half([0.0, -1.0, 0.0]),
        half([0.0, 0.6, -0.8]),
    ];
    for attitude in cases {
        let AttitudeSpec::Quaternion(xyzw) = attitude else {
            unreachable!("all cases are quaternions")
        };
        for (equivalence, same) in [
            (AttitudeEquivalence::Rotation, true),
            (AttitudeEquivalence::Quaternion, false),
        ] {
            let with = |sign: f64| {
                let mut spec = everything();
                spec.options.attitude_equivalence = equivalence;
                spec.targets[0].attitude = AttitudeSpec::Quaternion(xyzw.map(|c| sign * c));
                identities(&spec)[0].clone()
            };
            assert_eq!(with(1.0) == with(-1.0), same, "{xyzw:?}");
        }
    }
}

#[test]
fn legs_are_reversible_only_if_rates_and_momentum_are_symmetric() {
    let reversible = |change: fn(&mut ScenarioSpec)| {
        let mut spec = everything();
        spec.start = StateSpec::default();
        spec.targets[0].rate_min_rad_s = Some([Some(0.0), Some(-3e-3), Some(0.0)]);
        change(&mut spec);
        let scenario = Scenario::try_new(&spec).expect("valid").scenario;
        let places = Places::of(&scenario);
        let [from, to] = [0, 1].map(|target| places.waypoint(Place::Target(target)));
        CanonicalLeg::of(&places, &from, &to).reversible
    };
    assert!(reversible(|_| {}));
    assert!(!reversible(
        |s| s.targets[0].rate_min_rad_s = Some([Some(0.0), Some(-1e-3), Some(0.0)])
    ));
    // A free wheel cancels the momentum of the locked one: the total is zero, but the locked wheel
    // still acts as a gyroscope.
    assert!(!reversible(|s| {
        s.spacecraft.wheels[3].axis = [0.0, 1.0, -1.0];
        s.start.wheel_speed_rad_s = Some(vec![0.0, 0.0, 0.0, -60.0, 60.0]);
    }));
    assert!(!reversible(
        |s| s.start.wheel_speed_rad_s = Some(vec![10.0, 0.0, 0.0, 0.0, 0.0])
    ));
}
