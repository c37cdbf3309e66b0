//! The filter: which pairs of infeasibility and barrier cost are still progress.

use super::merit::Merit;

/// Fraction of the infeasibility by which a point must improve on a filter entry.
const GAMMA_THETA: f64 = 1e-5;
/// Fraction of the infeasibility by which the barrier cost must improve on a filter entry.
const GAMMA_PHI: f64 = 1e-5;
/// Largest infeasibility that is ever admitted, as a multiple of that at the filter's reset, and
/// the least such bound (absolute).
const MAX_THETA_FACTOR: f64 = 1e4;
const MIN_MAX_THETA: f64 = 1e-2;
/// Sufficient decrease (Armijo) of the barrier cost.
const ETA: f64 = 1e-4;

/// Relative differences of barrier costs and absolute infeasibilities below these are rounding. The
/// last steps change little but the multipliers; judged by rounding they would be shortened to
/// nothing.
const PHI_NOISE: f64 = 1e-11;
const THETA_NOISE: f64 = 1e-12;

/// The filter of Waechter and Biegler, with its acceptance rules.
#[derive(Debug, Default)]
pub(super) struct Filter {
    entries: Vec<Merit>,
    theta_max: f64,
    theta_min: f64,
}

/// Why a trial was accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Acceptance {
    /// The barrier cost decreased sufficiently along a descent direction.
    Descent,
    /// Infeasibility or cost improved; the old point enters the filter.
    Progress,
}

impl Filter {
    /// An empty filter with room for this many entries.
    pub(super) fn with_capacity(entries: usize) -> Self {
        Self {
            entries: Vec::with_capacity(entries),
            ..Self::default()
        }
    }

    /// Empties the filter and sets its scales from a point's infeasibility.
    pub(super) fn reset(&mut self, theta: f64) {
        self.entries.clear();
        self.theta_max = (MAX_THETA_FACTOR * theta).max(MIN_MAX_THETA);
        self.theta_min = 1e-4 * theta.max(1.0);
    }

    /// Whether no entry of the filter forbids a point.
    pub(super) fn admits(&self, point: Merit) -> bool {
        point.theta <= self.theta_max && self.entries.iter().all(|entry| improves(point, *entry))
    }

    /// Judges a trial at step length `alpha`; `slope` is the derivative of the barrier cost along
    /// the step.
    pub(super) fn judge(
        &self,
        current: Merit,
        trial: Merit,
        slope: f64,
        alpha: f64,
    ) -> Option<Acceptance> {
        let slack = PHI_NOISE * current.phi.abs().max(1.0);
        let relaxed = Merit {
            theta: trial.theta,
            phi: trial.phi - slack,
        };
        if !self.admits(relaxed) {
            return None;
        }
        let descends = slope < 0.0
            && alpha * (-slope).powf(2.3) > current.theta.powf(1.1)
            && current.theta <= self.theta_min;
        if descends {
            let enough = trial.phi - current.phi - slack <= ETA * alpha * slope;
            return enough.then_some(Acceptance::Descent);
        }
        improves(relaxed, current).then_some(Acceptance::Progress)
    }

    /// Forbids everything that is not better than this point.
    pub(super) fn add(&mut self, point: Merit) {
        self.entries
            .retain(|entry| entry.theta < point.theta || entry.phi < point.phi);
        self.entries.push(point);
    }
}

fn improves(point: Merit, over: Merit) -> bool {
    point.theta.max(THETA_NOISE) <= (1.0 - GAMMA_THETA) * over.theta
        || point.phi <= over.phi - GAMMA_PHI * over.theta
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merit(theta: f64, phi: f64) -> Merit {
        Merit { theta, phi }
    }

    #[test]
    fn a_dominated_point_is_refused_and_one_better_in_theta_or_phi_is_admitted() {
        let mut filter = Filter::default();
        filter.reset(1.0);
        filter.add(merit(1.0, 1.0));
        assert!(!filter.admits(merit(1.0, 1.0)));
        assert!(filter.admits(merit(0.5, 2.0)));
        assert!(filter.admits(merit(2.0, 0.5)));
        assert!(
            !filter.admits(merit(2e4, -5.0)),
            "beyond the largest infeasibility"
        );
    }

    #[test]
    fn rounding_neither_forbids_nor_counts_as_progress() {
        let mut filter = Filter::default();
        filter.reset(1.0);
        let here = merit(1e-14, 46.0);
        filter.add(merit(2e-14, 46.0));
        // Uphill by less than the noise, and a larger infeasibility that is noise too.
        let judge = |theta, phi| filter.judge(here, merit(theta, phi), 1e-12, 1.0);
        assert_eq!(judge(3e-14, 46.0 + 1e-11), Some(Acceptance::Progress));
        assert_eq!(judge(1e-15, 46.0 + 1e-6), None);
    }

    #[test]
    fn from_a_feasible_point_the_cost_must_decrease() {
        let mut filter = Filter::default();
        filter.reset(1.0);
        let here = merit(1e-9, 1.0);
        let judge = |phi| filter.judge(here, merit(1e-9, phi), -1.0, 1.0);
        assert_eq!(judge(0.5), Some(Acceptance::Descent));
        assert_eq!(judge(1.0 + 1e-6), None);
    }
}
