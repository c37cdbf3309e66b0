//! The closest approaches to cones in simulated flights.

use super::super::{ErrorsSpec, GainsSpec, LowPercentiles, SimulatedFlight, SimulationSpec};
use super::build::{BANDWIDTH, lively, quaternion, simulation, spec};
use crate::checker::NOT_COMPUTED;
use crate::model::cone::Applies;
use crate::model::scenario::Scenario;
use crate::model::spec::{BoresightSpec, ConeSpec, ScenarioSpec};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use nalgebra::Vector3;

/// A direction close to where the camera points, and the one where it begins.
const ASIDE: [f64; 3] = [0.3, 0.2, 0.9];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// The lively spacecraft with a camera along +z.
fn with_camera() -> ScenarioSpec {
    let mut spec = spec();
    spec.spacecraft.boresights = vec![BoresightSpec {
        name: "camera".to_owned(),
        axis: UP,
    }];
    spec
}

fn cone(direction: [f64; 3], half_angle_deg: f64, applies: Applies) -> ConeSpec {
    ConeSpec {
        boresight: "camera".to_owned(),
        direction: direction.into(),
        half_angle_deg,
        applies,
    }
}

fn with_errors() -> SimulationSpec {
    SimulationSpec {
        controller: quaternion(BANDWIDTH),
        errors: ErrorsSpec {
            initial_attitude_3_sigma_rad: Some(0.1),
            ..ErrorsSpec::default()
        },
        runs: Some(24),
        ..SimulationSpec::default()
    }
}

fn valid(spec: &ScenarioSpec) -> Scenario {
    Scenario::try_new(spec).expect("valid").scenario
}

#[test]
fn a_flight_tells_how_close_boresights_came() {
    let mut spec = with_camera();
    spec.keep_out = vec![
        cone(ASIDE, 20.0, Applies::Report),
        cone(ASIDE, 20.0, Applies::AtTargets),
    ];
    spec.keep_in = vec![cone(UP, 20.0, Applies::Always)];
    let scenario = valid(&spec);
    let mut flight = lively();
    let stay = [16.5, 18.5];
    [flight.passages[0].time_s, flight.passages[0].departure_s] = stay;
    let flown = simulation(&scenario, &flight, &with_errors())
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
    let mut whole = angle_to(ASIDE, 0.0, 20.0);
    let mut at_target = angle_to(ASIDE, stay[0], stay[1]);
    let out = [least(&mut whole), least(&mut at_target)];
    let farthest = angle_to(UP, 0.0, 20.0).reduce(|a, b| if b.0 > a.0 { b } else { a });
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

#[test]
fn a_cone_at_targets_is_met_at_an_arrival_without_a_stay() {
    let mut spec = with_camera();
    spec.keep_out = vec![cone(ASIDE, 20.0, Applies::AtTargets)];
    let scenario = valid(&spec);
    let flight = lively();
    let arrival = flight.passages[0].time_s;
    let simulate = |flight| {
        simulation(&scenario, flight, &with_errors())
            .simulate(1, None, &|| false)
            .expect("not stopped")
    };
    let [nearest] = &simulate(&flight).cones[..] else {
        panic!("one cone")
    };
    assert!((nearest.time_s - arrival).abs() < 1e-12, "{nearest:?}");
    let mut nowhere = lively();
    nowhere.passages.clear();
    assert!(simulate(&nowhere).cones.is_empty());
}

/// Flights over two cones in their way and two far away, one of each only reported.
fn surrounded() -> Scenario {
    let mut spec = with_camera();
    spec.keep_out = vec![
        cone(ASIDE, 6.0, Applies::Report),
        cone([0.0, 0.0, -1.0], 10.0, Applies::Always),
        cone([0.3, 0.2, -0.9], 10.0, Applies::AtTargets),
    ];
    valid(&spec)
}

#[test]
fn many_flights_tell_how_many_stay_clear_and_by_how_much() {
    let (scenario, flight) = (surrounded(), lively());
    let simulation = simulation(&scenario, &flight, &with_errors());
    let pool = SolverPool::new(None).expect("threads");
    let spread = simulation.monte_carlo(&pool, &StopSignal::new());
    let each: Vec<SimulatedFlight> = (0..24)
        .map(|number| simulation.simulate(number, None, &|| false).expect("ran"))
        .collect();
    let pointers: Vec<&str> = spread.cones.iter().map(|cone| &*cone.cone).collect();
    assert_eq!(pointers, ["/keep_out/0", "/keep_out/1", "/keep_out/2"]);
    for (index, found) in spread.cones.iter().enumerate() {
        let mut angles: Vec<f64> = each.iter().map(|f| f.cones[index].clearance_deg).collect();
        angles.sort_by(|a, b| b.total_cmp(a));
        // Half of 24, 90 % of them (21.6) and 99 % (23.8) have at least these.
        let expected = LowPercentiles {
            p50: angles[11],
            p10: angles[21],
            p1: angles[23],
            min: angles[23],
        };
        assert_eq!(found.clearance_deg, expected, "{index}");
        assert_eq!(found.applies, scenario.cones()[index].applies);
        let clear = angles.iter().filter(|angle| **angle >= 0.0).count();
        assert!((found.share_clear - clear as f64 / 24.0).abs() < 1e-12);
    }
    // The near one divides the flights, but does not count: it is only reported.
    let near = &spread.cones[0];
    assert!(near.share_clear > 0.0 && near.share_clear < 1.0, "{near:?}");
    assert_eq!(spread.share_clear, Some(1.0));
}

#[test]
fn enforced_cones_count_where_they_apply() {
    let mut spec = with_camera();
    spec.keep_out = vec![cone([0.0, 0.0, -1.0], 10.0, Applies::Always)];
    let shares = |spec: &ScenarioSpec| {
        let (scenario, flight) = (valid(spec), lively());
        let simulation = simulation(&scenario, &flight, &with_errors());
        let pool = SolverPool::new(None).expect("threads");
        let spread = simulation.monte_carlo(&pool, &StopSignal::new());
        let cones = spread.cones.iter().map(|cone| cone.share_clear).collect();
        (spread.share_clear, cones)
    };
    let always: (Option<f64>, Vec<f64>) = shares(&spec);
    assert_eq!(always, (Some(1.0), vec![1.0]));
    spec.keep_out.push(cone(ASIDE, 6.0, Applies::Always));
    let (all, each) = shares(&spec);
    assert!(each[1] > 0.0 && each[1] < 1.0, "{each:?}");
    assert_eq!(all, Some(each[1]));
    for cone in &mut spec.keep_out {
        cone.applies = Applies::Report;
    }
    let (all, reported) = shares(&spec);
    assert_eq!((all, reported), (None, each));
    spec.keep_out.clear();
    assert_eq!(shares(&spec), (None, Vec::new()));
}

#[test]
fn a_flight_that_breaks_off_is_not_clear_of_any_cone() {
    let (scenario, flight) = (surrounded(), lively());
    let mut wild = with_errors();
    // Torques beyond all numbers, sooner or later.
    wild.errors.rate_noise_rad_s = Some(1.0);
    wild.controller = quaternion(GainsSpec::Given {
        attitude_per_s2: 1e308,
        rate_per_s: 1e308,
    });
    let simulation = simulation(&scenario, &flight, &wild);
    let one = simulation.simulate(3, None, &|| false).expect("ran");
    assert!(one.end.attitude_rad >= NOT_COMPUTED, "{one:?}");
    assert_eq!(one.cones.len(), 3);
    let unknown = |angle: f64| angle <= -NOT_COMPUTED && angle.is_finite();
    assert!(one.cones.iter().all(|cone| unknown(cone.clearance_deg)));
    let pool = SolverPool::new(None).expect("threads");
    let spread = simulation.monte_carlo(&pool, &StopSignal::new());
    assert_eq!(spread.share_clear, Some(0.0));
    for cone in &spread.cones {
        assert!(cone.share_clear <= 0.0 && unknown(cone.clearance_deg.min));
    }
}
