//! From solved segments to a flight: torques, legs and passages on one time axis.

use super::torques::{MIN_PIECE_SHARE, torques};
use super::tours::Tours;
use crate::leg::multiphase::LegSolution;
use crate::model::attitude::Attitude;
use crate::model::plan::{Control, Flight, Leg, Passage};
use crate::tour::order::Place;
use std::sync::Arc;

/// A flight under construction.
struct Assembly<'a> {
    tours: &'a Tours<'a>,
    clock: f64,
    shortest: f64,
    controls: Vec<Control>,
    passages: Vec<Passage>,
    legs: Vec<Leg>,
}

/// Assembles the solved segments of a route, with settle and dwell times.
pub(super) fn assemble(
    tours: &Tours<'_>,
    route: &[Place],
    segments: &[Arc<LegSolution>],
) -> (Flight, Vec<Leg>) {
    let total: f64 = segments.iter().map(|s| s.profile.duration()).sum();
    let mut assembly = Assembly {
        tours,
        clock: 0.0,
        shortest: MIN_PIECE_SHARE * total,
        controls: Vec::new(),
        passages: Vec::new(),
        legs: Vec::new(),
    };
    for (places, solution) in tours.places.split(route).iter().zip(segments) {
        let mut begin = 0;
        for (pair, intervals) in places.windows(2).zip(&solution.intervals) {
            assembly.add_leg(pair[0], pair[1], solution, begin..begin + intervals);
            begin += intervals;
            assembly.visit(pair[1]);
        }
    }
    let flight = Flight {
        total_time_s: assembly.clock,
        passages: assembly.passages,
        controls: assembly.controls,
    };
    (flight, assembly.legs)
}

impl Assembly<'_> {
    fn add_leg(
        &mut self,
        from: Place,
        to: Place,
        solution: &LegSolution,
        range: std::ops::Range<usize>,
    ) {
        let begin = self.clock;
        let flown = [range.start, range.end].map(|node| solution.profile.attitudes[node]);
        for (length, torque) in torques(&solution.profile, range, self.shortest) {
            self.push(length, torque.iter().copied());
        }
        let duration = self.clock - begin;
        self.legs.push(Leg {
            from: self.tours.places.name(from),
            to: self.tours.places.name(to),
            start_s: begin,
            duration_s: duration,
            certified_lower_bound_s: None,
            eigenaxis_duration_s: self.eigenaxis_duration([from, to], flown),
            rest_to_rest_duration_s: None,
            solver_status: solution.status.into_str().into(),
        });
    }

    /// Adds the passage of a target, with zero torques for its settle and dwell times.
    fn visit(&mut self, place: Place) {
        let Place::Target(index) = place else { return };
        let target = &self.tours.places.scenario.targets()[index];
        let arrival = self.clock;
        let service = self.tours.places.service_time(place);
        if service > 0.0 {
            let wheels = self.tours.places.dynamics.wheel_count();
            self.push(service, std::iter::repeat_n(0.0, wheels));
        }
        self.passages.push(Passage {
            target: target.id.clone(),
            time_s: arrival,
            departure_s: self.clock,
        });
    }

    fn push(&mut self, duration: f64, torques: impl Iterator<Item = f64>) {
        self.controls.push(Control {
            start_s: self.clock,
            duration_s: duration,
            wheel_torque_nm: self.tours.places.all_torques(torques),
        });
        self.clock += duration;
    }

    /// Duration, s, of the slew about the eigenaxis between two places, with the rolls that are flown.
    fn eigenaxis_duration(&self, ends: [Place; 2], flown: [Attitude; 2]) -> Option<f64> {
        let places = self.tours.places;
        let rolled = |end: usize| places.waypoint(ends[end]).rolled_towards(&flown[end]);
        let (from, to) = (rolled(0), rolled(1));
        let slew = places.slew(&from, &to).eigenaxis();
        slew.flyable.then_some(slew.course.duration())
    }
}
