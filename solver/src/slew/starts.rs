//! Guesses for a slew: the fastest motion, and eigenaxis slews perturbed to either side, or motions along
//! ways around cones.

use super::cost_weights::CostWeights;
use super::motion::SlewMotion;
use super::validated::Slew;
use crate::leg::solve::around_cones;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::{self, LegProblem, Resolution};
use crate::model::spec::Accuracy;
use crate::run::stop::StopReason;

/// Most guesses along ways around cones beside the fastest motion.
const MAX_AROUND_CONES: usize = 3;

/// The guesses, best first. For minimum time the fastest motion is enough, since it is itself the best
/// of several solutions; other objectives may have several local minima.
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
    let mut fastest = solve::solve(&problem, None, stop).solution;
    let converged = fastest.duration().is_some();
    if fastest.profile.intervals() == 0 {
        // No way around the cones is known. What the program makes of the way through them tells by
        // how much they are violated.
        fastest.profile = problem.perturbed_eigenaxis(Perturbation::Far);
    }
    let fastest = SlewMotion::of_profile(&fastest.profile);
    // Other guesses go between the same rolls.
    let ends = slew.ends_towards(&fastest);
    let problem = problem.between(&ends[0], &ends[1]);
    let mut guesses = vec![match &vehicle.pinned_null {
        Some(null) => fastest.with_null_space(null, dynamics),
        None => fastest,
    }];
    // The fastest motion uses torques that the pseudo-inverse cannot give.
    if converged && cost_weights.is_time_only() && vehicle.pinned_null.is_none() {
        return guesses;
    }
    if dynamics.cones.is_empty() {
        let perturbed_eigenaxis = [Perturbation::Far, Perturbation::Near]
            .map(|side| SlewMotion::of_profile(&problem.perturbed_eigenaxis(side)));
        guesses.extend(perturbed_eigenaxis);
    } else {
        let around = around_cones::guesses(&problem, None).take(MAX_AROUND_CONES);
        guesses.extend(around.map(|guess| SlewMotion::of_profile(&guess)));
    }
    guesses
}

impl Slew {
    /// Number of intervals for a motion in continuous time where the caller gives none.
    pub(super) fn usual_intervals(&self) -> usize {
        let resolution = Resolution::of(Accuracy::Standard, &self.vehicle().dynamics);
        resolution.intervals + self.intervals_of_fastest()
    }

    /// Number of intervals of the fastest motion; stored momentum under a rate limit asks for more.
    pub(super) fn intervals_of_fastest(&self) -> usize {
        let dynamics = &self.vehicle().dynamics;
        let [from, to] = self.ends();
        let turn = self.arrival().turn(&from.attitude, &to.attitude);
        Resolution::of(Accuracy::Standard, dynamics).intervals_of(dynamics, turn)
    }
}
