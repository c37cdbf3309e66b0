//! Motions that pass their waypoints within bounds of time.

use super::passes::from_a_guess;
use super::{LegSolution, MultiphaseSolve};
use crate::leg::profile::Profile;
use crate::leg::transcription::PassageTimes;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::nlp::{Chain, InteriorPoint, Settings};
use crate::run::stop::StopReason;

/// A motion with the time at which it begins.
#[derive(Debug, Clone)]
pub(crate) struct ClockedSolution {
    /// When it begins, s.
    pub(crate) begin: f64,
    /// The motion.
    pub(crate) motion: LegSolution,
}

/// Solves for the motion through waypoints that ends first, from a guess whose nodes are split into
/// legs by `intervals`, and that passes the waypoints within bounds of time.
pub(crate) fn solve_clocked(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    (intervals, guess): (&[usize], &Profile),
    times: &PassageTimes,
    stop: &dyn Fn() -> Option<StopReason>,
) -> ClockedSolution {
    let mut solve = MultiphaseSolve::new(dynamics, waypoints, intervals, guess);
    solve.chain.keep_times(times, intervals);
    solve.engine = InteriorPoint::new(&solve.chain, Settings::COLD);
    solve.begin = Some(times.start);
    solve.set_clock();
    solve.run_passes(from_a_guess(dynamics), stop);
    solve.make_exact(stop);
    // Where it may not wait, the iterate differs from the start by rounding.
    let waited = solve.begin.filter(|_| times.may_wait);
    ClockedSolution {
        begin: waited.unwrap_or(times.start),
        motion: solve.solution,
    }
}

impl MultiphaseSolve<'_> {
    /// Adds the elapsed time to the states of an iterate that lacks it.
    pub(super) fn set_clock(&mut self) {
        let Some(begin) = self.begin else { return };
        let unit = self.scales.time;
        let own = self.chain.point_len() - 1;
        let controls = self.chain.control_dim();
        let mut clock = begin / unit;
        let mut points = Vec::with_capacity(self.iterate.points.len() + self.chain.intervals() + 1);
        for (node, point) in self.iterate.points.chunks_exact(own).enumerate() {
            points.extend_from_slice(point);
            points.push(clock);
            let length = self.iterate.controls.get((node + 1) * controls - 1);
            clock += length.copied().unwrap_or(0.0);
        }
        self.iterate.points = points;
    }

    /// Takes the time of the begin from the iterate.
    pub(super) fn read_clock(&mut self) {
        if let Some(begin) = &mut self.begin {
            let clock = self.iterate.points.get(self.chain.point_len() - 1);
            *begin = clock.map_or(*begin, |clock| clock * self.scales.time);
        }
    }
}
