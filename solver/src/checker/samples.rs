//! When the flight is looked at, and the states seen then.

use super::dynamics::Snapshot;
use super::integrator::{Interval, Step};
use super::visits::Visit;

/// States per slew, at least.
const PER_SLEW: f64 = 20.0;

/// States per flight, at least, evenly spread.
const PER_FLIGHT: f64 = 500.0;

/// Times, s, strictly increasing: every control boundary, every arrival and departure, and evenly
/// between those so that no gap exceeds a 500th of the flight or a 20th of its slew.
pub(super) fn times(intervals: &[Interval<'_>], visits: &[Visit<'_>], total_s: f64) -> Vec<f64> {
    let mut events: Vec<f64> = vec![0.0, total_s];
    events.extend(visits.iter().flat_map(|v| [v.arrival_s, v.departure_s]));
    sort(&mut events);
    let mut knots: Vec<f64> = intervals.iter().map(|i| i.begin_s).collect();
    knots.extend(&events);
    sort(&mut knots);
    let mut times = Vec::new();
    let mut slew = 0;
    for pair in knots.windows(2) {
        // Every event is a knot, so that a gap between knots lies inside one slew or rest.
        while slew + 2 < events.len() && events[slew + 1] <= pair[0] {
            slew += 1;
        }
        let slew_length = events[slew + 1] - events[slew];
        let spacing = (total_s / PER_FLIGHT).min(slew_length / PER_SLEW);
        divide(&mut times, pair[0], pair[1], spacing);
    }
    times.push(total_s);
    times
}

fn sort(times: &mut Vec<f64>) {
    times.sort_by(f64::total_cmp);
    times.dedup();
}

/// Adds the begin and the inner points of equal parts of a gap.
fn divide(times: &mut Vec<f64>, begin: f64, end: f64, spacing: f64) {
    // Rounding of an even division must not cost another part.
    let parts = ((end - begin) / spacing - 1e-9)
        .ceil()
        .clamp(1.0, PER_FLIGHT + 1.0);
    let mut part = 0.0;
    while part < parts {
        let time = begin + (end - begin) * (part / parts);
        // Times that rounding cannot tell apart are one.
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

    pub(super) fn observe(&mut self, step: &Step<'_>) {
        let length = step.grid.last().copied().unwrap_or_default();
        while let Some((&time, later)) = self.pending.split_first()
            && time <= step.end_s
        {
            // At the end of a step its length, not a difference of absolute times.
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
