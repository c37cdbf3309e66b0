//! Prints legs of the random suite as scenarios, one JSON document per line: so many of each
//! spacecraft (default 3).

use slewplan_solver::spec::{AttitudeSpec, ScenarioSpec};
use slewplan_tests::suite::{SPACECRAFT, leg};

fn main() {
    let count = std::env::args()
        .nth(1)
        .map_or(3, |text| text.parse().expect("a number of legs"));
    for spacecraft in 0..SPACECRAFT {
        for number in 0..count {
            println!("{}", json_of(&leg(spacecraft, number)));
        }
    }
}

/// A leg of the suite as JSON; numbers and arrays of them are written alike in Rust.
fn json_of(spec: &ScenarioSpec) -> String {
    let attitude = |attitude: &AttitudeSpec| {
        let AttitudeSpec::Quaternion([x, y, z, w]) = attitude else {
            unreachable!("attitudes of the suite are quaternions");
        };
        format!(r#"{{"quaternion":{{"x":{x:?},"y":{y:?},"z":{z:?},"w":{w:?}}}}}"#)
    };
    let limits = spec
        .spacecraft
        .max_body_rate_rad_s
        .map(|limit| limit.map_or_else(|| "null".to_owned(), |limit| format!("{limit:?}")));
    let wheels: Vec<_> = spec.spacecraft.wheels.iter().map(|wheel| {
        let speed = wheel.max_speed_rad_s.expect("every wheel of the suite has one");
        format!(
            r#"{{"axis":{:?},"inertia_kg_m2":{:?},"max_torque_nm":{:?},"max_speed_rad_s":{speed:?}}}"#,
            wheel.axis, wheel.inertia_kg_m2, wheel.max_torque_nm,
        )
    }).collect();
    let start = &spec.start;
    let speeds = start.wheel_speed_rad_s.as_deref().unwrap_or_default();
    format!(
        r#"{{"name":{:?},"spacecraft":{{"inertia_kg_m2":{:?},"max_body_rate_rad_s":[{}],"wheels":[{}]}},"start":{{"attitude":{},"wheel_speed_rad_s":{speeds:?}}},"targets":[{{"id":{:?},"attitude":{}}}]}}"#,
        spec.name.as_deref().unwrap_or_default(),
        spec.spacecraft.inertia_kg_m2,
        limits.join(","),
        wheels.join(","),
        attitude(&start.attitude),
        spec.targets[0].id,
        attitude(&spec.targets[0].attitude),
    )
}
