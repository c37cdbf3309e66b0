//! Guesses for a manoeuvre: the fastest motion, and slews about the eigenaxis bowed to either side.

use super::Manoeuvre;
use super::ingredients::Ingredients;
use super::motion::Motion;
use crate::leg::solve::eigenaxis::Side;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::leg::solve::{self, Resolution, SlewProblem};
use crate::model::spec::Accuracy;
use crate::nlp::Interruption;

/// The guesses, best first: minimum time has one, since the fastest motion is itself the best of
/// several; what is smooth, or may not use all torques, may have more than one minimum.
pub(super) fn of(
    manoeuvre: &Manoeuvre,
    ingredients: Ingredients,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Vec<Motion> {
    let vehicle = manoeuvre.vehicle();
    let dynamics = &vehicle.dynamics;
    let ends = manoeuvre.ends();
    let null = dynamics.null_component(manoeuvre.start_momenta());
    let problem = SlewProblem {
        dynamics,
        from: &ends[0],
        to: &ends[1],
        arrival: manoeuvre.arrival(),
        null: &null,
        extremals: &KinematicExtremals::of(dynamics),
        resolution: Resolution::of(Accuracy::Standard, dynamics),
    };
    let fastest = solve::solve(&problem, None, stop).flown;
    let converged = fastest.duration().is_some();
    let fastest = Motion::of_profile(&fastest.profile);
    let mut guesses = vec![match &vehicle.kept {
        Some(null) => fastest.keeping(null, dynamics),
        None => fastest,
    }];
    // Where the pseudo-inverse shares torques out, the fastest motion is another problem's.
    if !converged || !ingredients.hurries() || vehicle.kept.is_some() {
        let bowed = [Side::Far, Side::Near].map(|side| Motion::of_profile(&problem.bowed(side)));
        guesses.extend(bowed);
    }
    guesses
}

impl Manoeuvre {
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
