//! Warnings about numbers that no spacecraft has.

use super::*;

fn warnings(change: impl Fn(&mut ScenarioSpec)) -> Vec<(Code, String, String)> {
    let mut spec = valid();
    change(&mut spec);
    let warnings = Scenario::try_new(&spec).unwrap().warnings;
    let told = |warning: Problem| {
        let text = warning.to_string();
        (warning.code, warning.pointer, text)
    };
    warnings.into_iter().map(told).collect()
}

#[track_caller]
fn expect_one(found: &[(Code, String, String)], code: Code, pointer: &str, slip: &str) {
    let [(found_code, found_pointer, text)] = found else {
        panic!("{found:?}");
    };
    assert_eq!((*found_code, found_pointer.as_str()), (code, pointer));
    assert!(text.contains(slip), "{text}");
}

#[test]
fn limits_in_degrees_per_second_are_noticed() {
    let in_degrees = |s: &mut ScenarioSpec| {
        s.spacecraft.max_body_rate_rad_s = [Some(0.04_f64.to_degrees()); 3];
    };
    let place = "/spacecraft/max_body_rate_rad_s/2";
    let found = warnings(in_degrees);
    expect_one(
        &found,
        Code::RateLimitUnreachable,
        place,
        "degrees per second? Then write 0.04",
    );
    let norm = |s: &mut ScenarioSpec| s.spacecraft.max_body_rate_norm_rad_s = Some(2.3);
    let place = "/spacecraft/max_body_rate_norm_rad_s";
    expect_one(&warnings(norm), Code::RateLimitUnreachable, place, "null");
}

#[test]
fn limits_that_the_wheels_may_reach_are_none_of_degrees() {
    // 19 times what one wheel gives.
    let reach = 0.000_169 * 710.0 / 9.63;
    assert_eq!(
        warnings(|s| s.spacecraft.max_body_rate_rad_s[2] = Some(19.0 * reach)),
        []
    );
    let degrees = |s: &mut ScenarioSpec| s.spacecraft.max_body_rate_rad_s = [Some(2.3); 3];
    // A tumbling body, or wheels without a limit of speed, may turn so fast.
    let unlimited = |s: &mut ScenarioSpec| {
        degrees(s);
        for wheel in &mut s.spacecraft.wheels {
            wheel.max_speed_rad_s = None;
        }
    };
    assert_eq!(warnings(unlimited), []);
    let tumbling = |s: &mut ScenarioSpec| {
        degrees(s);
        s.start.body_rate_rad_s = Some([0.2, 0.2, 0.2]);
    };
    assert_eq!(warnings(tumbling), []);
    assert_eq!(
        warnings(|s| s.spacecraft.max_body_rate_rad_s = [None; 3]),
        []
    );
}

#[test]
fn large_wheels_at_thousands_of_radians_per_second_are_noticed() {
    let in_rpm = |s: &mut ScenarioSpec| {
        s.spacecraft.wheels[1].inertia_kg_m2 = 0.1;
        s.spacecraft.wheels[1].max_speed_rad_s = Some(6000.0);
    };
    let place = "/spacecraft/wheels/1/max_speed_rad_s";
    let found = warnings(in_rpm);
    expect_one(
        &found,
        Code::WheelSpeedImplausible,
        place,
        "revolutions per minute? Then write 628.3",
    );
    for (inertia, speed) in [(0.1, Some(999.0)), (0.08, Some(6000.0)), (0.1, None)] {
        let plausible = |s: &mut ScenarioSpec| {
            s.spacecraft.wheels[1].inertia_kg_m2 = inertia;
            s.spacecraft.wheels[1].max_speed_rad_s = speed;
        };
        assert_eq!(warnings(plausible), [], "{inertia} {speed:?}");
    }
}

#[test]
fn accelerations_of_no_spacecraft_are_noticed() {
    let place = "/spacecraft/inertia_kg_m2";
    let strong = |s: &mut ScenarioSpec| s.spacecraft.wheels[0].max_torque_nm = 10.1;
    expect_one(
        &warnings(strong),
        Code::AccelerationImplausible,
        place,
        "g mm2",
    );
    let one_way = |s: &mut ScenarioSpec| s.spacecraft.wheels[0].min_torque_nm = Some(-6.7);
    expect_one(
        &warnings(one_way),
        Code::AccelerationImplausible,
        place,
        "mN m",
    );
    let agile = |s: &mut ScenarioSpec| s.spacecraft.wheels[0].max_torque_nm = 6.6;
    assert_eq!(warnings(agile), []);
}

#[test]
fn a_scenario_without_targets_is_noticed() {
    let empty = |s: &mut ScenarioSpec| s.targets.clear();
    expect_one(&warnings(empty), Code::NoTargets, "/targets", "single slew");
}
