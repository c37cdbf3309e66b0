//! Legs solved from guesses of the caller's choice, to judge the starts of the solver against others.

use super::canonical::CanonicalLeg;
use super::legs::{certify, end_of};
use super::places::Places;
use super::tour_pairs;
use crate::leg::profile::Profile;
use crate::leg::solve;
use crate::model::attitude::Attitude;
use crate::model::scenario::Scenario;
use crate::tour::legs::LegKind;
use nalgebra::Vector3;
use std::collections::HashSet;

/// The distinct legs from rest to rest that a tour of a scenario can contain, without its cones.
pub struct LegTrials<'a> {
    places: Places<'a>,
    legs: Vec<(String, CanonicalLeg)>,
}

/// One of them, in the frame in which it begins at the identity attitude.
#[derive(Clone, Copy)]
pub struct LegTrial<'a> {
    places: &'a Places<'a>,
    name: &'a str,
    leg: &'a CanonicalLeg,
}

/// What the solver makes of a leg by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegAnswer {
    /// Duration, s, where it is solved.
    pub duration_s: Option<f64>,
    /// Certified lower bound, s.
    pub certified_lower_bound_s: Option<f64>,
    /// Programs that were solved for it.
    pub programs: u64,
}

/// A node of a starting guess.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuessNode {
    /// Time since the node before, s; of the first node not used.
    pub after_s: f64,
    /// The attitude there; the last one decides with which quaternion sign the motion arrives, where
    /// either counts.
    pub attitude: Attitude,
    /// The body rate there, rad/s.
    pub rate_rad_s: Vector3<f64>,
}

impl<'a> LegTrials<'a> {
    /// The legs of a scenario, equal ones once.
    #[must_use]
    pub fn of(scenario: &'a Scenario) -> Self {
        let places = Places::of(scenario);
        let mut listed = HashSet::new();
        let mut legs = Vec::new();
        for (from, to) in tour_pairs(&places) {
            let [begin, end] = [from, to].map(|place| end_of(&places, LegKind::RestToRest, place));
            let leg = CanonicalLeg::of(&places, &begin, &end);
            if listed.insert(leg.identity.clone()) {
                legs.push((format!("{}-{}", places.name(from), places.name(to)), leg));
            }
        }
        Self { places, legs }
    }

    /// The legs, one after the other.
    pub fn legs(&self) -> impl Iterator<Item = LegTrial<'_>> {
        let places = &self.places;
        let legs = self.legs.iter();
        legs.map(move |(name, leg)| LegTrial { places, name, leg })
    }
}

impl LegTrial<'_> {
    /// The places between which it leads, joined.
    #[must_use]
    pub fn name(&self) -> &str {
        self.name
    }

    /// The attitude at its end.
    #[must_use]
    pub fn target(&self) -> Attitude {
        self.leg.to.attitude
    }

    /// Intervals of its program.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.leg.problem(&self.places.extremals).intervals()
    }

    /// Solves it as the solver does, with its bound.
    #[must_use]
    pub fn answer(&self) -> LegAnswer {
        let bound = certify(self.places, self.leg).lower_bound;
        let problem = self.leg.problem(&self.places.extremals);
        let solved = solve::solve(&problem, bound, &|| None);
        LegAnswer {
            duration_s: solved.solution.duration(),
            certified_lower_bound_s: bound,
            programs: solved.solves,
        }
    }

    /// Solves it from one guess alone: the duration of the local minimum, s, where there is one.
    #[must_use]
    pub fn from_guess(&self, nodes: &[GuessNode]) -> Option<f64> {
        let problem = self.leg.problem(&self.places.extremals);
        let mut guess = Profile::empty();
        for node in nodes {
            let wheels = problem
                .dynamics
                .wheels_at(&node.attitude, &node.rate_rad_s, problem.null);
            guess.wheels.push(wheels);
            guess.attitudes.push(node.attitude);
        }
        guess.lengths = nodes.iter().skip(1).map(|node| node.after_s).collect();
        let solution = problem.solve_from(&guess, &|| None);
        solution.duration()
    }
}
