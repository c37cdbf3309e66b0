//! Evidence of optimality: how well a solution keeps the conditions of the minimum principle.
//!
//! The multipliers of the program's links are the costates at the ends of its intervals: `p` of a
//! turn in body axes, `r` of the wheels' momenta, `p_t` of time where a speed law moves a wheel's
//! momentum `d(t)`, on which the body rate depends: `w = Ji (R^T H_total - h_locked - d - A h)`. With
//! the running cost `l` the Hamiltonian and the costates between the nodes are
//!
//! ```text
//!   H   = l(u, W) + p . w + r . u
//!   H + p_t                                                constant; zero when the duration is free
//!   p'   = -w x p + (R^T H_total) x (Ji y)                 s/rad per s
//!   r'   = A^T Ji y - (dl/dW / I)^T                        per N m s per s
//!   p_t' = -dH/dt = (Ji y) . d'                            per s per s
//!   y    = p - A (dl/dW)^T
//! ```
//!
//! A drift makes `H` depend on time explicitly, and `H` changes along an optimum by `dH/dt`. `p_t` is
//! the integral of `dH/dt` from now to the end; it is also the derivative of the objective by an
//! advance in time of the speed law. It has a value at the end where the end conditions depend on
//! time: a prescribed final rate does, since the momentum of the drifting wheels then depends on it.
//! (With time as a state this is the minimum principle of an autonomous system.)
//!
//! The torques minimise `H` at every time (`controls`): each torque by itself, or all torques together
//! where the pseudo-inverse allocates them. Where `l` does not depend on torque, torques are at limits.
//! An active limit of speed or rate makes the costates jump at nodes by its multipliers. Of momenta
//! that the pseudo-inverse moves, only three combinations can change: their costates are `(A^+)^T r`.
//!
//! Only the multipliers at the nodes are taken from the program. The costates are integrated from there
//! by these equations, and a jump at a node that no active limit explains is the
//! [`Evidence::costate_defect`].

mod controls;
mod cost;
mod costate;

use super::flow::MotionSample;
use super::outcome::SlewOutcome;
use super::program::Program;
use super::solving::ProgramSolution;
use super::spec::WheelAllocation;
use super::validated::Slew;
use crate::nlp::{Chain, Layout};
use crate::run::stop::StopSignal;
use controls::Controls;
use cost::RunningCost;
use costate::{Costate, PARTS};
use nalgebra::Vector3;

/// The conditions of the minimum principle along a solution.
#[derive(Debug, Clone)]
pub struct Evidence {
    /// Every interval whose length has not shrunk to zero.
    pub intervals: Vec<IntervalEvidence>,
    /// What is controlled: the torques of all wheels, or with [`WheelAllocation::PseudoInverse`] the
    /// torque on all wheels together, in body axes.
    pub controls: WheelAllocation,
    /// Mean of `H + p_t` over the duration: zero when the duration is free, otherwise the derivative of
    /// the objective by the duration.
    pub hamiltonian: f64,
    /// Scale of its differences: the mean of `|p . w + r . u|`, which is one for minimum time.
    pub scale: f64,
    /// Greatest difference of an interval's average of `H + p_t` from the mean, in the scale.
    pub average_spread: f64,
    /// Greatest difference of `H + p_t` at any time from the mean, in the scale.
    pub pointwise_spread: f64,
    /// Greatest difference of `H` alone at any time from its mean, in the scale: the effect of drifting
    /// wheels; without them it is the pointwise spread.
    pub variation: f64,
    /// Mean over the duration of the difference of the Hamiltonian from its minimum over the torques, in
    /// the scale.
    pub principle_gap: f64,
    /// Greatest jump at a node where no limit is active, of a momentum costate relative to the size of
    /// these or of `p_t` in the scale.
    pub costate_defect: f64,
    /// Greatest product of a limit's slack and its multiplier, in the unit of the objective.
    pub complementarity: f64,
    /// Of the integral of the absolute switching functions of torques at limits, the share of torques
    /// at the limit that the minimum principle prescribes; one where no torque is at a limit.
    pub switching_agreement: f64,
}

/// The conditions on one interval. Lists have one entry per control: the commanded wheels, or three
/// body axes where the pseudo-inverse allocates torques.
#[derive(Debug, Clone)]
pub struct IntervalEvidence {
    /// Time at the beginning, s.
    pub start_s: f64,
    /// Length, s.
    pub duration_s: f64,
    /// Costate of the attitude in body axes at beginning and end, unit of the objective per rad.
    pub attitude_costate: [Vector3<f64>; 2],
    /// Costates of the momenta that the controls move, at beginning and end, per N m s.
    pub momentum_costate: [Vec<f64>; 2],
    /// `p_t` at beginning and end, per s; zero where no speed law moves a wheel.
    pub time_costate: [f64; 2],
    /// Derivatives of `H` by the controls at beginning and end, per N m s.
    pub switching: [Vec<f64>; 2],
    /// Average of `H + p_t`, and its least and greatest value.
    pub hamiltonian: [f64; 3],
}

/// The evidence for an outcome; `None` when it is not solved, its polishing does not converge, or the
/// stop signal is set.
///
/// The solution is polished first, which takes a few more iterations.
#[must_use]
pub fn of(slew: &Slew, outcome: &SlewOutcome, stop: &StopSignal) -> Option<Evidence> {
    if !outcome.solved {
        return None;
    }
    let polished = outcome.solution.polished(slew.vehicle(), &|| stop.reason());
    if stop.is_set() || !polished.converged() {
        return None;
    }
    let torques_alone = RunningCost::new(slew.vehicle(), &polished.program.cost_weights, 0.0);
    let witness = OptimalityTest {
        slew,
        controls: Controls::new(slew.allocation(), &torques_alone),
        solved: &polished,
        layout: Layout::of(&polished.program),
    };
    Some(witness.evidence())
}

struct OptimalityTest<'a> {
    slew: &'a Slew,
    controls: Controls,
    solved: &'a ProgramSolution,
    layout: Layout,
}

/// Samples and costates of an interval. There are two samples per step, since a Runge-Kutta step of
/// fourth order evaluates its middle too.
struct IntervalCostates<'a> {
    samples: Vec<MotionSample>,
    costates: Vec<Costate>,
    running: RunningCost<'a>,
}

impl IntervalCostates<'_> {
    /// The times at which the conditions are evaluated.
    fn moments(&self) -> impl Iterator<Item = (&Costate, &MotionSample)> {
        self.costates.iter().zip(self.samples.iter().step_by(2))
    }
}

/// The conditions on an interval, and its contributions to those of the whole solution.
struct TestedInterval {
    evidence: IntervalEvidence,
    /// Average, least and greatest value of the Hamiltonian alone.
    alone: [f64; 3],
    /// Integral of the size of `p . w + r . u`.
    motion: f64,
    /// Integral of the Hamiltonian's difference from its minimum over the torques.
    gap: f64,
    /// Integrals of the absolute switching functions of all torques at limits, and of those at the
    /// limit that the minimum principle prescribes.
    limited: [f64; 2],
}

impl OptimalityTest<'_> {
    fn program(&self) -> &Program {
        &self.solved.program
    }

    fn evidence(&self) -> Evidence {
        let total = self.solved.motion.duration();
        let tested: Vec<TestedInterval> = (0..self.program().intervals())
            .filter(|k| self.solved.motion.lengths[*k] > SHORTEST * total)
            .map(|k| self.test(k))
            .collect();
        let time: f64 = tested.iter().map(|t| t.evidence.duration_s).sum();
        let sum = |of: &dyn Fn(&TestedInterval) -> f64| tested.iter().map(of).sum::<f64>();
        let mean =
            |of: &dyn Fn(&TestedInterval) -> f64| sum(&|t| of(t) * t.evidence.duration_s) / time;
        let hamiltonian = mean(&|t| t.evidence.hamiltonian[0]);
        let alone = mean(&|t| t.alone[0]);
        let scale = sum(&|t| t.motion) / time;
        let spread =
            |of: &dyn Fn(&TestedInterval) -> f64| tested.iter().map(of).fold(0.0, f64::max) / scale;
        let (limited, right) = (sum(&|t| t.limited[0]), sum(&|t| t.limited[1]));
        Evidence {
            controls: self.slew.allocation(),
            average_spread: spread(&|t| (t.evidence.hamiltonian[0] - hamiltonian).abs()),
            pointwise_spread: spread(&|t| furthest(t.evidence.hamiltonian, hamiltonian)),
            variation: spread(&|t| furthest(t.alone, alone)),
            principle_gap: sum(&|t| t.gap) / time / scale,
            costate_defect: self.costate_defect(scale),
            complementarity: self.complementarity(),
            switching_agreement: if limited > 0.0 { right / limited } else { 1.0 },
            intervals: tested.into_iter().map(|t| t.evidence).collect(),
            hamiltonian,
            scale,
        }
    }

    /// Weight of energy in the running cost on an interval, unit of the objective per J: that in the
    /// objective plus the multiplier of the budget.
    fn energy_weight(&self, k: usize) -> f64 {
        let program = self.program();
        let lambda = &self.solved.iterate.lambda[self.layout.link(k)];
        let spent = if program.shape.energy_account {
            lambda[program.shape.energy_account_at()] * program.units.cost / program.units.energy
        } else {
            0.0
        };
        program.cost_weights.energy + spent
    }

    fn interval_costates(&self, k: usize) -> IntervalCostates<'_> {
        let vehicle = self.slew.vehicle();
        let motion = &self.solved.motion;
        let energy_weight = self.energy_weight(k);
        let running = RunningCost::new(vehicle, &self.program().cost_weights, energy_weight);
        let begin: f64 = motion.lengths[..k].iter().sum();
        let samples = vehicle.samples(motion, k, begin, 2 * PARTS);
        IntervalCostates {
            costates: self.costates(k, &samples, &running),
            samples,
            running,
        }
    }

    fn test(&self, k: usize) -> TestedInterval {
        let length = self.solved.motion.lengths[k];
        let interval = self.interval_costates(k);
        let (running, controls) = (&interval.running, &self.controls);
        let integral = |of: &dyn Fn(&Costate, &MotionSample) -> f64| {
            let values: Vec<f64> = interval.moments().map(|(p, at)| of(p, at)).collect();
            trapezoid(&values) * length
        };
        let moving =
            |p: &Costate, at: &MotionSample| p.attitude.dot(&at.rate) + p.momenta.dot(&at.torques);
        let hamiltonian = |p: &Costate, at: &MotionSample| running.value(at) + moving(p, at);
        let alone: Vec<f64> = interval
            .moments()
            .map(|(p, at)| hamiltonian(p, at))
            .collect();
        let times = interval.costates.iter().map(|p| p.time);
        let constant: Vec<f64> = alone.iter().zip(times).map(|(h, p)| h + p).collect();
        let ends = [0, PARTS].map(|i| (&interval.costates[i], &interval.samples[2 * i]));
        let mut limited = [0.0; 2];
        for (p, at) in interval.moments() {
            for (sum, size) in limited.iter_mut().zip(controls.limited(p, at, running)) {
                *sum += size * length;
            }
        }
        TestedInterval {
            evidence: IntervalEvidence {
                start_s: self.solved.motion.lengths[..k].iter().sum(),
                duration_s: length,
                attitude_costate: ends.map(|(p, _)| p.attitude),
                momentum_costate: ends
                    .map(|(p, _)| controls.onto_controls(p.momenta.iter().copied())),
                time_costate: ends.map(|(p, _)| p.time),
                switching: ends.map(|(p, at)| controls.switching(p, at, running)),
                hamiltonian: mean_min_max(&constant),
            },
            alone: mean_min_max(&alone),
            motion: integral(&|p, at| moving(p, at).abs()),
            gap: integral(&|p, at| controls.gap(p, at, running)),
            limited,
        }
    }

    /// Greatest jump of the costates at a node without active limits.
    fn costate_defect(&self, scale: f64) -> f64 {
        let (mut worst, mut size, mut late) = (0.0_f64, 0.0_f64, 0.0_f64);
        let momenta = |p: &Costate| self.controls.onto_controls(p.momenta.iter().copied());
        for k in 1..self.program().intervals() {
            let interval = self.interval_costates(k);
            let (before, after) = (self.end_costate(k - 1), &interval.costates[0]);
            let pairs: Vec<_> = momenta(&before).into_iter().zip(momenta(after)).collect();
            size = pairs.iter().map(|(own, _)| own.abs()).fold(size, f64::max);
            if !interval.running.held(&interval.samples[0]).contains(&true) {
                let jumps = pairs.iter().map(|(from, to)| (to - from).abs());
                worst = jumps.fold(worst, f64::max);
                late = late.max((after.time - before.time).abs());
            }
        }
        if size > 0.0 {
            (worst / size).max(late / scale)
        } else {
            0.0
        }
    }

    fn complementarity(&self) -> f64 {
        let iterate = &self.solved.iterate;
        let products = iterate
            .slack
            .iter()
            .zip(&iterate.z)
            .map(|(s, z)| (s * z).abs());
        products.fold(0.0, f64::max) * self.program().units.cost
    }
}

/// Intervals shorter than this share of the duration count as shrunk to zero.
const SHORTEST: f64 = 1e-4;

/// Mean of values at equal distances.
fn trapezoid(values: &[f64]) -> f64 {
    let sums = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    sums.sum::<f64>() / (values.len() - 1) as f64
}

/// Mean, least and greatest of values at equal distances.
fn mean_min_max(values: &[f64]) -> [f64; 3] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [trapezoid(values), least, greatest]
}

/// Greatest distance of a range, given as mean, least and greatest value, from a value.
fn furthest([_, least, greatest]: [f64; 3], from: f64) -> f64 {
    (greatest - from).max(from - least)
}
