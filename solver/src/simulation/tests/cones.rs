//! The closest approaches to cones in simulated flights.

use super::super::{ErrorsSpec, SimulationSpec};
use super::build::{BANDWIDTH, lively, quaternion, simulation, spec};
use crate::model::cone::Applies;
use crate::model::scenario::Scenario;
use crate::model::spec::{BoresightSpec, ConeSpec};
use nalgebra::Vector3;

#[test]
fn a_flight_tells_how_close_boresights_came() {
    let mut spec = spec();
    spec.spacecraft.boresights = vec![BoresightSpec {
        name: "camera".to_owned(),
        axis: [0.0, 0.0, 1.0],
    }];
    let cone = |direction: [f64; 3], applies| ConeSpec {
        boresight: "camera".to_owned(),
        direction: direction.into(),
        half_angle_deg: 20.0,
        applies,
    };
    let (aside, up) = ([0.3, 0.2, 0.9], [0.0, 0.0, 1.0]);
    spec.keep_out = vec![
        cone(aside, Applies::Report),
        cone(aside, Applies::AtTargets),
    ];
    spec.keep_in = vec![cone(up, Applies::Always)];
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let mut flight = lively();
    let stay = [16.5, 18.5];
    [flight.passages[0].time_s, flight.passages[0].departure_s] = stay;
    let description = SimulationSpec {
        controller: quaternion(BANDWIDTH),
        errors: ErrorsSpec {
            initial_attitude_3_sigma_rad: Some(0.1),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    };
    let flown = simulation(&scenario, &flight, &description)
        .simulate(1, Some(1), &|| false)
        .expect("not stopped");
    // By the dot product, of the states that were kept: those of all samples.
    let angle_to = |direction: [f64; 3], from_s: f64, to_s: f64| {
        let direction = Vector3::from(direction).normalize();
        let states = flown.states.iter();
        let chosen = states.filter(move |state| (from_s..=to_s).contains(&state.time_s));
        chosen.map(move |state| {
            let pointing = state.attitude.to_reference(Vector3::z());
            (pointing.dot(&direction).acos().to_degrees(), state.time_s)
        })
    };
    let least = |angles: &mut dyn Iterator<Item = (f64, f64)>| {
        angles
            .reduce(|a, b| if b.0 < a.0 { b } else { a })
            .expect("some")
    };
    let mut whole = angle_to(aside, 0.0, 20.0);
    let mut at_target = angle_to(aside, stay[0], stay[1]);
    let out = [least(&mut whole), least(&mut at_target)];
    let farthest = angle_to(up, 0.0, 20.0).reduce(|a, b| if b.0 > a.0 { b } else { a });
    let (farthest, time) = farthest.expect("some");
    let expected = [
        ("/keep_out/0", out[0].0 - 20.0, out[0].1),
        ("/keep_out/1", out[1].0 - 20.0, out[1].1),
        ("/keep_in/0", 20.0 - farthest, time),
    ];
    assert!((out[0].1 - out[1].1).abs() > 1.0, "{out:?}");
    assert_eq!(flown.cones.len(), 3);
    for (found, (pointer, clearance_deg, time_s)) in flown.cones.iter().zip(expected) {
        assert_eq!(found.cone, pointer);
        // The end, which no sample has, may be closer still.
        let at_end = found.time_s >= 20.0;
        assert!(
            (found.clearance_deg - clearance_deg).abs() < 1e-6
                && (found.time_s - time_s).abs() < 1e-9
                || at_end && found.clearance_deg <= clearance_deg,
            "{found:?}: {clearance_deg} at {time_s}"
        );
    }
}
