//! Times at which states of a flight are reported, and the states there.

use super::dynamics::Snapshot;
use super::integrator::{IntegrationStep, TorqueSpan};
use super::visits::Visit;

/// Least number of states per leg.
const PER_LEG: f64 = 20.0;

/// Least number of states per flight.
const PER_FLIGHT: f64 = 500.0;

/// Times, s, strictly increasing: every control boundary, every arrival and departure, the ends of waits,
/// and evenly between those so that no gap exceeds a 500th of the flight or a 20th of its leg.
pub(super) fn times(
    intervals: &[TorqueSpan<'_>],
    visits: &[Visit<'_>],
    waits: impl Iterator<Item = f64>,
    total_s: f64,
) -> Vec<f64> {
    let mut events: Vec<f64> = vec![0.0, total_s];
    events.extend(visits.iter().flat_map(|v| [v.arrival_s, v.departure_s]));
    events.extend(waits);
    sort(&mut events);
    let mut knots: Vec<f64> = intervals.iter().map(|i| i.begin_s).collect();
    knots.extend(&events);
    sort(&mut knots);
    let mut times = Vec::new();
    let mut leg = 0;
    for pair in knots.windows(2) {
        // Every event is a knot, so that a gap between knots lies inside one leg or stay.
        while leg + 2 < events.len() && events[leg + 1] <= pair[0] {
            leg += 1;
        }
        let leg_length = events[leg + 1] - events[leg];
        let spacing = (total_s / PER_FLIGHT).min(leg_length / PER_LEG);
        divide(&mut times, pair[0], pair[1], spacing);
    }
    times.push(total_s);
    times
}

fn sort(times: &mut Vec<f64>) {
    times.sort_by(f64::total_cmp);
    times.dedup();
}

/// Adds the beginning and the inner points of equal parts of a gap.
fn divide(times: &mut Vec<f64>, begin: f64, end: f64, spacing: f64) {
    // A quotient that exceeds a whole number only by rounding gives no further part.
    let parts = ((end - begin) / spacing - 1e-9)
        .ceil()
        .clamp(1.0, PER_FLIGHT + 1.0);
    let mut part = 0.0;
    while part < parts {
        let time = begin + (end - begin) * (part / parts);
        // Equal times, by rounding, count once.
        if times.last().is_none_or(|last| time > *last) && time < end {
            times.push(time);
        }
        part += 1.0;
    }
}

/// Collects the states at given times while the flight is integrated.
#[derive(Debug)]
pub(super) struct Sampler<'a> {
    pending: &'a [f64],
    pub(super) states: Vec<Snapshot>,
}

impl<'a> Sampler<'a> {
    /// Times in order, the first of which is the start.
    pub(super) fn new(times: &'a [f64], start: &Snapshot) -> Self {
        Self {
            pending: times.get(1..).unwrap_or_default(),
            states: vec![start.clone()],
        }
    }

    pub(super) fn observe(&mut self, step: &IntegrationStep<'_>) {
        let length = step.grid.last().copied().unwrap_or_default();
        while let Some((&time, later)) = self.pending.split_first()
            && time <= step.end_s
        {
            // At the end of a step use its length: a difference of absolute times has rounding.
            let s = if time < step.end_s {
                (time - step.begin_s).max(0.0)
            } else {
                length
            };
            let mut state = step.motion.state(s);
            state.time_s = time;
            self.states.push(state);
            self.pending = later;
        }
    }
}
