//! From solved segments to a flight: torques, legs and passages on one time axis.

use super::torques::{MIN_PIECE_SHARE, torques};
use super::tours::Tours;
use crate::leg::multiphase::LegSolution;
use crate::model::attitude::Attitude;
use crate::model::plan::{Control, Flight, Leg, Passage, Wait};
use crate::model::scenario::Target;
use crate::tour::order::Place;

/// A flight under construction.
struct Assembly<'a> {
    tours: &'a Tours<'a>,
    clock: f64,
    shortest: f64,
    controls: Vec<Control>,
    passages: Vec<Passage>,
    legs: Vec<Leg>,
    waits: Vec<Wait>,
}

/// A part of a flight: the motion through places, after a wait in the first of them.
pub(super) struct Piece<'a> {
    pub(super) places: &'a [Place],
    pub(super) delay: f64,
    pub(super) motion: &'a LegSolution,
}

/// Assembles the pieces of a flight, with settle and dwell times, and waits at rest for windows to open.
pub(super) fn assemble(tours: &Tours<'_>, pieces: &[Piece<'_>]) -> (Flight, Vec<Leg>, Vec<Wait>) {
    let total: f64 = pieces
        .iter()
        .map(|piece| piece.motion.profile.duration())
        .sum();
    let mut assembly = Assembly {
        tours,
        clock: 0.0,
        shortest: MIN_PIECE_SHARE * total,
        controls: Vec::new(),
        passages: Vec::new(),
        legs: Vec::new(),
        waits: Vec::new(),
    };
    for piece in pieces {
        assembly.add_piece(piece);
    }
    let flight = Flight {
        total_time_s: assembly.clock,
        passages: assembly.passages,
        controls: assembly.controls,
    };
    (flight, assembly.legs, assembly.waits)
}

impl Assembly<'_> {
    fn add_piece(&mut self, piece: &Piece<'_>) {
        if let Some(first) = piece.places.first() {
            self.wait(&self.tours.places.name(*first), self.clock + piece.delay);
        }
        let mut begin = 0;
        for (pair, intervals) in piece.places.windows(2).zip(&piece.motion.intervals) {
            self.add_leg(pair[0], pair[1], piece.motion, begin..begin + intervals);
            begin += intervals;
            self.visit(pair[1]);
        }
    }

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
        self.wait_for_window(target);
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

    /// Stays at rest until a window opens.
    fn wait_for_window(&mut self, target: &Target) {
        if target.rests() {
            let begin = target.begin_after(self.clock).unwrap_or(self.clock);
            self.wait(&target.id, begin);
        }
    }

    /// Stays at rest in a place until a time.
    fn wait(&mut self, place: &str, until: f64) {
        let from_s = self.clock;
        if until > from_s {
            let wheels = self.tours.places.dynamics.wheel_count();
            self.push(until - from_s, std::iter::repeat_n(0.0, wheels));
            // The sum may differ from it by rounding.
            self.clock = until;
            self.waits.push(Wait {
                target: place.to_owned(),
                from_s,
                to_s: until,
            });
        }
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
