//! Which program answers a slew: its weights, its variables and its intervals.

use super::cost_weights::CostWeights;
use super::motion::SlewMotion;
use super::propagated;
use super::shape::{Course, Lengths, Shape};
use super::spec::{Command, Measure};
use super::validated::Slew;

/// A program that one solve answers.
pub(super) struct Plain {
    pub(super) cost_weights: CostWeights,
    pub(super) shape: Shape,
    pub(super) intervals: usize,
    /// The duration of the guesses, s, where it is known.
    pub(super) lasting: Option<f64>,
}

impl Plain {
    /// The program of a slew in continuous time.
    pub(super) fn of(slew: &Slew) -> Self {
        let cost_weights = slew.cost_weights();
        let (course, own, intervals) = match slew.command() {
            Command::Free { intervals } => {
                let needed = slew.intervals_of_fastest();
                (Course::Steps, true, intervals.max(needed))
            }
            Command::Uniform { intervals } => (Course::Steps, false, intervals),
            Command::Smooth { intervals } => (Course::Ramps, false, intervals),
            // In continuous time, as free as can be.
            Command::Sampled { .. } => (Course::Steps, true, slew.usual_intervals()),
        };
        let lengths = match (own, cost_weights.duration) {
            (true, _) => Lengths::Own,
            (false, None) => Lengths::Shared,
            (false, Some(duration)) => Lengths::Given(vec![duration / intervals as f64; intervals]),
        };
        Self {
            shape: slew.shape(course, lengths, &cost_weights),
            lasting: cost_weights.duration,
            cost_weights,
            intervals,
        }
    }

    /// The same program with the smooth proxy instead of the bill, which has many local minima.
    pub(super) fn proxy(&self, slew: &Slew) -> Option<Self> {
        let billed = self.cost_weights.bills() && self.cost_weights.budget.is_none();
        let cost_weights = CostWeights {
            measure: Measure::Proxy,
            ..self.cost_weights
        };
        billed.then(|| self.with(slew, cost_weights))
    }

    /// The same program where effort counts too, this share of what time counts for on a motion.
    pub(super) fn with_effort(&self, slew: &Slew, share: f64, motion: &SlewMotion) -> Self {
        let cost_weights = CostWeights {
            effort: share * motion.duration() / propagated::effort(motion),
            ..self.cost_weights
        };
        self.with(slew, cost_weights)
    }

    /// The same program with other cost_weights.
    pub(super) fn with(&self, slew: &Slew, cost_weights: CostWeights) -> Self {
        Self {
            shape: slew.shape(self.shape.course, self.shape.lengths.clone(), &cost_weights),
            cost_weights,
            intervals: self.intervals,
            lasting: self.lasting,
        }
    }

    /// A guess on the nodes of the program.
    pub(super) fn meshed(&self, guess: &SlewMotion, slew: &Slew) -> SlewMotion {
        let dynamics = &slew.vehicle().dynamics;
        let lasting = self.lasting.unwrap_or_else(|| guess.duration());
        let guess = guess.lasting(lasting, dynamics);
        match &self.shape.lengths {
            Lengths::Given(lengths) => guess.on_mesh(lengths),
            // What only time counts for switches, and the guess knows when; what is smooth does not.
            Lengths::Own
                if self.cost_weights.hurries() && self.intervals >= guess.lengths.len() =>
            {
                guess.on_finer_mesh(self.intervals)
            }
            _ => guess.on_equal_mesh(self.intervals),
        }
    }
}
