//! Guesses for a slew: the fastest motion, and slews about the eigenaxis perturbed_eigenaxis to either side.

use super::cost_weights::CostWeights;
use super::motion::SlewMotion;
use super::validated::Slew;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::{self, LegProblem, Resolution};
use crate::model::spec::Accuracy;
use crate::run::stop::StopReason;

/// The guesses, best first: minimum time has one, since the fastest motion is itself the best of
/// several; what is smooth, or may not use all torques, may have more than one minimum.
pub(super) fn of(
    slew: &Slew,
    cost_weights: CostWeights,
    stop: &dyn Fn() -> Option<StopReason>,
) -> Vec<SlewMotion> {
    let vehicle = slew.vehicle();
    let dynamics = &vehicle.dynamics;
    let ends = slew.ends();
    let null = dynamics.null_component(slew.start_momenta());
    let problem = LegProblem {
        dynamics,
        from: &ends[0],
        to: &ends[1],
        arrival: slew.arrival(),
        null: &null,
        extremals: &KinematicExtremals::of(dynamics),
        resolution: Resolution::of(Accuracy::Standard, dynamics),
    };
    let fastest = solve::solve(&problem, None, stop).solution;
    let converged = fastest.duration().is_some();
    let fastest = SlewMotion::of_profile(&fastest.profile);
    let mut guesses = vec![match &vehicle.pinned_null {
        Some(null) => fastest.with_null_space(null, dynamics),
        None => fastest,
    }];
    // Where the pseudo-inverse shares torques out, the fastest motion is another problem's.
    if !converged || !cost_weights.is_time_only() || vehicle.pinned_null.is_some() {
        let perturbed_eigenaxis = [Perturbation::Far, Perturbation::Near]
            .map(|side| SlewMotion::of_profile(&problem.perturbed_eigenaxis(side)));
        guesses.extend(perturbed_eigenaxis);
    }
    guesses
}

impl Slew {
    /// Intervals that resolve a motion in minimum time.
    pub(super) fn usual_intervals(&self) -> usize {
        let resolution = Resolution::of(Accuracy::Standard, &self.vehicle().dynamics);
        resolution.intervals + self.intervals_of_fastest()
    }

    /// Intervals of the fastest motion, which needs more of them where stored momentum turns under
    /// a rate limit.
    pub(super) fn intervals_of_fastest(&self) -> usize {
        let dynamics = &self.vehicle().dynamics;
        let [from, to] = self.ends();
        let turn = self.arrival().turn(&from.attitude, &to.attitude);
        Resolution::of(Accuracy::Standard, dynamics).intervals_of(dynamics, turn)
    }
}
