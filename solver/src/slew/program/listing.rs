//! The terms of a program: what each wheel, and each linear variable, adds to cost, links and limits.
//!
//! The inequalities of a node come in this order: the conditions on the state; those of each wheel
//! (torque, then energy against its slack); the least and the greatest length, or the budget; the slacks;
//! the body rates in the middle of the interval.

use super::{Program, TermTarget, WheelTerm};
use crate::nlp::{Chain, Link};
use crate::slew::jet::Jet;
use crate::slew::shape::{IntervalLengths, TorqueCourse};
use crate::slew::terms::DrivenWheel;

impl Program {
    /// Passes every nonlinear term of a link to `show`.
    pub(super) fn terms<'a>(&self, link: &'a Link<'a>, mut show: impl FnMut(&WheelTerm<'a>)) {
        let shape = &self.shape;
        let mut row = self.base.state_inequalities(link.node);
        let cost_weights = &self.cost_weights;
        for wheel in 0..shape.wheels {
            let state = self.wheel_state(wheel, link);
            let mut emit = |place, jet| {
                show(&WheelTerm {
                    place,
                    jet,
                    wheel,
                    link,
                });
            };
            let mut limit = |jet: Jet| {
                row += 1;
                (TermTarget::Inequality(row - 1), jet)
            };
            let reserve = self.torque_reserve[link.node];
            if shape.course == TorqueCourse::Ramps {
                for margin in self.wheels[wheel].node_margins(&state) {
                    let (place, jet) = limit(margin - Jet::constant(reserve));
                    emit(place, jet);
                }
            }
            if !link.has_interval() {
                continue;
            }
            if shape.course == TorqueCourse::Steps {
                for margin in self.wheels[wheel].step_margins(&state) {
                    let margin = margin - state.length() * reserve;
                    let (place, jet) = limit(margin * self.scales.time.recip());
                    emit(place, jet);
                }
            }
            emit(
                TermTarget::Gap(3 + wheel),
                state.impulse() * self.scales.momentum.recip(),
            );
            if cost_weights.effort > 0.0 {
                emit(
                    TermTarget::Cost,
                    state.effort() * (cost_weights.effort / self.units.cost),
                );
            }
            if cost_weights.uses_energy() {
                let energy = self.wheels[wheel].energy(&state);
                if shape.slacks {
                    let (place, jet) = limit(energy * -self.units.energy.recip());
                    emit(place, jet);
                } else {
                    self.spend(&energy, &mut emit);
                }
            }
        }
    }

    /// Adds energy to the cost or to the energy account where no slack stands for it.
    fn spend(&self, energy: &Jet, emit: &mut impl FnMut(TermTarget, Jet)) {
        if self.cost_weights.energy > 0.0 {
            emit(
                TermTarget::Cost,
                *energy * (self.cost_weights.energy / self.units.cost),
            );
        }
        if self.shape.energy_account {
            let place = TermTarget::Gap(self.shape.energy_account_at());
            emit(place, *energy * self.units.energy.recip());
        }
    }

    /// First inequality of a wheel at a node and on its interval; one past the last of all wheels for
    /// `wheel` equal to their number.
    fn wheel_rows_at(&self, node: usize, wheel: usize) -> usize {
        let interval = node < self.base.intervals();
        let rows = |wheel: &DrivenWheel| match self.shape.course {
            TorqueCourse::Ramps => 2,
            TorqueCourse::Steps if interval => wheel.step_rows(),
            TorqueCourse::Steps => 0,
        };
        let slacks = usize::from(self.shape.slacks && interval);
        let before: usize = self.wheels[..wheel].iter().map(|w| rows(w) + slacks).sum();
        self.base.state_inequalities(node) + before
    }

    /// Number of the inequalities of a node and its interval.
    pub(super) fn rows(&self, node: usize) -> usize {
        let middle = if node == self.base.intervals() {
            0
        } else {
            self.base.middle_limits()
        };
        self.middle_rows_at(node) + middle
    }

    /// First inequality of the body rates in the middle of an interval.
    pub(super) fn middle_rows_at(&self, node: usize) -> usize {
        let shared_rows = if node == self.base.intervals() {
            usize::from(self.cost_weights.budget.is_some())
        } else {
            usize::from(self.limits_length())
                + usize::from(self.base.longest_at(node).is_some())
                + if self.shape.slacks {
                    self.shape.wheels
                } else {
                    0
                }
        };
        self.wheel_rows_at(node, self.shape.wheels) + shared_rows
    }

    fn limits_length(&self) -> bool {
        self.shape.course == TorqueCourse::Ramps
            && !matches!(self.shape.lengths, IntervalLengths::Given(_))
    }

    /// Energy drawn from the supply per unit of a wheel's slack, J: the unit over the motor's efficiency.
    fn supply_energy_per_slack(&self, wheel: usize) -> f64 {
        self.units.energy / self.efficiency[wheel]
    }

    /// Passes every linear term to `show` as `(target, variable or none, coefficient)`.
    pub(super) fn linear_terms(
        &self,
        node: usize,
        mut show: impl FnMut(TermTarget, Option<usize>, f64),
    ) {
        let mut row = self.wheel_rows_at(node, self.shape.wheels);
        if node == self.base.intervals() {
            self.budget_terms(row, &mut show);
            return;
        }
        self.carried_terms(&mut show);
        self.length_terms(node, &mut show);
        if self.limits_length() {
            show(
                TermTarget::Inequality(row),
                self.shape.length_variable(),
                1.0,
            );
            row += 1;
        }
        if let Some(longest) = self.base.longest_at(node) {
            let target = TermTarget::Inequality(row);
            show(target, None, 1.0);
            show(target, self.shape.length_variable(), -longest.recip());
            row += 1;
        }
        if self.shape.slacks {
            self.slack_terms(node, row, &mut show);
        }
    }

    /// The inequality of the last node: the energy account is at most the budget.
    fn budget_terms(&self, row: usize, show: &mut impl FnMut(TermTarget, Option<usize>, f64)) {
        if let Some(budget) = self.cost_weights.budget {
            let target = TermTarget::Inequality(row);
            show(target, None, budget / self.units.energy);
            show(target, Some(self.shape.energy_account_at()), -1.0);
        }
    }

    /// States that the next node begins with: momenta as they are, node torques from the controls.
    fn carried_terms(&self, show: &mut impl FnMut(TermTarget, Option<usize>, f64)) {
        let (shape, states) = (&self.shape, self.shape.states());
        for i in 3..shape.torque_at() {
            show(TermTarget::Gap(i), Some(i), 1.0);
        }
        if shape.course == TorqueCourse::Ramps {
            for wheel in 0..shape.wheels {
                show(
                    TermTarget::Gap(shape.torque_at() + wheel),
                    Some(states + wheel),
                    1.0,
                );
            }
        }
    }

    /// What is linear in the length of an interval: time in the cost, the shared length, the clock, and
    /// the energy of the electronics.
    fn length_terms(&self, node: usize, show: &mut impl FnMut(TermTarget, Option<usize>, f64)) {
        let shape = &self.shape;
        let length = shape.length_variable();
        let given = match &shape.lengths {
            IntervalLengths::Given(lengths) => lengths[node] / self.scales.time,
            _ => 1.0,
        };
        show(
            TermTarget::Cost,
            length,
            given * self.cost_weights.time * self.scales.time / self.units.cost,
        );
        if shape.lengths == IntervalLengths::Shared {
            show(
                TermTarget::Gap(shape.shared_at()),
                Some(shape.shared_at()),
                1.0,
            );
        }
        if shape.clock {
            show(
                TermTarget::Gap(shape.clock_at()),
                Some(shape.clock_at()),
                1.0,
            );
            show(TermTarget::Gap(shape.clock_at()), length, given);
        }
        if shape.energy_account {
            show(
                TermTarget::Gap(shape.energy_account_at()),
                Some(shape.energy_account_at()),
                1.0,
            );
        }
        if shape.energy_account && self.cost_weights.uses_bill() {
            let idle = self.quiescent_power * self.scales.time / self.units.energy;
            show(
                TermTarget::Gap(shape.energy_account_at()),
                length,
                given * idle,
            );
        }
    }

    /// The slacks: bounds below them, and their share of cost and energy account.
    fn slack_terms(
        &self,
        node: usize,
        row: usize,
        show: &mut impl FnMut(TermTarget, Option<usize>, f64),
    ) {
        let (shape, states) = (&self.shape, self.shape.states());
        for wheel in 0..shape.wheels {
            let slack = Some(states + shape.slack_at() + wheel);
            // The row of the wheel's energy is its last.
            let energy_row = self.wheel_rows_at(node, wheel + 1) - 1;
            show(TermTarget::Inequality(energy_row), slack, 1.0);
            show(TermTarget::Inequality(row + wheel), slack, 1.0);
            let supplied = self.supply_energy_per_slack(wheel);
            if self.cost_weights.energy > 0.0 {
                let weight = self.cost_weights.energy / self.units.cost;
                show(TermTarget::Cost, slack, supplied * weight);
            }
            if shape.energy_account {
                let at = TermTarget::Gap(shape.energy_account_at());
                show(at, slack, supplied / self.units.energy);
            }
        }
    }
}
