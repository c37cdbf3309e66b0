//! Bounds on the times of passages: the elapsed time as a state.

use super::Transcription;
use super::rows::Row;
use nalgebra::Vector3;

/// When a motion passes its waypoints.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PassageTimes {
    /// When it begins at the earliest, s.
    pub(crate) start: f64,
    /// Whether it may begin later, after a wait at rest in its first state.
    pub(crate) may_wait: bool,
    /// Earliest and latest time at every waypoint but the first, s; infinite where open.
    pub(crate) bounds: Vec<[f64; 2]>,
}

impl Transcription {
    /// Makes the elapsed time a state that keeps bounds at the waypoints, which have so many intervals
    /// between them. The cost becomes the time of the end instead of the duration.
    pub(crate) fn keep_times(&mut self, times: &PassageTimes, intervals: &[usize]) {
        self.has_clock = true;
        let unit = self.scales.time;
        let start = self.clock_row(-times.start / unit, 1.0);
        let first = &mut self.nodes[0];
        if times.may_wait {
            first.inequalities.push(start);
        } else {
            first.equalities.push(start);
        }
        first.costates.resize(self.dynamics.wheel_count(), 0.0);
        first.costates.push(1.0);
        let mut node = 0;
        for ([earliest, latest], count) in times.bounds.iter().zip(intervals) {
            node += count;
            if *earliest > times.start {
                let row = self.clock_row(-earliest / unit, 1.0);
                self.nodes[node].inequalities.push(row);
            }
            if latest.is_finite() {
                let row = self.clock_row(latest / unit, -1.0);
                self.nodes[node].inequalities.push(row);
            }
        }
    }

    /// The row `constant + sign time`, scaled.
    fn clock_row(&self, constant: f64, sign: f64) -> Row {
        let mut row = self.row(constant, Vector3::zeros(), &[]);
        row.wheels.push(sign);
        row
    }
}
