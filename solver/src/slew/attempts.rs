//! Solutions of one program from several guesses.

use super::found_solution::FoundSolution;
use super::motion::SlewMotion;
use super::program_choice::ProgramChoice;
use super::solving::{ProgramSolution, ProgramTask};
use super::validated::Slew;
use super::{propagation, starts};
use crate::run::stop::StopReason;

/// Weights of effort, as shares of the weight of time, in a continuation to the fastest motion.
const EFFORT_SHARES: [f64; 4] = [0.1, 1e-2, 1e-3, 1e-4];

/// Solves one program: from a neighbour, or from the best of the usual guesses.
pub(super) fn solve_program(
    slew: &Slew,
    choice: &ProgramChoice,
    neighbour: Option<&SlewMotion>,
    stop: &dyn Fn() -> Option<StopReason>,
) -> FoundSolution {
    let mut attempts = Attempts {
        slew,
        choice,
        stop,
        best: None,
        starts: 0,
        iterations: 0,
    };
    if !neighbour.is_some_and(|guess| attempts.converges_from(guess)) {
        attempts.try_usual_guesses();
    }
    FoundSolution {
        solved: attempts.best.expect("there is always a guess"),
        starts: attempts.starts,
        iterations: attempts.iterations,
        continuous_time: None,
        refusal: None,
    }
}

/// The best solution so far, and how many guesses and iterations have been used.
struct Attempts<'a> {
    slew: &'a Slew,
    choice: &'a ProgramChoice,
    stop: &'a dyn Fn() -> Option<StopReason>,
    best: Option<ProgramSolution>,
    starts: usize,
    iterations: usize,
}

impl Attempts<'_> {
    /// Solves the program from a guess; returns whether the solve converged.
    fn converges_from(&mut self, guess: &SlewMotion) -> bool {
        let choice = self.choice;
        let mut solved = self.solve(choice, guess);
        if choice.cost_weights.uses_bill() && choice.cost_weights.budget.is_none() {
            // The program underestimates the bill by a different amount for every motion.
            solved.cost = propagation::propagate(self.slew, &solved.motion)
                .energies
                .bill_j;
        }
        let converged = solved.converged();
        if self.best.as_ref().is_none_or(|best| solved.improves(best)) {
            self.best = Some(solved);
        }
        converged
    }

    /// Solves this program, or one that leads to it, from a guess.
    fn solve(&mut self, choice: &ProgramChoice, guess: &SlewMotion) -> ProgramSolution {
        let task = ProgramTask {
            vehicle: self.slew.vehicle(),
            ends: self.slew.ends_towards(guess),
            shape: choice.shape.clone(),
            cost_weights: choice.cost_weights,
        };
        let solved = task.solve(&choice.guess_on_nodes(guess, self.slew), self.stop);
        self.starts += 1;
        self.iterations += solved.iterations;
        solved
    }

    fn try_usual_guesses(&mut self) {
        let Self {
            slew, choice, stop, ..
        } = *self;
        let mut guesses: Vec<_> = self.optimum_of_proxy().into_iter().collect();
        guesses.extend(starts::of(slew, choice.cost_weights, stop));
        let mut converged = false;
        for guess in &guesses {
            converged |= self.converges_from(guess);
            if stop().is_some() {
                return;
            }
        }
        if !converged && choice.cost_weights.is_time_only() {
            self.continue_in_effort(&guesses[0]);
        }
    }

    /// The optimum of the smooth proxy, as a guess for a program that minimises the bill.
    fn optimum_of_proxy(&mut self) -> Option<SlewMotion> {
        let proxy = self.choice.proxy(self.slew)?;
        let found = solve_program(self.slew, &proxy, None, self.stop);
        self.starts += found.starts;
        self.iterations += found.iterations;
        found.solved.converged().then_some(found.solved.motion)
    }

    /// Continuation in the weight of effort (Allgower and Georg, Introduction to Numerical
    /// Continuation Methods, 2003). In minimum time some torques may not affect the cost; with a weight
    /// on effort the optimum is unique. The duration of the last program that converges exceeds the
    /// minimum by its share of effort at most.
    fn continue_in_effort(&mut self, guess: &SlewMotion) {
        let mut last: Option<ProgramSolution> = None;
        for share in EFFORT_SHARES {
            let weighted = self.choice.with_effort(self.slew, share, guess);
            let from = last.as_ref().map_or(guess, |last| &last.motion);
            let solved = self.solve(&weighted, from);
            if !solved.converged() {
                break;
            }
            last = Some(solved);
        }
        if let Some(last) = last
            && !self.converges_from(&last.motion)
        {
            let cost = last.motion.duration();
            self.best = Some(ProgramSolution { cost, ..last });
        }
    }
}
