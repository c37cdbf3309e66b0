//! The rolls that a plan has chosen.

use super::{Flight, State};
use crate::model::roll::Pointing;
use crate::model::scenario::Scenario;

/// The rolls about the boresights that are pointed, degrees, as in `ra_dec_roll_deg`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rolls {
    /// At the arrival of each passage; `None` where an attitude is given.
    pub passages: Vec<Option<f64>>,
    /// At the end; `None` without one, and where its attitude is given.
    pub end: Option<f64>,
}

impl Rolls {
    /// The rolls of a flight through these states, which are in order of time.
    #[must_use]
    pub fn of(scenario: &Scenario, flight: &Flight, states: &[State]) -> Self {
        let roll = |pointing: Option<&Pointing>, time_s: f64| {
            let state = State::nearest(states, time_s)?;
            Some(pointing?.roll_of(&state.attitude).to_degrees())
        };
        let passages = flight.passages.iter().map(|passage| {
            let target = scenario.targets().iter().find(|t| t.id == passage.target)?;
            roll(target.pointing.as_ref(), passage.time_s)
        });
        Self {
            passages: passages.collect(),
            end: scenario
                .end()
                .and_then(|end| roll(end.pointing.as_ref(), flight.total_time_s)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::plan::Passage;
    use crate::model::spec::{
        BoresightChoice, PointingSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec,
    };
    use nalgebra::Vector3;

    #[test]
    fn rolls_are_told_where_a_boresight_is_pointed() {
        let pointing = |limits: [f64; 2]| PointingSpec {
            boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
            direction: None,
            ra_dec_deg: Some([40.0, 20.0]),
            roll_min_deg: Some(limits[0]),
            roll_max_deg: Some(limits[1]),
        };
        let target = |id: &str, pointing| TargetSpec {
            id: id.into(),
            pointing,
            ..TargetSpec::default()
        };
        let spec = ScenarioSpec {
            spacecraft: SpacecraftSpec::substitute(),
            targets: vec![
                target("given", None),
                target("free", Some(pointing([-180.0, 180.0]))),
                target("limited", Some(pointing([300.0, 350.0]))),
                target("one", Some(pointing([330.0, 330.0]))),
            ],
            end: Some(StateSpec {
                pointing: Some(pointing([-30.0, -10.0])),
                ..StateSpec::default()
            }),
            ..ScenarioSpec::default()
        };
        let scenario = Scenario::try_new(&spec).unwrap().scenario;
        let level = scenario.targets()[1].attitude;
        let states: Vec<State> = (0..5)
            .map(|step| State {
                time_s: f64::from(step),
                attitude: level.retract(Vector3::z() * (-30.0_f64).to_radians()),
                body_rate_rad_s: Vector3::zeros(),
                wheel_speed_rad_s: vec![0.0; 3],
            })
            .collect();
        let passages = ["free", "given", "limited", "one"].into_iter().zip(0..);
        let flight = Flight {
            total_time_s: 4.0,
            passages: passages
                .map(|(target, step)| Passage {
                    target: target.into(),
                    time_s: f64::from(step),
                    departure_s: f64::from(step),
                })
                .collect(),
            controls: Vec::new(),
        };
        let rolls = Rolls::of(&scenario, &flight, &states);
        let all = rolls.passages.iter().chain([&rolls.end]).copied();
        // Of whole turns those in the limits as they are given.
        let expected = [Some(-30.0), None, Some(330.0), Some(330.0), Some(-30.0)];
        for (found, expected) in all.zip(expected) {
            let close = |(a, b): (f64, f64)| (a - b).abs() < 1e-9;
            assert!(found.is_some() == expected.is_some() && found.zip(expected).is_none_or(close));
        }
    }

    #[test]
    fn the_nearest_state_is_found_at_the_ends_and_between() {
        let states = [0.0, 10.0, 20.0, 30.0].map(|time_s| State {
            time_s,
            attitude: crate::model::attitude::Attitude::identity(),
            body_rate_rad_s: Vector3::zeros(),
            wheel_speed_rad_s: Vec::new(),
        });
        for (time, expected) in [(-1.0, 0.0), (9.9, 10.0), (10.1, 10.0), (99.0, 30.0)] {
            let found = State::nearest(&states, time).unwrap();
            assert!((found.time_s - expected).abs() < 1e-12, "{time}");
        }
        assert!(State::nearest(&[], 0.0).is_none());
    }
}
