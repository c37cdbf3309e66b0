//! Which program answers a slew: its weights, its variables and its intervals.

use super::cost_weights::CostWeights;
use super::motion::SlewMotion;
use super::propagation;
use super::shape::{IntervalLengths, ProgramShape, TorqueCourse};
use super::spec::{EnergyMeasure, TorqueCommand};
use super::validated::Slew;

/// Weights, variables and number of intervals of a program.
pub(super) struct ProgramChoice {
    pub(super) cost_weights: CostWeights,
    pub(super) shape: ProgramShape,
    pub(super) intervals: usize,
    /// The duration of the guesses, s, where it is known.
    pub(super) guess_duration: Option<f64>,
}

impl ProgramChoice {
    /// The program of a slew in continuous time.
    pub(super) fn of(slew: &Slew) -> Self {
        let cost_weights = slew.cost_weights();
        let (course, own, intervals) = match slew.command() {
            TorqueCommand::Free { intervals } => {
                let needed = slew.intervals_of_fastest();
                (TorqueCourse::Steps, true, intervals.max(needed))
            }
            TorqueCommand::Uniform { intervals } => (TorqueCourse::Steps, false, intervals),
            TorqueCommand::Smooth { intervals } => (TorqueCourse::Ramps, false, intervals),
            // The first step of a sampled slew is the minimum in continuous time.
            TorqueCommand::Sampled { .. } => (TorqueCourse::Steps, true, slew.usual_intervals()),
        };
        let lengths = match (own, cost_weights.duration) {
            (true, _) => IntervalLengths::Free,
            (false, None) => IntervalLengths::Shared,
            (false, Some(duration)) => {
                IntervalLengths::Given(vec![duration / intervals as f64; intervals])
            }
        };
        Self {
            shape: slew.shape(course, lengths, &cost_weights),
            guess_duration: cost_weights.duration,
            cost_weights,
            intervals,
        }
    }

    /// The same program with the smooth proxy in place of the bill, which has many local minima; `None`
    /// where the bill is not minimised.
    pub(super) fn proxy(&self, slew: &Slew) -> Option<Self> {
        let billed = self.cost_weights.uses_bill() && self.cost_weights.budget.is_none();
        let cost_weights = CostWeights {
            measure: EnergyMeasure::Proxy,
            ..self.cost_weights
        };
        billed.then(|| self.with(slew, cost_weights))
    }

    /// The same program with a weight on effort, so that on a motion effort costs `share` of what time
    /// costs.
    pub(super) fn with_effort(&self, slew: &Slew, share: f64, motion: &SlewMotion) -> Self {
        let cost_weights = CostWeights {
            effort: share * motion.duration() / propagation::effort(motion),
            ..self.cost_weights
        };
        self.with(slew, cost_weights)
    }

    /// The same program with other cost weights.
    pub(super) fn with(&self, slew: &Slew, cost_weights: CostWeights) -> Self {
        Self {
            shape: slew.shape(self.shape.course, self.shape.lengths.clone(), &cost_weights),
            cost_weights,
            intervals: self.intervals,
            guess_duration: self.guess_duration,
        }
    }

    /// A guess on the nodes of the program.
    pub(super) fn guess_on_nodes(&self, guess: &SlewMotion, slew: &Slew) -> SlewMotion {
        let dynamics = &slew.vehicle().dynamics;
        let guess_duration = self.guess_duration.unwrap_or_else(|| guess.duration());
        let guess = guess.stretched_to(guess_duration, dynamics);
        match &self.shape.lengths {
            IntervalLengths::Given(lengths) => guess.on_mesh(lengths),
            // In minimum time torques switch, about where the guess does: keep its nodes. Other
            // objectives have smooth torques.
            IntervalLengths::Free
                if self.cost_weights.is_time_only() && self.intervals >= guess.lengths.len() =>
            {
                guess.on_finer_mesh(self.intervals)
            }
            // Near cones the guess has more nodes than the caller asked for.
            IntervalLengths::Free if !dynamics.cones.is_empty() => {
                guess.on_finer_mesh(self.intervals)
            }
            _ => guess.on_equal_mesh(self.intervals),
        }
    }
}
