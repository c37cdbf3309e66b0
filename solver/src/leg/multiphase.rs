//! The multi-phase problem: the minimum-time motion through waypoints in a fixed order.
//!
//! Two waypoints make a leg, many a tour. Rate components and wheel momenta that a waypoint leaves
//! free are continuous across it, which couples neighbouring legs.

mod between_nodes;
mod clocked;
mod extended;
mod passes;
mod rolling;
mod solution;
mod staged;
#[cfg(test)]
mod tests;

use crate::leg::detour::guess::{GUESS_STRETCH, longest_intervals};
use crate::leg::profile::Profile;
use crate::leg::transcription::{MIN_TURN, Reserves, Scales, Transcription};
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use crate::nlp::{Chain, InteriorPoint, Iterate, NlpStatus, Settings};
use crate::run::stop::StopReason;
pub(crate) use between_nodes::{
    attitudes_inside, deepest, depths_inside, excess_inside, keeps_limits_inside,
};
use between_nodes::{depths_between_nodes, excess_between_nodes};
pub(crate) use clocked::solve_clocked;
pub(crate) use extended::solve_extended;
use nalgebra::DVector;
use passes::{ACCURATELY, POLISHING, Pass, from_a_guess};
pub(crate) use rolling::{MAX_LEGS_AT_ONCE, solve_rolling};
pub(crate) use solution::LegSolution;
pub(crate) use staged::StagedSolve;

/// Limit of the rounds of the proximal point method, and the relative gain that ends it.
const POLISH_ROUNDS: usize = 6;
const POLISHED: f64 = 1e-8;

/// Limit of the rounds of correcting the turns and raising the reserves at limits.
const MAX_ROUNDS: usize = 12;
/// Rounds that raise reserves only where a limit was exceeded, and the relative excess above which
/// they do. Smaller excesses become reserves everywhere, which costs half of them in duration.
pub(crate) const LOCAL_ROUNDS: usize = 6;
const LOCAL_EXCESS: f64 = 1e-3;
/// How much longer than in a rough motion an interval may become near a cone.
const ROUGH_STRETCH: f64 = 1.1;
/// Rounds that fit the angles kept from cones to the bend of the motion, before others raise them.
const FITTED_ROUNDS: usize = 3;
/// Angle kept per bend towards a cone: above one, since the motion changes.
const BEND_FACTOR: f64 = 1.02;
/// Reserve per excess: above one, since the motion changes when limits are tightened.
pub(crate) const RESERVE_FACTOR: f64 = 1.1;
/// Relative excess up to which the multipliers are near those of the tightened program, and the
/// barrier parameter of a warm start from them.
pub(crate) const NEAR_EXCESS: f64 = 1e-2;
pub(crate) const NEAR_BARRIER: f64 = 1e-5;
/// Angle, rad, by which the exact turns of a solution may miss its end; the checker's tolerance is
/// hundreds of times this.
pub(crate) const MISS_TOLERANCE: f64 = 3e-9;
/// A miss, rad, above which the turn map's derivatives are too inaccurate as well.
pub(crate) const LARGE_MISS: f64 = 1e-3;
/// Relative excess over a limit between nodes that is accepted; the checker's tolerance is ten
/// times this.
pub(crate) const LIMIT_TOLERANCE: f64 = 1e-7;

/// Angle, rad, by which a motion may enter a cone between nodes; the checker's tolerance is three
/// times this.
pub(crate) const CONE_TOLERANCE: f64 = 3e-7;

/// Solves for the motion through waypoints, from a guess whose nodes are split into legs by
/// `intervals`.
pub(crate) fn solve_through(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    guess: &Profile,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegSolution {
    MultiphaseSolve::new(dynamics, waypoints, intervals, guess).run(from_a_guess(dynamics), stop)
}

/// Frees a solution of the penalty on uneven interval lengths and solves it more exactly.
///
/// The penalty is turned on the lengths of the last solution again and again (the proximal point
/// method): where they no longer change, it has no share in the optimality conditions.
pub(crate) fn polish(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    mut solution: LegSolution,
    stop: &dyn Fn() -> Option<StopReason>,
) -> LegSolution {
    for _ in 0..POLISH_ROUNDS {
        let Some(before) = solution.least_duration() else {
            break;
        };
        let guess = &solution.profile;
        let next =
            MultiphaseSolve::new(dynamics, waypoints, intervals, guess).run(&POLISHING, stop);
        let Some(after) = next.duration() else {
            break;
        };
        if after > before {
            break;
        }
        solution = next;
        if before - after <= POLISHED * before {
            break;
        }
    }
    solution
}

/// A motion through waypoints on the way to its solution.
struct MultiphaseSolve<'a> {
    dynamics: &'a Dynamics,
    scales: Scales,
    chain: Transcription,
    engine: InteriorPoint,
    iterate: Iterate,
    /// Interval that ends at each waypoint between two legs.
    arrivals: Vec<usize>,
    /// When the motion begins, s, where the elapsed time is a state.
    begin: Option<f64>,
    solution: LegSolution,
}

impl<'a> MultiphaseSolve<'a> {
    fn new(
        dynamics: &'a Dynamics,
        waypoints: &[Waypoint],
        intervals: &[usize],
        guess: &Profile,
    ) -> Self {
        let leg = guess.duration() / intervals.len() as f64;
        let leg = leg.max(dynamics.least_duration());
        let scales = Scales::for_legs(dynamics, typical_angle(dynamics, waypoints), leg);
        let mut chain = Transcription::new(dynamics, scales, waypoints, intervals);
        if !dynamics.cones.is_empty() {
            chain.limit_lengths(&longest_intervals(dynamics, guess, GUESS_STRETCH));
        }
        Self {
            dynamics,
            scales,
            engine: InteriorPoint::new(&chain, Settings::COLD),
            chain,
            iterate: scaled(guess, &scales),
            arrivals: arrivals(intervals),
            begin: None,
            solution: LegSolution {
                status: NlpStatus::IterationLimit,
                profile: guess.clone(),
                intervals: intervals.to_vec(),
                iterations: 0,
                infeasibility: f64::MAX,
                costates: Vec::new(),
            },
        }
    }

    /// Runs the passes, and then corrects turns and reserves.
    fn run(mut self, passes: &[Pass], stop: &dyn Fn() -> Option<StopReason>) -> LegSolution {
        self.run_passes(passes, stop);
        self.exact(stop)
    }

    /// The exact solution of a converged motion.
    fn exact(mut self, stop: &dyn Fn() -> Option<StopReason>) -> LegSolution {
        self.make_exact(stop);
        self.solution
    }

    /// Corrects the turns and the reserves of a converged motion until the exact motion arrives and
    /// keeps its limits between nodes too.
    fn make_exact(&mut self, stop: &dyn Fn() -> Option<StopReason>) {
        if self.solution.status != NlpStatus::Converged {
            return;
        }
        let mut reserves = self.chain.reserves().clone();
        for round in 0..MAX_ROUNDS {
            let missed = self.chain.correct(&self.iterate);
            let excesses = excess_between_nodes(self.dynamics, &self.solution.profile);
            let excess = excesses.iter().copied().fold(0.0, f64::max);
            let depths = depths_between_nodes(self.dynamics, &self.solution.profile);
            let depth = deepest(&depths);
            // Passes that end early leave one solve, with corrected turns.
            let holds =
                missed <= MISS_TOLERANCE && excess <= LIMIT_TOLERANCE && depth <= CONE_TOLERANCE;
            if self.engine.settings.feasibility > ACCURATELY.feasibility {
                self.engine.settings = ACCURATELY;
            } else if holds {
                return;
            }
            if missed > LARGE_MISS {
                self.chain.refine(&self.iterate);
            }
            if excess > LIMIT_TOLERANCE {
                if round == 0 || (excess > LOCAL_EXCESS && round < LOCAL_ROUNDS) {
                    reserves.raise(&excesses, RESERVE_FACTOR);
                } else {
                    reserves.raise_all(RESERVE_FACTOR * excess);
                }
            }
            if depth > CONE_TOLERANCE {
                if round < FITTED_ROUNDS {
                    reserves.fit_cones(&depths, BEND_FACTOR);
                } else {
                    reserves.raise_cones(&depths, RESERVE_FACTOR);
                }
            }
            if excess > LIMIT_TOLERANCE || depth > CONE_TOLERANCE {
                self.tighten(&reserves, excess.max(depth));
            }
            if !self.converges(stop) {
                return;
            }
        }
        // Converged at the nodes, but the exact motion still misses its end or exceeds a limit.
        self.solution.status = NlpStatus::IterationLimit;
    }

    /// Sets reserves raised for an excess, and the start of the next solve.
    fn tighten(&mut self, reserves: &Reserves, excess: f64) {
        self.chain.keep(reserves);
        let settings = &mut self.engine.settings;
        if excess <= NEAR_EXCESS {
            settings.initial_barrier = NEAR_BARRIER;
            self.iterate.recentre(NEAR_BARRIER);
        } else {
            // Slacks and multipliers belong to the old limits: a cold start from the primal point.
            settings.initial_barrier = Settings::COLD.initial_barrier;
            self.iterate = scaled(&self.solution.profile, &self.scales);
            self.set_clock();
        }
    }

    /// Runs one pass after the other; whether all converge.
    ///
    /// With a small barrier parameter the engine creeps along the limits if the motion before the pass is far from a
    /// solution. A pass whose iterations are used up is run once more, with a large one, from the motion that it
    /// has reached.
    fn run_passes(&mut self, passes: &[Pass], stop: &dyn Fn() -> Option<StopReason>) -> bool {
        passes.iter().all(|pass| {
            let cold = Settings::COLD.initial_barrier;
            if self.converges_by(pass, pass.settings.initial_barrier, stop) {
                return true;
            }
            let is_used_up = self.solution.status == NlpStatus::IterationLimit;
            if !is_used_up || pass.settings.initial_barrier >= cold {
                return false;
            }
            self.iterate = scaled(&self.solution.profile, &self.scales);
            self.set_clock();
            self.converges_by(pass, cold, stop)
        })
    }

    /// Runs one pass with a barrier parameter for its first iteration; whether it converges.
    fn converges_by(
        &mut self,
        pass: &Pass,
        initial_barrier: f64,
        stop: &dyn Fn() -> Option<StopReason>,
    ) -> bool {
        self.chain.draw_controls_to(&self.iterate, pass.penalty);
        self.engine.settings = Settings {
            initial_barrier,
            ..pass.settings
        };
        self.converges(stop)
    }

    /// Corrects the turns of a rough motion with cones, keeps its intervals near them from growing,
    /// and its nodes from cones as far as it bends there, so that fewer rounds are left.
    ///
    /// Free to grow, intervals beside a cone would do so where no angle is kept yet, in every round
    /// others.
    fn anticipate(&mut self) {
        let rough = &self.solution.profile;
        let depths = depths_between_nodes(self.dynamics, rough);
        if depths.is_empty() {
            return;
        }
        let longest = longest_intervals(self.dynamics, rough, ROUGH_STRETCH);
        self.chain.limit_lengths(&longest);
        self.chain.correct(&self.iterate);
        let mut reserves = self.chain.reserves().clone();
        reserves.fit_cones(&depths, BEND_FACTOR);
        self.chain.keep(&reserves);
    }

    /// Multipliers of the links that end between two legs. They are the multipliers of the
    /// condition that two copies of the state there, one for each leg, are equal.
    fn costates(&self) -> Vec<DVector<f64>> {
        let (states, wheels) = (self.chain.state_dim(), self.dynamics.wheel_count());
        let unit = self.scales.time / self.scales.momentum;
        let of_momenta = |&interval: &usize| {
            let multipliers = &self.iterate.lambda[interval * states..(interval + 1) * states];
            DVector::from_column_slice(&multipliers[3..3 + wheels]) * unit
        };
        self.arrivals.iter().map(of_momenta).collect()
    }

    /// Runs the engine from the current iterate; whether it converges.
    fn converges(&mut self, stop: &dyn Fn() -> Option<StopReason>) -> bool {
        let report = self.engine.solve(&self.chain, &mut self.iterate, stop);
        self.solution = LegSolution {
            status: report.status,
            profile: physical(&self.iterate, &self.scales, &self.chain),
            intervals: std::mem::take(&mut self.solution.intervals),
            iterations: self.solution.iterations + report.iterations,
            infeasibility: report.infeasibility,
            costates: self.costates(),
        };
        self.read_clock();
        report.status == NlpStatus::Converged
    }
}

/// The intervals that end between two legs.
fn arrivals(intervals: &[usize]) -> Vec<usize> {
    let before_last = intervals.split_last().map_or(&[][..], |(_, before)| before);
    let ends = before_last.iter().scan(0, |end, count| {
        *end += count;
        Some(*end - 1)
    });
    ends.collect()
}

/// The median of the legs' turns, rad, where the changes between a leg's ends count as the turn
/// that takes as long; legs without turn or change do not count.
fn typical_angle(dynamics: &Dynamics, waypoints: &[Waypoint]) -> f64 {
    let mut angles: Vec<f64> = waypoints
        .windows(2)
        .map(|pair| {
            let turn = pair[0].attitude.signed_turn_to(&pair[1].attitude).norm();
            let change = pair[0].change_time(&pair[1], dynamics);
            turn.max(dynamics.turn_within(change))
        })
        .filter(|angle| *angle > MIN_TURN)
        .collect();
    angles.sort_by(f64::total_cmp);
    angles.get(angles.len() / 2).copied().unwrap_or(MIN_TURN)
}

fn scaled(profile: &Profile, scales: &Scales) -> Iterate {
    let mut points = Vec::new();
    for (attitude, wheels) in profile.attitudes.iter().zip(&profile.wheels) {
        points.extend_from_slice(&attitude.xyzw());
        points.extend(wheels.iter().map(|h| h / scales.momentum));
    }
    let mut controls = Vec::new();
    for (pair, length) in profile.wheels.windows(2).zip(&profile.lengths) {
        controls.extend(
            pair[1]
                .iter()
                .zip(pair[0].iter())
                .map(|(b, a)| (b - a) / scales.momentum),
        );
        controls.push(length / scales.time);
    }
    Iterate::cold(points, controls)
}

fn physical(iterate: &Iterate, scales: &Scales, chain: &Transcription) -> Profile {
    let mut profile = Profile::empty();
    let wheels = chain.control_dim() - 1;
    for point in iterate.points.chunks_exact(chain.point_len()) {
        let components = [point[0], point[1], point[2], point[3]];
        // Retraction keeps quaternions at unit length.
        profile
            .attitudes
            .push(Attitude::from_xyzw(components).unwrap_or_else(Attitude::identity));
        let momenta = point[4..4 + wheels].iter().map(|h| h * scales.momentum);
        profile.wheels.push(DVector::from_iterator(wheels, momenta));
    }
    for control in iterate.controls.chunks_exact(wheels + 1) {
        profile.lengths.push(control[wheels] * scales.time);
    }
    profile
}
