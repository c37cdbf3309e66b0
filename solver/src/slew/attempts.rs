//! Solutions of one program from one guess after the other.

use super::motion::Motion;
use super::solving::{Solved, Task};
use super::{Found, Manoeuvre, Plain, flown, starts};
use crate::nlp::Interruption;

/// Shares of effort in the objectives of a continuation to the fastest motion.
const EFFORT_SHARES: [f64; 4] = [0.1, 1e-2, 1e-3, 1e-4];

/// Solves one program: from a neighbour, or from the best of the usual guesses.
pub(super) fn direct(
    manoeuvre: &Manoeuvre,
    plain: &Plain,
    neighbour: Option<&Motion>,
    stop: &dyn Fn() -> Option<Interruption>,
) -> Found {
    let mut attempts = Attempts {
        manoeuvre,
        plain,
        stop,
        best: None,
        starts: 0,
        iterations: 0,
    };
    if !neighbour.is_some_and(|guess| attempts.converges_from(guess)) {
        attempts.try_usual_guesses();
    }
    Found {
        solved: attempts.best.expect("there is always a guess"),
        starts: attempts.starts,
        iterations: attempts.iterations,
        continuous_time: None,
        refusal: None,
    }
}

/// The best solution so far, and what it took.
struct Attempts<'a> {
    manoeuvre: &'a Manoeuvre,
    plain: &'a Plain,
    stop: &'a dyn Fn() -> Option<Interruption>,
    best: Option<Solved>,
    starts: usize,
    iterations: usize,
}

impl Attempts<'_> {
    /// Solves the program from a guess; whether it converges.
    fn converges_from(&mut self, guess: &Motion) -> bool {
        let plain = self.plain;
        let mut solved = self.solve(plain, guess);
        if plain.ingredients.bills() && plain.ingredients.budget.is_none() {
            // The program's own bill is low by a different amount for every motion.
            solved.cost = flown::fly(self.manoeuvre, &solved.motion).energies.bill_j;
        }
        let converged = solved.converged();
        if self.best.as_ref().is_none_or(|best| solved.improves(best)) {
            self.best = Some(solved);
        }
        converged
    }

    /// Solves this program, or one that leads to it, from a guess.
    fn solve(&mut self, plain: &Plain, guess: &Motion) -> Solved {
        let task = Task {
            vehicle: self.manoeuvre.vehicle(),
            ends: self.manoeuvre.ends_towards(guess),
            shape: plain.shape.clone(),
            ingredients: plain.ingredients,
        };
        let solved = task.solve(&plain.meshed(guess, self.manoeuvre), self.stop);
        self.starts += 1;
        self.iterations += solved.iterations;
        solved
    }

    fn try_usual_guesses(&mut self) {
        let Self {
            manoeuvre,
            plain,
            stop,
            ..
        } = *self;
        let mut guesses: Vec<_> = self.optimum_of_proxy().into_iter().collect();
        guesses.extend(starts::of(manoeuvre, plain.ingredients, stop));
        let mut converged = false;
        for guess in &guesses {
            converged |= self.converges_from(guess);
            if stop().is_some() {
                return;
            }
        }
        if !converged && plain.ingredients.hurries() {
            self.continue_in_effort(&guesses[0]);
        }
    }

    /// The motion that the smooth proxy of a bill leads to.
    fn optimum_of_proxy(&mut self) -> Option<Motion> {
        let proxy = self.plain.proxy(self.manoeuvre)?;
        let found = direct(self.manoeuvre, &proxy, None, self.stop);
        self.starts += found.starts;
        self.iterations += found.iterations;
        found.solved.converged().then_some(found.solved.motion)
    }

    /// Continuation in the weight of effort (Allgower and Georg, Introduction to Numerical
    /// Continuation Methods, 2003): where only time counts, some torques may make no difference, and
    /// effort tells them apart. The last program that converges takes longer than the fastest motion
    /// by its share of effort at most.
    fn continue_in_effort(&mut self, guess: &Motion) {
        let mut last: Option<Solved> = None;
        for share in EFFORT_SHARES {
            let weighted = self.plain.with_effort(self.manoeuvre, share, guess);
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
            self.best = Some(Solved { cost, ..last });
        }
    }
}
