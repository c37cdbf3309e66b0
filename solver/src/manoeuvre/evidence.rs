//! Evidence of optimality: the conditions of the minimum principle, along a solution.
//!
//! The multipliers of the program's links are the costates at the ends of its intervals: `p` of a
//! turn in body axes, `r` of the wheels' momenta. With the running cost `l` the Hamiltonian and the
//! costates between the nodes are
//!
//! ```text
//!   H  = l(u, W) + p . w + r . u                          constant; zero when the duration is free
//!   p' = -w x p + (R^T H_total) x (Ji p) - (dl/dq)^T      s/rad per s
//!   r' = A^T Ji p - (dl/dh)^T                             per N m s per s
//! ```
//!
//! and the torques minimise `H` at every moment: where `l` has no torque in it, every torque is at
//! the limit whose sign is that of minus the *switching function* `dH/du_i = r_i`. An active limit of
//! speed or rate makes the costates jump at nodes, by its multipliers.
//!
//! Nothing here asks the program anything but its multipliers at the nodes: costates are integrated
//! from there by these equations, and what is left of a jump that no multiplier explains is the
//! [`Evidence::costate_defect`].

use super::flow::Sample;
use super::ingredients::Ingredients;
use super::program::Program;
use super::solving::Solved;
use super::{Manoeuvre, Measure, Outcome, WheelAllocation, interruption};
use crate::nlp::{Chain, Layout};
use crate::stop::StopSignal;
use nalgebra::{DVector, Vector3};

/// Steps of the costates' integration per interval; as many moments are looked at.
const PARTS: usize = 8;

/// The conditions along a solution.
#[derive(Debug, Clone)]
pub struct Evidence {
    /// Every interval that takes time.
    pub intervals: Vec<IntervalEvidence>,
    /// Mean of the Hamiltonian over the time: zero when the duration is free, else what a second
    /// more would add to the objective.
    pub hamiltonian: f64,
    /// What its differences are measured by: the mean size of `p . w + r . u`, one for minimum time.
    pub scale: f64,
    /// Greatest difference of an interval's average from the mean, in the scale.
    pub average_spread: f64,
    /// Greatest difference of the Hamiltonian at any moment from the mean, in the scale.
    pub pointwise_spread: f64,
    /// Mean over the time by how much the torques could lower the Hamiltonian, in the scale.
    pub principle_gap: f64,
    /// Greatest jump of a momentum costate at a node where no limit is active, relative to the
    /// costates' size.
    pub costate_defect: f64,
    /// Greatest product of a limit's slack and its multiplier, in the unit of the objective.
    pub complementarity: f64,
    /// Of the size of the switching functions of torques at their limits, integrated over the time,
    /// the share that belongs to torques of the sign asked for; one where none is at a limit.
    pub switching_agreement: f64,
}

/// The conditions on one interval.
#[derive(Debug, Clone)]
pub struct IntervalEvidence {
    /// Begin, s.
    pub start_s: f64,
    /// Length, s.
    pub duration_s: f64,
    /// Costate of the attitude in body axes at begin and end, unit of the objective per rad.
    pub attitude_costate: [Vector3<f64>; 2],
    /// Costates of the commanded wheels' momenta at begin and end, per N m s.
    pub momentum_costate: [Vec<f64>; 2],
    /// `dH/du` of each commanded wheel at begin and end, per N m s.
    pub switching: [Vec<f64>; 2],
    /// Average of the Hamiltonian, and its least and greatest value.
    pub hamiltonian: [f64; 3],
}

/// The costates at a moment.
#[derive(Debug, Clone)]
struct Costate {
    attitude: Vector3<f64>,
    momenta: DVector<f64>,
}

impl Costate {
    fn moved(&self, by: f64, slope: &Self) -> Self {
        Self {
            attitude: self.attitude + slope.attitude * by,
            momenta: &self.momenta + &slope.momenta * by,
        }
    }
}

/// The evidence for an outcome; `None` when it is not solved, the stop signal comes first, or the
/// pseudo-inverse shares torques out: the equations above are those of torques free of each other.
///
/// The solution is polished before, which takes a few iterations more.
#[must_use]
pub fn of(manoeuvre: &Manoeuvre, outcome: &Outcome, stop: &StopSignal) -> Option<Evidence> {
    if !outcome.solved || manoeuvre.allocation() != WheelAllocation::Free {
        return None;
    }
    let polished = outcome
        .solution
        .polished(manoeuvre.vehicle(), &|| interruption(stop));
    if stop.is_set() || !polished.converged() {
        return None;
    }
    let witness = Witness {
        manoeuvre,
        solved: &polished,
        layout: Layout::of(&polished.program),
    };
    Some(witness.evidence())
}

struct Witness<'a> {
    manoeuvre: &'a Manoeuvre,
    solved: &'a Solved,
    layout: Layout,
}

/// What an interval adds to the whole.
struct Tested {
    evidence: IntervalEvidence,
    /// Integral of the size of `p . w + r . u`.
    motion: f64,
    /// Integral of what the torques could lower the Hamiltonian by.
    gap: f64,
    /// Integrals of the switching functions' size, of torques at limits, and of those of the right
    /// sign.
    limited: [f64; 2],
}

impl Witness<'_> {
    fn program(&self) -> &Program {
        &self.solved.program
    }

    fn evidence(&self) -> Evidence {
        let times = self.solved.motion.times();
        let total = self.solved.motion.duration();
        let tested: Vec<Tested> = (0..self.program().intervals())
            .filter(|k| self.solved.motion.lengths[*k] > SHORTEST * total)
            .map(|k| self.test(k, times[k]))
            .collect();
        let time: f64 = tested.iter().map(|t| t.evidence.duration_s).sum();
        let sum = |of: &dyn Fn(&Tested) -> f64| tested.iter().map(of).sum::<f64>();
        let hamiltonian = sum(&|t| t.evidence.hamiltonian[0] * t.evidence.duration_s) / time;
        let scale = sum(&|t| t.motion) / time;
        let spread = |of: &dyn Fn(&[f64; 3]) -> f64| {
            let values = tested.iter().map(|t| of(&t.evidence.hamiltonian));
            values.fold(0.0, f64::max) / scale
        };
        let (limited, right) = (sum(&|t| t.limited[0]), sum(&|t| t.limited[1]));
        Evidence {
            average_spread: spread(&|[average, ..]| (average - hamiltonian).abs()),
            pointwise_spread: spread(&|[_, least, greatest]| {
                (greatest - hamiltonian).max(hamiltonian - least)
            }),
            principle_gap: sum(&|t| t.gap) / time / scale,
            costate_defect: self.costate_defect(),
            complementarity: self.complementarity(),
            switching_agreement: if limited > 0.0 { right / limited } else { 1.0 },
            intervals: tested.into_iter().map(|t| t.evidence).collect(),
            hamiltonian,
            scale,
        }
    }

    /// The costates at the end of an interval, as the links' multipliers have them.
    fn end_costate(&self, k: usize) -> Costate {
        let program = self.program();
        let lambda = &self.solved.iterate.lambda[self.layout.link(k)];
        let unit = program.units.cost;
        let wheels = program.shape.wheels;
        Costate {
            attitude: Vector3::from_column_slice(&lambda[..3]) * (unit / program.scales.angle),
            momenta: DVector::from_column_slice(&lambda[3..3 + wheels])
                * (unit / program.scales.momentum),
        }
    }

    /// What energy costs on an interval, unit of the objective per J: in the objective itself, or
    /// taken from a budget.
    fn energy_price(&self, k: usize) -> f64 {
        let program = self.program();
        let lambda = &self.solved.iterate.lambda[self.layout.link(k)];
        let spent = if program.shape.account {
            lambda[program.shape.account_at()] * program.units.cost / program.units.energy
        } else {
            0.0
        };
        program.ingredients.energy + spent
    }

    fn test(&self, k: usize, begin: f64) -> Tested {
        let vehicle = self.manoeuvre.vehicle();
        let length = self.solved.motion.lengths[k];
        let price = self.energy_price(k);
        // Twice as many samples as steps: a step of the fourth order asks for its middle too.
        let samples = vehicle.samples(&self.solved.motion, k, begin, 2 * PARTS);
        let costates = self.costates(k, &samples, price);
        let nodes = || costates.iter().zip(samples.iter().step_by(2));
        let values: Vec<f64> = nodes()
            .map(|(p, at)| self.hamiltonian(p, at, price))
            .collect();
        let average = trapezoid(&values);
        let moving: Vec<f64> = nodes()
            .map(|(p, at)| (p.attitude.dot(&at.rate) + p.momenta.dot(&at.torques)).abs())
            .collect();
        let gaps: Vec<f64> = nodes().map(|(p, at)| self.gap(p, at, price)).collect();
        let switching = |i: usize| -> Vec<f64> {
            let at = &samples[2 * i];
            let wheels = 0..at.speeds.len();
            wheels
                .map(|w| self.switching(w, &costates[i], at, price))
                .collect()
        };
        let mut limited = [0.0; 2];
        for (p, at) in nodes() {
            for (agrees, size) in self.limited_torques(p, at, price) {
                limited[0] += size * length;
                limited[1] += if agrees { size * length } else { 0.0 };
            }
        }
        let ends = [&costates[0], &costates[PARTS]];
        Tested {
            evidence: IntervalEvidence {
                start_s: begin,
                duration_s: length,
                attitude_costate: ends.map(|p| p.attitude),
                momentum_costate: ends.map(|p| p.momenta.iter().copied().collect()),
                switching: [switching(0), switching(PARTS)],
                hamiltonian: [
                    average,
                    values.iter().copied().fold(f64::INFINITY, f64::min),
                    values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                ],
            },
            motion: trapezoid(&moving) * length,
            gap: trapezoid(&gaps) * length,
            limited,
        }
    }

    /// Costates at the ends of equal parts of an interval, integrated backwards from its end.
    fn costates(&self, k: usize, samples: &[Sample], price: f64) -> Vec<Costate> {
        let step = -self.solved.motion.lengths[k] / PARTS as f64;
        let mut costates = vec![self.end_costate(k)];
        for part in (0..PARTS).rev() {
            let from = costates[costates.len() - 1].clone();
            let [first, middle, last] = [2, 1, 0].map(|i| &samples[2 * part + i]);
            let a = self.slope(&from, first, price);
            let b = self.slope(&from.moved(0.5 * step, &a), middle, price);
            let c = self.slope(&from.moved(0.5 * step, &b), middle, price);
            let d = self.slope(&from.moved(step, &c), last, price);
            let next = from
                .moved(step / 6.0, &a)
                .moved(step / 3.0, &b)
                .moved(step / 3.0, &c)
                .moved(step / 6.0, &d);
            costates.push(next);
        }
        costates.reverse();
        costates
    }

    /// The costates' equations.
    fn slope(&self, p: &Costate, at: &Sample, price: f64) -> Costate {
        let dynamics = &self.manoeuvre.vehicle().dynamics;
        // The running cost depends on attitude and momenta through the wheels' speeds.
        let by_speed = self.cost_by_speed(at, price);
        let mut lever = p.attitude;
        for (wheel, slope) in dynamics.actuators.iter().zip(&by_speed) {
            lever -= wheel.axis * *slope;
        }
        let pulled = dynamics.inertia_inverse.tr_mul(&lever);
        let momenta = dynamics.actuators.iter().zip(&by_speed);
        Costate {
            attitude: at.stored.cross(&pulled) - at.rate.cross(&p.attitude),
            momenta: DVector::from_iterator(
                by_speed.len(),
                momenta.map(|(wheel, slope)| wheel.axis.dot(&pulled) - slope / wheel.inertia),
            ),
        }
    }

    /// Whether a wheel's energy counts in the running cost at a moment.
    fn counts(&self, power: f64) -> bool {
        self.ingredients().measure == Measure::Proxy || power > 0.0
    }

    fn ingredients(&self) -> &Ingredients {
        &self.program().ingredients
    }

    /// `dl / dW` of every wheel.
    fn cost_by_speed(&self, at: &Sample, price: f64) -> Vec<f64> {
        let drives = &self.manoeuvre.vehicle().drives;
        let wheels = drives.iter().zip(&at.speeds).zip(at.torques.iter());
        wheels
            .map(|((drive, speed), torque)| {
                let Some(motor) = drive.motor.filter(|_| price != 0.0) else {
                    return 0.0;
                };
                let given = drive.motor_torque(*torque, *speed);
                let viscous = if drive.friction_compensated {
                    drive.viscous_friction
                } else {
                    0.0
                };
                let heat = 2.0 * motor.resistance / motor.torque_constant.powi(2) * given;
                if self.counts(motor.power(given, *speed)) {
                    let share = self.ingredients().share(motor.efficiency);
                    price * share * (heat * viscous + given + viscous * speed)
                } else {
                    0.0
                }
            })
            .collect()
    }

    /// The running cost of one wheel as a function of its torque, N m.
    fn wheel_cost(&self, wheel: usize, torque: f64, at: &Sample, price: f64) -> f64 {
        let drive = &self.manoeuvre.vehicle().drives[wheel];
        let effort = self.ingredients().effort * torque * torque;
        let Some(motor) = drive.motor.filter(|_| price != 0.0) else {
            return effort;
        };
        let speed = at.speeds[wheel];
        let power = motor.power(drive.motor_torque(torque, speed), speed);
        let share = self.ingredients().share(motor.efficiency);
        effort
            + if self.counts(power) {
                price * share * power
            } else {
                0.0
            }
    }

    fn hamiltonian(&self, p: &Costate, at: &Sample, price: f64) -> f64 {
        let wheels = 0..at.speeds.len();
        let cost: f64 = wheels
            .map(|w| self.wheel_cost(w, at.torques[w], at, price))
            .sum();
        self.ingredients().time + cost + p.attitude.dot(&at.rate) + p.momenta.dot(&at.torques)
    }

    /// `dH / du` of a wheel.
    fn switching(&self, wheel: usize, p: &Costate, at: &Sample, price: f64) -> f64 {
        let drive = &self.manoeuvre.vehicle().drives[wheel];
        let (torque, speed) = (at.torques[wheel], at.speeds[wheel]);
        let effort = 2.0 * self.ingredients().effort * torque;
        let motor = drive.motor.filter(|_| price != 0.0).map_or(0.0, |motor| {
            let given = drive.motor_torque(torque, speed);
            let heat = 2.0 * motor.resistance / motor.torque_constant.powi(2) * given;
            let share = self.ingredients().share(motor.efficiency);
            if self.counts(motor.power(given, speed)) {
                price * share * (heat + speed)
            } else {
                0.0
            }
        });
        p.momenta[wheel] + effort + motor
    }

    /// The range of commanded torques that the motor's limits leave, N m.
    fn range(&self, wheel: usize, at: &Sample) -> [f64; 2] {
        let vehicle = self.manoeuvre.vehicle();
        let actuator = &vehicle.dynamics.actuators[wheel];
        let friction = vehicle.drives[wheel].motor_torque(0.0, at.speeds[wheel]);
        [
            actuator.min_torque - friction,
            actuator.max_torque - friction,
        ]
    }

    /// By how much other torques could lower the Hamiltonian, wheels at a speed limit left out.
    fn gap(&self, p: &Costate, at: &Sample, price: f64) -> f64 {
        let wheels = (0..at.speeds.len()).filter(|w| !self.held(*w, at));
        wheels
            .map(|wheel| {
                let [least, most] = self.range(wheel, at);
                let value = |u: f64| self.wheel_cost(wheel, u, at, price) + p.momenta[wheel] * u;
                let trials =
                    (0..=TRIALS).map(|i| least + (most - least) * i as f64 / TRIALS as f64);
                let best = trials.map(value).fold(f64::INFINITY, f64::min);
                (value(at.torques[wheel]) - best).max(0.0)
            })
            .sum()
    }

    /// Whether a limit of speed or rate keeps a wheel from following its switching function.
    fn held(&self, wheel: usize, at: &Sample) -> bool {
        let dynamics = &self.manoeuvre.vehicle().dynamics;
        let mut shares = dynamics.limit_shares(&at.rate, &at.momenta);
        let own = shares.nth(wheel).is_some_and(|share| share.abs() > NEAR);
        // The rates' limits hold all wheels together.
        let rates = shares.skip(dynamics.wheel_count() - wheel - 1);
        own || rates.into_iter().any(|share| share.abs() > NEAR)
    }

    /// Of every wheel whose torque is at a limit whether its sign is right, and the size of its
    /// switching function.
    fn limited_torques(&self, p: &Costate, at: &Sample, price: f64) -> Vec<(bool, f64)> {
        (0..at.speeds.len())
            .filter(|wheel| !self.held(*wheel, at))
            .filter_map(|wheel| {
                let ([least, most], torque) = (self.range(wheel, at), at.torques[wheel]);
                let slack = (1.0 - NEAR) * (most - least);
                let wanted = self.switching(wheel, p, at, price);
                let agrees = if torque >= most - slack {
                    wanted <= 0.0
                } else if torque <= least + slack {
                    wanted >= 0.0
                } else {
                    return None;
                };
                Some((agrees, wanted.abs()))
            })
            .collect()
    }

    /// Greatest jump of the momentum costates between two intervals that no limit explains.
    fn costate_defect(&self) -> f64 {
        let vehicle = self.manoeuvre.vehicle();
        let motion = &self.solved.motion;
        let times = motion.times();
        let (mut worst, mut size) = (0.0_f64, 0.0_f64);
        for k in 1..self.program().intervals() {
            let samples = vehicle.samples(motion, k, times[k], 2 * PARTS);
            let after = self.costates(k, &samples, self.energy_price(k));
            let before = self.end_costate(k - 1);
            size = size.max(before.momenta.amax());
            let free = (0..samples[0].speeds.len()).all(|w| !self.held(w, &samples[0]));
            if free {
                worst = worst.max((&after[0].momenta - &before.momenta).amax());
            }
        }
        if size > 0.0 { worst / size } else { 0.0 }
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

/// Intervals shorter than this share of the whole have shrunk to nothing.
const SHORTEST: f64 = 1e-4;
/// Torques tried for a lower Hamiltonian.
const TRIALS: usize = 64;
/// Share of a limit from which on it counts as active.
const NEAR: f64 = 0.999;

/// Mean of values at equal distances.
fn trapezoid(values: &[f64]) -> f64 {
    let sums = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    sums.sum::<f64>() / (values.len() - 1) as f64
}
