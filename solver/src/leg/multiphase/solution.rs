//! What a solve of one or several legs returns.

use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use crate::nlp::NlpStatus;
use nalgebra::DVector;

/// Relative difference below which two durations are the same.
const SAME_DURATION: f64 = 1e-9;

/// The solution of a leg, or of several legs as one motion.
#[derive(Debug, Clone)]
pub(crate) struct LegSolution {
    /// How the NLP ended.
    pub(crate) status: NlpStatus,
    /// The motion; of use only when converged.
    pub(crate) profile: Profile,
    /// Intervals of each of its legs.
    pub(crate) intervals: Vec<usize>,
    /// Interior-point iterations.
    pub(crate) iterations: usize,
    /// Largest violation of any condition by the last iterate, scaled.
    pub(crate) infeasibility: f64,
    /// Costates of the wheel momenta, s per N m s, at every waypoint between two legs: the time
    /// that the legs before it save per momentum there, and that the legs after it lose.
    pub(crate) costates: Vec<DVector<f64>>,
}

impl LegSolution {
    /// The outcome where there is not even a guess.
    pub(crate) fn nowhere() -> Self {
        Self {
            status: NlpStatus::IterationLimit,
            profile: Profile::empty(),
            intervals: Vec::new(),
            iterations: 0,
            infeasibility: f64::MAX,
            costates: Vec::new(),
        }
    }

    /// The solution reversed in time, which solves the reversed leg where momenta and torques admit
    /// it.
    pub(crate) fn reversed(&self) -> Self {
        Self {
            profile: self.profile.reversed(),
            intervals: self.intervals.iter().rev().copied().collect(),
            // Reversal changes the sign of costates and of momenta.
            costates: self.costates.iter().rev().cloned().collect(),
            ..*self
        }
    }

    /// Appends a solution that begins in the state in which this one ends. Nothing is known of the
    /// costates where they meet.
    pub(super) fn append(&mut self, next: &Self, wheels: usize) {
        if !self.intervals.is_empty() {
            self.costates.push(DVector::zeros(wheels));
        }
        self.profile.append(&next.profile);
        self.intervals.extend_from_slice(&next.intervals);
        self.costates.extend_from_slice(&next.costates);
        self.iterations += next.iterations;
        self.infeasibility = self.infeasibility.max(next.infeasibility);
    }

    /// The same motion, or the one reversed in time, in another frame: where one attitude is in the frame
    /// of the motion, another one is. Without the former, it is the motion's first one.
    pub(crate) fn placed(
        &self,
        reversed: bool,
        attitude_here: Option<&Attitude>,
        there: &Attitude,
    ) -> Self {
        let mut placed = if reversed {
            self.reversed()
        } else {
            self.clone()
        };
        let first = placed.profile.attitudes.first().copied();
        if let Some(here) = attitude_here.copied().or(first) {
            for attitude in &mut placed.profile.attitudes {
                *attitude = there.then_in_body(&here.turn_to(attitude));
            }
        }
        placed
    }

    /// Duration, s, where there is a motion that meets all conditions.
    pub(crate) fn duration(&self) -> Option<f64> {
        let valid = matches!(self.status, NlpStatus::Converged | NlpStatus::Constructed);
        valid.then(|| self.profile.duration())
    }

    /// Duration, s, when the NLP converged: a local minimum.
    pub(crate) fn least_duration(&self) -> Option<f64> {
        (self.status == NlpStatus::Converged).then(|| self.profile.duration())
    }

    /// Whether it is better than another solution: those with a duration are better than those
    /// without, and equal durations are no improvement.
    pub(crate) fn improves(&self, other: &LegSolution) -> bool {
        match (self.duration(), other.duration()) {
            (Some(new), Some(old)) => new < old * (1.0 - SAME_DURATION),
            (Some(_), None) => true,
            (None, _) => false,
        }
    }
}
