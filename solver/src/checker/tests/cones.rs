//! Cones that are entered between two clear ends, and only reported.

use super::build::{
    EFFECTIVE_X, HALF, TORQUE, accepted, angle, bang_bang, control, passage, scenario, target,
};
use crate::model::cone::Applies;
use crate::model::problem::Code;
use crate::model::spec::{BoresightSpec, ConeSpec, ScenarioSpec};

/// A boresight on z, which the slew about x moves towards -y, and a cone at an angle along that
/// way and off it, rad.
pub(super) fn with_cone(along: f64, off: f64, half_angle_deg: f64) -> ScenarioSpec {
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    spec.spacecraft.boresights = vec![BoresightSpec {
        name: "camera".to_owned(),
        axis: [0.0, 0.0, 2.0],
    }];
    spec.keep_out = vec![ConeSpec {
        boresight: "camera".to_owned(),
        direction: [off.sin(), -along.sin() * off.cos(), along.cos() * off.cos()].into(),
        half_angle_deg,
        applies: Applies::Report,
    }];
    spec
}

#[test]
fn a_cone_between_clear_ends_is_found_with_its_times() {
    // The slew turns by 0.5 rad; the cone covers 0.10 to 0.20 rad of that.
    let report = accepted(&with_cone(0.15, 0.0, 0.05_f64.to_degrees()), &bang_bang());
    assert_eq!(report.margins.keep_out_intrusions.len(), 1);
    let intrusion = &report.margins.keep_out_intrusions[0];
    let time_of = |turned: f64| (2.0 * turned * EFFECTIVE_X / TORQUE).sqrt();
    assert!(
        (intrusion.from_s - time_of(0.10)).abs() < 1e-7,
        "{intrusion:?}"
    );
    assert!(
        (intrusion.to_s - time_of(0.20)).abs() < 1e-7,
        "{intrusion:?}"
    );
    assert!((intrusion.depth_rad - 0.05).abs() < 1e-7, "{intrusion:?}");
    assert_eq!(
        (intrusion.boresight.as_str(), intrusion.cone.as_str()),
        ("camera", "/keep_out/0")
    );
    let nearest = &report.margins.keep_out_clearance_deg[0];
    assert_eq!(
        (nearest.boresight.as_str(), nearest.cone.as_str()),
        ("camera", "/keep_out/0")
    );
    assert!((nearest.clearance_deg + intrusion.depth_rad.to_degrees()).abs() < 1e-12);
    assert!((nearest.time_s - time_of(0.15)).abs() < 1e-6, "{nearest:?}");

    let warning = &report.keep_out[0];
    assert_eq!(
        (warning.code, warning.pointer.as_str()),
        (Code::KeepOutViolated, "/keep_out/0")
    );
    assert!(warning.message.contains("6.32"), "{}", warning.message);
}

#[test]
fn a_cone_beside_the_path_is_clear_by_the_exact_angle() {
    let report = accepted(&with_cone(0.15, 0.12, 0.05_f64.to_degrees()), &bang_bang());
    let clearance = &report.margins.keep_out_clearance_deg[0];
    let clearance = clearance.clearance_deg.to_radians();
    assert!((clearance - 0.07).abs() < 1e-12, "{clearance}");
    assert!(report.keep_out.is_empty() && report.margins.keep_out_intrusions.is_empty());
}

#[test]
fn a_cone_around_the_start_is_left_once() {
    let report = accepted(&with_cone(0.0, 0.0, 0.02_f64.to_degrees()), &bang_bang());
    assert_eq!(report.margins.keep_out_intrusions.len(), 1);
    assert!(report.margins.keep_out_intrusions[0].from_s == 0.0);
    let left = (2.0 * 0.02 * EFFECTIVE_X / TORQUE).sqrt();
    assert!((report.margins.keep_out_intrusions[0].to_s - left).abs() < 1e-7);
}

#[test]
fn a_cone_around_the_end_is_never_left() {
    let report = accepted(
        &with_cone(angle(HALF), 0.0, 0.02_f64.to_degrees()),
        &bang_bang(),
    );
    let [intrusion] = &report.margins.keep_out_intrusions[..] else {
        panic!("{:?}", report.margins.keep_out_intrusions);
    };
    let entered = 2.0 * HALF - (2.0 * 0.02 * EFFECTIVE_X / TORQUE).sqrt();
    assert!((intrusion.from_s - entered).abs() < 1e-6, "{intrusion:?}");
    assert!((intrusion.to_s - 2.0 * HALF).abs() < 1e-12, "{intrusion:?}");
    assert!((intrusion.depth_rad - 0.02).abs() < 1e-9, "{intrusion:?}");
    assert_eq!(report.keep_out[0].code, Code::KeepOutViolated);
}

#[test]
fn a_warning_lists_five_spans_and_counts_the_rest() {
    // To and fro through the cone, and at rest in between.
    let mut spec = with_cone(0.15, 0.0, 0.05_f64.to_degrees());
    for times in [3, 5, 6, 9] {
        let mut flight = bang_bang();
        (flight.controls, flight.passages) = (Vec::new(), Vec::new());
        spec.targets.clear();
        for leg in 0..times {
            let begin = f64::from(leg) * 2.0 * HALF;
            let sign = if leg % 2 == 0 { -1.0 } else { 1.0 };
            flight.controls.push(control(begin, HALF, sign * TORQUE));
            flight
                .controls
                .push(control(begin + HALF, HALF, -sign * TORQUE));
            let name = format!("t{leg}");
            let place = if leg % 2 == 0 { angle(HALF) } else { 0.0 };
            spec.targets.push(target(&name, place));
            let arrival = begin + 2.0 * HALF;
            flight.passages.push(passage(&name, arrival, arrival));
        }
        flight.total_time_s = f64::from(times) * 2.0 * HALF;
        let report = accepted(&spec, &flight);
        assert_eq!(
            report.margins.keep_out_intrusions.len(),
            usize::try_from(times).unwrap()
        );
        let message = &report.keep_out[0].message;
        let more = format!("{} more times", times - 5);
        assert_eq!(message.contains("more times"), times > 5, "{message}");
        assert!(times <= 5 || message.contains(&more), "{message}");
        let listed = message.matches(" s to ").count();
        assert_eq!(listed, usize::try_from(times.min(5)).unwrap(), "{message}");
    }
}

#[test]
fn a_touched_cone_is_no_violation() {
    let report = accepted(&with_cone(0.15, 0.05, 0.05_f64.to_degrees()), &bang_bang());
    assert!(report.keep_out.is_empty(), "{:?}", report.keep_out);
    assert!(report.margins.keep_out_clearance_deg[0].clearance_deg.abs() < 1e-9);
}
