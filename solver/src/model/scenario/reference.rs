//! A published scenario for unit tests.

use super::Scenario;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec, WheelSpec,
};

/// Experiment A of the multi-target scheduling literature: six attitudes, three wheels on the body
/// axes, and only the z component of the rate vanishing at a target.
pub(crate) fn experiment_a() -> ScenarioSpec {
    let targets = [
        ("a", [15.0, 0.0, 10.0]),
        ("b", [25.0, 0.0, 50.0]),
        ("c", [15.0, 0.0, 130.0]),
        ("d", [25.0, 0.0, 170.0]),
        ("e", [15.0, 0.0, 250.0]),
        ("f", [25.0, 0.0, 290.0]),
    ];
    ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[6.63, 0.0, 0.0], [0.0, 8.90, 0.0], [0.0, 0.0, 9.63]],
            max_body_rate_rad_s: [Some(0.04); 3],
            wheels: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(wheel)
                .into(),
            ..SpacecraftSpec::default()
        },
        end: Some(StateSpec::default()),
        targets: targets.map(target).into(),
        ..ScenarioSpec::default()
    }
}

impl Scenario {
    /// The dynamics that a solve of the scenario uses.
    pub(crate) fn dynamics(&self) -> Dynamics {
        let authority = Authority::of(&self.options);
        Dynamics::of(&self.spacecraft, &self.start, authority)
    }
}

fn wheel(axis: [f64; 3]) -> WheelSpec {
    WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: 0.000_169,
        max_torque_nm: 0.0101,
        min_torque_nm: None,
        max_speed_rad_s: Some(710.0),
        enabled: true,
    }
}

fn target((id, angles): (&str, [f64; 3])) -> TargetSpec {
    TargetSpec {
        id: id.to_owned(),
        attitude: AttitudeSpec::RollPitchYawDeg(angles),
        zero_rate_axes: Some([false, false, true]),
        ..TargetSpec::default()
    }
}
