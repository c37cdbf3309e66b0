//! Verification of one leg, from any state instead of the start of a scenario.

use super::cones::ConeObserver;
use super::dynamics::{Body, QuaternionComponents, Snapshot, conjugate, product};
use super::integrator::{STEP_TOLERANCE, integrate};
use super::limits::{self, LimitObserver};
use super::number_format::figure;
use super::{ATTITUDE_TOLERANCE, RATE_TOLERANCE, timeline};
use crate::model::cone::ForbiddenCone;
use crate::model::plan::{Flight, State};
use crate::model::scenario::Scenario;

/// The required end of a leg.
#[derive(Debug, Clone)]
pub(crate) struct LegEnd {
    /// Attitude as quaternion components, with the sign with which the motion arrives.
    pub(crate) quaternion: QuaternionComponents,
    /// Body rate components that are required, rad/s.
    pub(crate) rate: [Option<f64>; 3],
}

/// Faults of a leg that begins in a state and has the controls of a flight: empty when it arrives
/// within the tolerances, keeps all limits of the scenario and stays out of the cones all along. The
/// cones are in the frame of the leg's attitudes.
pub(crate) fn leg_faults(
    scenario: &Scenario,
    begin: &State,
    flight: &Flight,
    arrival: &LegEnd,
    cones: &[ForbiddenCone],
) -> Vec<String> {
    let spacecraft = scenario.spacecraft();
    let intervals = match timeline::intervals(flight, spacecraft.wheels()) {
        Ok(intervals) => intervals,
        Err(faults) => return faults,
    };
    let body = match Body::new(spacecraft.inertia(), spacecraft.wheels()) {
        Ok(body) => body,
        Err(sentence) => return vec![sentence],
    };
    let start = Snapshot {
        time_s: 0.0,
        quaternion: begin.attitude.xyzw(),
        rate: begin.body_rate_rad_s,
        wheel_speed: begin.wheel_speed_rad_s.clone(),
    };
    let mut limits = LimitObserver::new(scenario);
    let mut cones: Vec<_> = cones
        .iter()
        .map(|cone| ConeObserver::new(*cone, None, &start.quaternion))
        .collect();
    let mut end = start.clone();
    let integration = integrate(&body, start, &intervals, STEP_TOLERANCE, |step| {
        limits.observe(step);
        for cone in &mut cones {
            cone.observe(step);
        }
        end = step.motion.state(step.end_s - step.begin_s);
    });
    let mut faults = limits::torque(scenario, flight).1;
    if let Err(sentence) = integration {
        faults.push(sentence);
        return faults;
    }
    faults.extend(limits.failures());
    for (index, cone) in cones.iter_mut().enumerate() {
        let extent = cone.finish();
        faults.extend(extent.map(|extent| format!("cone {index} is entered {extent}")));
    }
    faults.extend(misses(&end, arrival));
    faults
}

fn misses(end: &Snapshot, arrival: &LegEnd) -> Vec<String> {
    let mut faults = Vec::new();
    let between = product(&conjugate(&arrival.quaternion), &end.quaternion);
    let vector = between[..3].iter().map(|c| c * c).sum::<f64>().sqrt();
    let error = 2.0 * vector.atan2(between[3]);
    if error.is_nan() || error > ATTITUDE_TOLERANCE {
        faults.push(format!("the end is missed by {} rad", figure(error)));
    }
    for (axis, required) in arrival.rate.iter().enumerate() {
        let Some(required) = required else { continue };
        let error = (end.rate[axis] - required).abs();
        if error.is_nan() || error > RATE_TOLERANCE {
            let axis = ["x", "y", "z"][axis];
            let error = figure(error);
            faults.push(format!(
                "the rate about {axis} is off by {error} rad/s at the end"
            ));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::plan::Control;
    use crate::model::scenario::reference::experiment_a;
    use nalgebra::Vector3;

    #[test]
    fn a_cone_in_the_frame_of_the_leg_is_kept() {
        let scenario = Scenario::try_new(&experiment_a()).expect("valid").scenario;
        let rate = 0.02;
        let flight = Flight {
            total_time_s: 10.0,
            passages: Vec::new(),
            controls: vec![Control {
                start_s: 0.0,
                duration_s: 10.0,
                wheel_torque_nm: vec![0.0; 3],
            }],
        };
        // A turn about z by 0.2 rad, with wheels that leave the body without momentum.
        let wheel = &scenario.spacecraft().wheels()[2];
        let stored = scenario.spacecraft().inertia()[(2, 2)] * rate / wheel.inertia;
        let begin = State {
            time_s: 0.0,
            attitude: scenario.start().attitude,
            body_rate_rad_s: Vector3::z() * rate,
            wheel_speed_rad_s: vec![0.0, 0.0, -stored],
        };
        let arrival = LegEnd {
            quaternion: [0.0, 0.0, 0.1_f64.sin(), 0.1_f64.cos()],
            rate: [Some(0.0), Some(0.0), Some(rate)],
        };
        let with = |cones: &[ForbiddenCone]| {
            let faults = leg_faults(&scenario, &begin, &flight, &arrival, cones);
            let about_cones = faults.into_iter().filter(|fault| fault.contains("cone"));
            about_cones.collect::<Vec<_>>()
        };
        // The x axis passes over the direction at 0.15 rad, at 7.5 s.
        let cone = |half_angle: f64| ForbiddenCone {
            axis: Vector3::x(),
            direction: Vector3::new(0.15_f64.cos(), 0.15_f64.sin(), 0.0),
            half_angle,
        };
        let beside = ForbiddenCone {
            axis: Vector3::z(),
            ..cone(0.1)
        };
        assert_eq!(with(&[]), Vec::<String>::new());
        assert_eq!(with(&[beside, cone(0.9e-6)]), Vec::<String>::new());
        let found = with(&[beside, cone(0.01)]);
        let expected = "cone 1 is entered by up to 0.572958 degrees: 7 s to 8 s";
        assert_eq!(found, [expected]);
    }

    #[test]
    fn a_motion_that_cannot_be_computed_is_a_fault() {
        let scenario = Scenario::try_new(&experiment_a()).expect("valid").scenario;
        let flight = Flight {
            total_time_s: 1.0,
            passages: Vec::new(),
            controls: vec![Control {
                start_s: 0.0,
                duration_s: 1.0,
                wheel_torque_nm: vec![0.0; 3],
            }],
        };
        let arrival = LegEnd {
            quaternion: scenario.start().attitude.xyzw(),
            rate: [None; 3],
        };
        let from = |rate: f64| {
            let begin = State {
                time_s: 0.0,
                attitude: scenario.start().attitude,
                body_rate_rad_s: Vector3::new(0.0, 0.0, rate),
                wheel_speed_rad_s: vec![0.0; 3],
            };
            leg_faults(&scenario, &begin, &flight, &arrival, &[])
        };
        assert_eq!(from(0.0), Vec::<String>::new());
        let faults = from(f64::NAN);
        assert!(
            faults.iter().any(|fault| fault.contains("integration")),
            "{faults:?}"
        );
    }
}
