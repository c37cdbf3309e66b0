//! A spacecraft with four wheels, and flights that need no planner.

use super::super::{ControllerSpec, GainsSpec, PidGainsSpec, Simulation, SimulationSpec};
use crate::model::plan::{Control, Flight, Passage};
use crate::model::scenario::Scenario;
use crate::model::spec::{ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec, WheelSpec};

pub(super) const MAX_TORQUE: f64 = 0.05;

fn wheel(axis: [f64; 3]) -> WheelSpec {
    WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: 2e-3,
        max_torque_nm: MAX_TORQUE,
        min_torque_nm: None,
        max_speed_rad_s: Some(400.0),
        enabled: true,
    }
}

/// A pyramid of wheels and a locked one, with products of inertia and stored momentum.
pub(super) fn spec() -> ScenarioSpec {
    let mut wheels: Vec<WheelSpec> = [
        [0.8, 0.0, 0.6],
        [0.0, 0.8, 0.6],
        [-0.8, 0.0, 0.6],
        [0.0, -0.8, 0.6],
        [1.0, 0.0, 0.0],
    ]
    .map(wheel)
    .into();
    wheels[4].enabled = false;
    ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[4.0, 0.2, -0.1], [0.2, 5.0, 0.3], [-0.1, 0.3, 6.0]],
            wheels,
            ..SpacecraftSpec::default()
        },
        start: StateSpec {
            wheel_speed_rad_s: Some(vec![20.0, -30.0, 10.0, 0.0, 50.0]),
            ..StateSpec::default()
        },
        targets: vec![TargetSpec {
            id: "somewhere".to_owned(),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    }
}

pub(super) fn scenario() -> Scenario {
    Scenario::try_new(&spec()).expect("valid").scenario
}

/// The same without stored momentum, so that it stays at rest without torques.
pub(super) fn calm_scenario() -> Scenario {
    let mut spec = spec();
    spec.start.wheel_speed_rad_s = None;
    Scenario::try_new(&spec).expect("valid").scenario
}

fn control(start_s: f64, duration_s: f64, torque: [f64; 4]) -> Control {
    let [a, b, c, d] = torque.map(|share| share * MAX_TORQUE);
    Control {
        start_s,
        duration_s,
        wheel_torque_nm: vec![a, b, c, d, 0.0],
    }
}

/// Twenty seconds of torques that switch at times off every sampling grid.
pub(super) fn lively() -> Flight {
    Flight {
        total_time_s: 20.0,
        passages: vec![Passage {
            target: "somewhere".to_owned(),
            time_s: 12.345,
            departure_s: 12.345,
        }],
        controls: vec![
            control(0.0, 3.217, [0.9, -0.5, 0.0, 0.8]),
            control(3.217, 4.1, [-0.3, 1.0, -1.0, 0.2]),
            control(7.317, 7.7, [-0.8, -0.7, 0.6, -0.9]),
            control(15.017, 4.983, [0.1, 0.9, 0.5, -0.2]),
        ],
    }
}

/// No torques.
pub(super) fn idle(seconds: f64) -> Flight {
    Flight {
        total_time_s: seconds,
        passages: Vec::new(),
        controls: vec![control(0.0, seconds, [0.0; 4])],
    }
}

pub(super) fn simulation<'a>(
    scenario: &'a Scenario,
    flight: &'a Flight,
    spec: &SimulationSpec,
) -> Simulation<'a> {
    match Simulation::try_new(scenario, flight, spec, "/simulation") {
        Ok(simulation) => simulation,
        Err(problems) => panic!("{problems:#?}"),
    }
}

pub(super) const BANDWIDTH: GainsSpec = GainsSpec::Bandwidth {
    bandwidth_rad_s: 0.1,
    damping: 0.7,
};

pub(super) fn quaternion(gains: GainsSpec) -> ControllerSpec {
    ControllerSpec::Quaternion {
        gains,
        gyroscopic: true,
    }
}

pub(super) fn pid(integral_rad_s: f64) -> ControllerSpec {
    ControllerSpec::GeometricPid {
        gains: PidGainsSpec::Bandwidth {
            bandwidth_rad_s: 0.1,
            damping: 0.7,
            integral_rad_s,
        },
        anti_windup: true,
    }
}
