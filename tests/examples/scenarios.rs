//! Prints scenarios of the random suites, one JSON document per line.
//!
//! ```text
//! scenarios legs [COUNT]                            so many of each spacecraft, 3 unless given
//! scenarios ordinary FIRST END TARGETS SPREAD       seeds from FIRST to before END
//! scenarios schedule REGION RATES TARGETS SEED      sphere or strip, rest or z
//! scenarios pass RATES TARGETS DURATION SEED        with windows and values, in so many seconds
//! ```

use serde_json::{Map, Value, json};
use slewplan_solver::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, TargetSpec, WheelSpec,
};
use slewplan_tests::ordinary;
use slewplan_tests::schedules::{Pass, RateConditions, Region, pass, schedule};
use slewplan_tests::suite::{SPACECRAFT, leg};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let number = |text: &str| text.parse::<u64>().expect("a whole number");
    match arguments[..] {
        ["legs"] => legs(3),
        ["legs", count] => legs(number(count)),
        ["ordinary", first, end, targets, spread] => {
            let targets = targets.parse().expect("a number of targets");
            let spread = spread.parse().expect("a ratio");
            for seed in number(first)..number(end) {
                println!("{}", document(&ordinary::scenario(seed, targets, spread)));
            }
        }
        ["schedule", region, rates, targets, seed] => {
            let targets = targets.parse().expect("a number of targets");
            let spec = schedule(region_of(region), rates_of(rates), targets, number(seed));
            println!("{}", document(&spec));
        }
        ["pass", rates, targets, duration, seed] => {
            let spec = pass(Pass {
                rates: rates_of(rates),
                targets: targets.parse().expect("a number of targets"),
                duration_s: duration.parse().expect("a number of seconds"),
                seed: number(seed),
            });
            println!("{}", document(&spec));
        }
        _ => panic!(
            "legs [COUNT] | ordinary FIRST END TARGETS SPREAD | schedule REGION RATES TARGETS SEED \
             | pass RATES TARGETS DURATION SEED"
        ),
    }
}

fn region_of(word: &str) -> Region {
    match word {
        "sphere" => Region::Sphere,
        "strip" => Region::Strip,
        _ => panic!("sphere | strip"),
    }
}

fn rates_of(word: &str) -> RateConditions {
    match word {
        "rest" => RateConditions::AllZero,
        "z" => RateConditions::ZeroAboutZ,
        _ => panic!("rest | z"),
    }
}

fn legs(count: u64) {
    for spacecraft in 0..SPACECRAFT {
        for number in 0..count {
            println!("{}", document(&leg(spacecraft, number)));
        }
    }
}

/// What the suites use of a scenario; members that are absent stay absent.
fn document(spec: &ScenarioSpec) -> Value {
    let start = json!({
        "attitude": attitude(&spec.start.attitude),
        "wheel_speed_rad_s": spec.start.wheel_speed_rad_s,
    });
    let end = spec.end.as_ref();
    let end = end.map(|end| json!({"attitude": attitude(&end.attitude)}));
    object([
        ("name", json!(spec.name)),
        ("spacecraft", spacecraft(&spec.spacecraft)),
        ("start", start),
        ("end", json!(end)),
        ("latest_end_s", json!(spec.latest_end_s)),
        (
            "targets",
            json!(spec.targets.iter().map(target).collect::<Vec<_>>()),
        ),
    ])
}

fn spacecraft(spec: &SpacecraftSpec) -> Value {
    let wheels: Vec<_> = spec.wheels.iter().map(wheel).collect();
    let members = [
        ("inertia_kg_m2", json!(spec.inertia_kg_m2)),
        ("max_body_rate_rad_s", json!(spec.max_body_rate_rad_s)),
        (
            "max_body_rate_norm_rad_s",
            json!(spec.max_body_rate_norm_rad_s),
        ),
        ("wheels", json!(wheels)),
    ];
    object(members)
}

fn wheel(spec: &WheelSpec) -> Value {
    object([
        ("axis", json!(spec.axis)),
        ("inertia_kg_m2", json!(spec.inertia_kg_m2)),
        ("max_torque_nm", json!(spec.max_torque_nm)),
        ("min_torque_nm", json!(spec.min_torque_nm)),
        ("max_speed_rad_s", json!(spec.max_speed_rad_s)),
        ("enabled", json!(spec.enabled)),
    ])
}

fn target(spec: &TargetSpec) -> Value {
    let stopped = spec.zero_rate_axes.map(|stopped| {
        let named = ["x", "y", "z"].into_iter().zip(stopped);
        named
            .filter_map(|(axis, zero)| zero.then_some(axis))
            .collect::<Vec<_>>()
    });
    let windows = spec.windows.as_ref().map(|windows| {
        let spans = windows.iter();
        let spans = spans.map(|window| json!({"from_s": window.from_s, "to_s": window.to_s}));
        spans.collect::<Vec<_>>()
    });
    object([
        ("id", json!(spec.id)),
        ("attitude", attitude(&spec.attitude)),
        ("zero_rate_axes", json!(stopped)),
        ("rate_min_rad_s", json!(spec.rate_min_rad_s)),
        ("rate_max_rad_s", json!(spec.rate_max_rad_s)),
        ("windows", json!(windows)),
        ("value", json!(spec.value)),
    ])
}

fn attitude(spec: &AttitudeSpec) -> Value {
    match spec {
        AttitudeSpec::Quaternion([x, y, z, w]) => {
            json!({"quaternion": {"x": x, "y": y, "z": z, "w": w}})
        }
        AttitudeSpec::RollPitchYawDeg(angles) => json!({"roll_pitch_yaw_deg": angles}),
        _ => unreachable!("the suites have quaternions and angles"),
    }
}

/// An object of the members that are not null.
fn object<const N: usize>(members: [(&str, Value); N]) -> Value {
    let given = members.into_iter().filter(|(_, value)| !value.is_null());
    Value::Object(
        given
            .map(|(name, value)| (name.to_owned(), value))
            .collect::<Map<_, _>>(),
    )
}
