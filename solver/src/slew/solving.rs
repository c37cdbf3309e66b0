//! From a guess to a motion that keeps its limits between nodes too: solve, correct the turns, raise
//! the reserves at limits, solve again.

use super::cost_weights::CostWeights;
use super::flow::Excesses;
use super::motion::SlewMotion;
use super::program::{LengthPenalty, Program, ProgramSetup, ProgramUnits};
use super::shape::{IntervalLengths, ProgramShape};
use super::vehicle::Vehicle;
use crate::leg::detour::guess::{GUESS_STRETCH, longest_intervals};
use crate::leg::multiphase::{
    CONE_TOLERANCE, LARGE_MISS, LIMIT_TOLERANCE, LOCAL_ROUNDS, MISS_TOLERANCE, NEAR_BARRIER,
    NEAR_EXCESS, RESERVE_FACTOR,
};
use crate::leg::transcription::{Reserves, Scales};
use crate::model::waypoint::Waypoint;
use crate::nlp::{
    Chain, InteriorPoint, Iterate, Layout, NlpReport, NlpStatus, Settings, values_of,
};
use crate::run::stop::StopReason;

/// Settings of one solve in a sequence of solves of the same program.
struct SolvePhase {
    settings: Settings,
    length_penalty: f64,
}

/// With unknown interval lengths: a first solve finds which limits are active and about where the
/// torques switch, a second finds the switching times, as for the legs of a tour.
const WITH_LENGTHS: [SolvePhase; 2] = [
    SolvePhase {
        settings: Settings {
            tolerance: 1e-2,
            feasibility: 1e-3,
            ..Settings::COLD
        },
        length_penalty: 0.1,
    },
    SolvePhase {
        settings: Settings {
            initial_barrier: 1e-3,
            max_iterations: 400,
            ..Settings::COLD
        },
        length_penalty: 1e-3,
    },
];
/// The same with stored momentum, from the fastest motion as the guess: the first phase above would
/// lead far away from it.
const NEARBY: [SolvePhase; 1] = [SolvePhase {
    settings: Settings {
        initial_barrier: 3e-5,
        initial_slack: 3e-5,
        max_iterations: 400,
        ..Settings::COLD
    },
    length_penalty: 0.02,
}];
const WITHOUT_LENGTHS: [SolvePhase; 1] = [SolvePhase {
    settings: Settings {
        max_iterations: 400,
        ..Settings::COLD
    },
    length_penalty: 0.0,
}];
/// From a solution to one with accurate multipliers, for [`super::evidence`].
const POLISHING: SolvePhase = SolvePhase {
    settings: Settings {
        tolerance: 1e-8,
        initial_barrier: 1e-5,
        initial_slack: 1e-5,
        max_iterations: 200,
        ..Settings::COLD
    },
    length_penalty: 1e-3,
};
/// Rounds of polishing. Each centres the penalty on the lengths of the round before (the proximal
/// point method), so that its contribution to the multipliers vanishes.
const POLISH_ROUNDS: usize = 4;
/// The penalty on lengths where the bill is minimised. Within an interval positive and negative power
/// cancel in the program, so that without it intervals with a change of sign would grow.
const BILLED_PENALTY: f64 = 0.1;
/// Greatest number of rounds of correcting the turns and raising the reserves at limits.
const MAX_ROUNDS: usize = 15;
/// Scaled cost of a guess: sets the unit of the program's cost.
const COST_OF_GUESS: f64 = 5.0;

/// A program to be built and solved.
#[derive(Clone)]
pub(super) struct ProgramTask<'a> {
    pub(super) vehicle: &'a Vehicle,
    pub(super) ends: [Waypoint; 2],
    pub(super) shape: ProgramShape,
    pub(super) cost_weights: CostWeights,
}

/// A solved program, whatever its status.
#[derive(Debug, Clone)]
pub(super) struct ProgramSolution {
    pub(super) status: NlpStatus,
    pub(super) motion: SlewMotion,
    /// `a T + b integral u'u + c E` as the program evaluates it.
    pub(super) cost: f64,
    pub(super) iterations: usize,
    /// The program with its corrections, and the iterate with its multipliers.
    pub(super) program: Program,
    pub(super) iterate: Iterate,
}

impl ProgramSolution {
    /// Whether the solve ended in a local minimum.
    pub(super) fn converged(&self) -> bool {
        self.status == NlpStatus::Converged
    }

    /// The same solution with more accurate multipliers, as far as further solves converge.
    pub(super) fn polished(
        &self,
        vehicle: &Vehicle,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> Self {
        let mut best = self.clone();
        for _ in 0..POLISH_ROUNDS {
            let mut run = SolveLoop {
                engine: InteriorPoint::new(&best.program, POLISHING.settings),
                solved: best.clone(),
                vehicle,
            };
            run.draw_lengths(POLISHING.length_penalty);
            run.forget_multipliers();
            if !run.converges(stop) {
                break;
            }
            run.correct();
            best = run.solved;
        }
        best
    }

    /// Whether this converged at a lower cost than another, or the other did not converge.
    pub(super) fn improves(&self, other: &Self) -> bool {
        self.converged() && (!other.converged() || self.cost < other.cost)
    }
}

impl ProgramTask<'_> {
    /// Solves from a guess with as many intervals as the program is to have.
    pub(super) fn solve(
        &self,
        guess: &SlewMotion,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> ProgramSolution {
        if guess.duration() == 0.0 && self.cost_weights.duration.is_none() {
            return self.standing_still(guess);
        }
        let own = self.shape.lengths == IntervalLengths::Free;
        if !own {
            return self.solve_in(&WITHOUT_LENGTHS, guess, stop);
        }
        if self.vehicle.dynamics.has_momentum() {
            let nearby = self.solve_in(&NEARBY, guess, stop);
            if nearby.converged() || stop().is_some() {
                return nearby;
            }
        }
        self.solve_in(&WITH_LENGTHS, guess, stop)
    }

    /// The solution between two ends that one state meets: no time passes, at no cost.
    fn standing_still(&self, motion: &SlewMotion) -> ProgramSolution {
        ProgramSolution {
            status: NlpStatus::Converged,
            cost: 0.0,
            ..self.unsolved(motion)
        }
    }

    fn unsolved(&self, guess: &SlewMotion) -> ProgramSolution {
        let program = self.program(guess);
        ProgramSolution {
            status: NlpStatus::IterationLimit,
            motion: guess.clone(),
            cost: f64::INFINITY,
            iterations: 0,
            iterate: program.iterate_at(guess),
            program,
        }
    }

    fn solve_in(
        &self,
        phases: &[SolvePhase],
        guess: &SlewMotion,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> ProgramSolution {
        let solved = self.unsolved(guess);
        let mut run = SolveLoop {
            engine: InteriorPoint::new(&solved.program, Settings::COLD),
            solved,
            vehicle: self.vehicle,
        };
        run.pass(phases, stop);
        run.solved
    }

    fn program(&self, guess: &SlewMotion) -> Program {
        let dynamics = &self.vehicle.dynamics;
        let angle = self.ends[0]
            .attitude
            .signed_turn_to(&self.ends[1].attitude)
            .norm();
        let scales = Scales::for_legs(dynamics, angle, guess.duration());
        let units = ProgramUnits {
            cost: scales.time,
            energy: 1.0,
        };
        let setup = ProgramSetup {
            waypoints: &self.ends,
            intervals: guess.lengths.len(),
            shape: self.shape.clone(),
            cost_weights: self.cost_weights,
            scales,
            units,
        };
        let mut program = Program::new(self.vehicle, setup);
        if self.shape.lengths == IntervalLengths::Free && !dynamics.cones.is_empty() {
            // Nodes alone would let one long interval lead through a cone.
            let longest = longest_intervals(dynamics, &guess.as_profile(), GUESS_STRETCH);
            program.base.limit_lengths(&longest);
        }
        let energy = program.energy_of(&program.iterate_at(guess));
        let wheels = dynamics.wheel_count() as f64;
        if energy > 0.0 {
            program.units.energy = energy / wheels;
        }
        let effort: f64 = guess
            .begin
            .iter()
            .zip(&guess.lengths)
            .map(|(u, length)| u.norm_squared() * length)
            .sum();
        let cost_weights = &self.cost_weights;
        let cost = cost_weights.time * guess.duration()
            + cost_weights.effort * effort
            + cost_weights.energy * energy;
        if cost > 0.0 {
            program.units.cost = cost / COST_OF_GUESS;
        }
        program
    }
}

/// The loop of solves, corrections and reserves.
struct SolveLoop<'a> {
    vehicle: &'a Vehicle,
    engine: InteriorPoint,
    solved: ProgramSolution,
}

impl SolveLoop<'_> {
    fn pass(&mut self, phases: &[SolvePhase], stop: &dyn Fn() -> Option<StopReason>) {
        for phase in phases {
            let penalty = if self.solved.program.cost_weights.uses_bill() {
                BILLED_PENALTY
            } else {
                phase.length_penalty
            };
            self.draw_lengths(penalty);
            self.engine.settings = phase.settings;
            if !self.converges(stop) {
                return;
            }
        }
        let intervals = self.solved.motion.lengths.len();
        let mut reserves = Reserves::none(&self.vehicle.dynamics, intervals);
        for round in 0..MAX_ROUNDS {
            let missed = self.correct();
            let excesses = self.vehicle.excesses(&self.solved.motion);
            let excess = excesses.greatest();
            let enters = excesses.depth() > CONE_TOLERANCE;
            if missed <= MISS_TOLERANCE && excess <= LIMIT_TOLERANCE && !enters {
                return;
            }
            if missed > LARGE_MISS {
                self.solved.program.base.use_finer_map();
                self.correct();
            }
            if excess > LIMIT_TOLERANCE || enters {
                self.keep_reserves(round, &mut reserves, &excesses);
            }
            if !self.converges(stop) {
                return;
            }
        }
        self.solved.status = NlpStatus::IterationLimit;
    }

    fn draw_lengths(&mut self, weight: f64) {
        let program = &self.solved.program;
        let layout = Layout::of(program);
        let lengths = (0..program.intervals())
            .map(|node| program.length(&self.solved.iterate.link(&layout, node)))
            .collect();
        self.solved.program.penalty = LengthPenalty { weight, lengths };
    }

    /// Corrects the turns at the iterate; returns the sum of their errors, rad.
    fn correct(&mut self) -> f64 {
        let ProgramSolution {
            program,
            iterate,
            motion,
            ..
        } = &mut self.solved;
        let mut missed = 0.0;
        let layout = Layout::of(program);
        for (node, exact) in self.vehicle.turns(motion).iter().enumerate() {
            missed += program.correct_turn(&iterate.link(&layout, node), exact);
        }
        missed
    }

    fn keep_reserves(&mut self, round: usize, reserves: &mut Reserves, excesses: &Excesses) {
        let Excesses {
            shares,
            torques,
            depths,
        } = excesses;
        let program = &mut self.solved.program;
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max) * RESERVE_FACTOR;
        if round < LOCAL_ROUNDS {
            reserves.raise(shares, RESERVE_FACTOR);
            let before = program.torque_reserve.clone();
            for (k, excess) in torques.iter().enumerate() {
                for end in [k, k + 1] {
                    let raised = before[end] + RESERVE_FACTOR * excess;
                    program.torque_reserve[end] = program.torque_reserve[end].max(raised);
                }
            }
        } else {
            reserves.raise_all(most(shares));
            program
                .torque_reserve
                .iter_mut()
                .for_each(|r| *r += most(torques));
        }
        reserves.raise_cones(depths, RESERVE_FACTOR);
        program.base.keep(reserves);
        if excesses.greatest().max(excesses.depth()) <= NEAR_EXCESS {
            self.solved.iterate.recentre(NEAR_BARRIER);
            self.engine.settings.initial_barrier = NEAR_BARRIER;
        } else {
            // The iterate's slacks are those of the limits without the new reserves.
            self.forget_multipliers();
            self.engine.settings.initial_barrier = Settings::COLD.initial_barrier;
        }
    }

    /// Drops slacks and multipliers and keeps the primal point.
    fn forget_multipliers(&mut self) {
        let iterate = &mut self.solved.iterate;
        *iterate = Iterate::cold(
            std::mem::take(&mut iterate.points),
            std::mem::take(&mut iterate.controls),
        );
    }

    /// Solves from the current iterate; returns whether the solve converged.
    fn converges(&mut self, stop: &dyn Fn() -> Option<StopReason>) -> bool {
        let solved = &mut self.solved;
        let report: NlpReport = self
            .engine
            .solve(&solved.program, &mut solved.iterate, stop);
        solved.status = report.status;
        solved.iterations += report.iterations;
        solved.motion = solved.program.motion_of(&solved.iterate);
        solved.cost = cost(&solved.program, &solved.iterate);
        solved.converged()
    }
}

/// The cost of an iterate without penalties, in the unit of [`CostWeights`].
fn cost(program: &Program, iterate: &Iterate) -> f64 {
    let (layout, mut values) = (Layout::of(program), values_of(program));
    let mut sum = 0.0;
    for (node, values) in values.iter_mut().enumerate() {
        let link = iterate.link(&layout, node);
        program.values(&link, values);
        sum += values.cost - program.penalty_of(&link);
    }
    sum * program.units.cost
}
