//! The nonlinear program of a slew: a [`Transcription`] extended by linear torques, shared or given
//! interval lengths, and costs of effort and energy.
//!
//! The transcription gives the conditions on states at nodes and the attitude link of an interval, a
//! function of `(q, h, m, tau)`. Here these become functions of the program's own variables
//! ([`ProgramShape`]), with derivatives by the chain rule. Under a linear torque the momenta are
//! quadratic in time. The link then gets momenta shifted by their mean distance from the straight
//! line, which makes the integral of the rate exact; the corrections of the turns take the rest.

mod allocation;
mod chain;
mod listing;
mod variables;

use super::cost_weights::CostWeights;
use super::jet::Jet;
use super::shape::{IntervalLengths, ProgramShape, TorqueCourse};
use super::terms::{
    DrivenWheel, LENGTH, SPEED, SPEED_CHANGE, SPEED_CHANGE_END, TORQUE_BEGIN, TORQUE_END,
    WheelState,
};
use super::vehicle::{SpeedLawWheels, Vehicle};
use crate::leg::transcription::{Drift, Row, Scales, Transcription};
use crate::math::quaternion::Quat;
use crate::model::waypoint::Waypoint;
use crate::nlp::Link;
use allocation::PinnedNullSpace;
use nalgebra::DMatrix;

/// The penalty `weight / 2 (length - given)^2` on the scaled length of every interval.
#[derive(Debug, Clone)]
pub(super) struct LengthPenalty {
    pub(super) weight: f64,
    pub(super) lengths: Vec<f64>,
}

/// Units of the quantities that are neither state nor control.
#[derive(Debug, Clone, Copy)]
pub(super) struct ProgramUnits {
    /// Unit of the cost, in the unit of [`CostWeights`].
    pub(super) cost: f64,
    /// Unit of energies, J.
    pub(super) energy: f64,
}

/// The data of a program besides the vehicle.
pub(super) struct ProgramSetup<'a> {
    /// Conditions at the beginning and the end of the slew.
    pub(super) waypoints: &'a [Waypoint; 2],
    pub(super) intervals: usize,
    pub(super) shape: ProgramShape,
    pub(super) cost_weights: CostWeights,
    pub(super) scales: Scales,
    pub(super) units: ProgramUnits,
}

/// The program of one slew, to be solved as a [`Chain`](crate::nlp::Chain).
#[derive(Debug, Clone)]
pub(super) struct Program {
    pub(super) base: Transcription,
    pub(super) shape: ProgramShape,
    pub(super) scales: Scales,
    pub(super) units: ProgramUnits,
    pub(super) cost_weights: CostWeights,
    wheels: Vec<DrivenWheel>,
    /// Speed of each wheel in a state, rad/s.
    speeds: Vec<Row>,
    /// Speed of wheel `i` per momentum of wheel `j` and unit of time, 1/(kg m²).
    speed_per_momentum: DMatrix<f64>,
    /// Efficiency of each motor's supply: power at the motor over power drawn.
    efficiency: Vec<f64>,
    /// Quiescent power of all motors' electronics together, W.
    quiescent_power: f64,
    pub(super) penalty: LengthPenalty,
    /// Wheels under a speed law, whose momentum is a function of the clock.
    speed_law_wheels: SpeedLawWheels,
    /// Momenta of the enabled wheels, scaled, with the same effect on the body as a momentum of 1 N m s.
    equivalent: DMatrix<f64>,
    /// Reserve kept from the torque limits at every node, relative to the limit.
    pub(super) torque_reserve: Vec<f64>,
    /// The null-space momentum, where the pseudo-inverse allocates torques.
    pinned_null_space: Option<PinnedNullSpace>,
}

/// The function of the program that a term is added to.
#[derive(Debug, Clone, Copy)]
enum TermTarget {
    Cost,
    Gap(usize),
    Inequality(usize),
}

/// A term of one wheel with its derivatives by the wheel's features.
struct WheelTerm<'a> {
    place: TermTarget,
    jet: Jet,
    wheel: usize,
    link: &'a Link<'a>,
}

/// Gradient and Hessian of a function of a few variables, as `(index, value)` and `(row, column,
/// value)` of the lower triangle.
#[derive(Default)]
struct SparseDerivatives {
    gradient: Vec<(usize, f64)>,
    hessian: Vec<(usize, usize, f64)>,
}

impl Program {
    /// The program of a slew of a vehicle.
    pub(super) fn new(vehicle: &Vehicle, setup: ProgramSetup<'_>) -> Self {
        let ProgramSetup {
            waypoints,
            intervals,
            shape,
            cost_weights,
            scales,
            units,
        } = setup;
        let (dynamics, drives) = (&vehicle.dynamics, &vehicle.drives);
        let base = Transcription::new(dynamics, scales, waypoints, &[intervals]);
        let actuators = &dynamics.actuators;
        let speeds = actuators.iter().enumerate().map(|(i, wheel)| {
            let per_momentum = scales.momentum / wheel.inertia;
            base.row(0.0, -wheel.axis, &[(i, per_momentum)])
        });
        let speed_per_momentum = DMatrix::from_fn(actuators.len(), actuators.len(), |i, j| {
            let own = if i == j {
                actuators[i].inertia.recip()
            } else {
                0.0
            };
            own + actuators[i]
                .axis
                .dot(&(dynamics.inertia_inverse * actuators[j].axis))
        });
        let wheels = actuators.iter().zip(drives);
        Self {
            speeds: speeds.collect(),
            speed_per_momentum,
            wheels: wheels.map(|(w, d)| DrivenWheel::new(w, d)).collect(),
            efficiency: drives
                .iter()
                .map(|drive| drive.motor.map_or(1.0, |motor| motor.efficiency))
                .collect(),
            quiescent_power: drives
                .iter()
                .filter_map(|drive| drive.motor)
                .map(|motor| motor.quiescent_power)
                .sum(),
            penalty: LengthPenalty {
                weight: 0.0,
                lengths: vec![1.0; intervals],
            },
            speed_law_wheels: vehicle.speed_law_wheels.clone(),
            equivalent: &dynamics.axes_inverse / scales.momentum,
            torque_reserve: vec![0.0; intervals + 1],
            pinned_null_space: vehicle.pinned_null.as_ref().map(|momenta| PinnedNullSpace {
                null_space: dynamics.null_space.clone(),
                momenta: momenta / scales.momentum,
            }),
            base,
            shape,
            scales,
            units,
            cost_weights,
        }
    }

    /// Momentum that the wheels under a speed law have taken up at a point.
    fn drift(&self, point: &[f64]) -> Drift {
        self.drift_after(point, 0.0)
    }

    /// The same after a further time `length`, scaled, on the clock of the point.
    fn drift_after(&self, point: &[f64], length: f64) -> Drift {
        let clock = self.shape.clock_at();
        if !self.speed_law_wheels.any_drift() {
            return Drift::default();
        }
        let unit = self.scales.time;
        let [taken, slope, bend] = self
            .speed_law_wheels
            .drift((point[1 + clock] + length) * unit);
        Drift {
            taken: [taken, slope * unit, bend * (unit * unit)],
            clock: Some(clock),
        }
    }

    /// Corrects the attitude link so that it gives the exact turn of one interval; returns the angle,
    /// rad, by which the correction changes.
    pub(super) fn correct_turn(&mut self, link: &Link<'_>, exact: &Quat) -> f64 {
        let base = self.base_link(link);
        let wheels = self.shape.wheels;
        let link = base.link(link, wheels);
        self.base.correct_turn(&link, exact)
    }

    /// The penalty on the length of an interval, scaled.
    pub(super) fn penalty_of(&self, link: &Link<'_>) -> f64 {
        if link.has_interval() && self.draws_lengths() {
            0.5 * self.penalty.weight * self.stray(link).powi(2)
        } else {
            0.0
        }
    }

    /// Whether any term divides by the length of an interval.
    fn divides_by_length(&self) -> bool {
        self.shape.course == TorqueCourse::Steps
            && (self.cost_weights.effort > 0.0 || self.cost_weights.uses_energy())
    }

    fn torque_unit(&self) -> f64 {
        self.scales.momentum / self.scales.time
    }

    /// Length of an interval, scaled.
    pub(super) fn length(&self, link: &Link<'_>) -> f64 {
        match &self.shape.lengths {
            IntervalLengths::Free => link.control[self.shape.wheels],
            IntervalLengths::Shared => link.point[1 + self.shape.shared_at()],
            IntervalLengths::Given(lengths) => lengths[link.node] / self.scales.time,
        }
    }

    /// The features of a wheel on an interval; at the last node only those of the node.
    fn wheel_state(&self, wheel: usize, link: &Link<'_>) -> WheelState {
        let (shape, unit) = (&self.shape, self.torque_unit());
        let view = self.base.view(link.point, self.drift(link.point));
        let mut features = [0.0; super::jet::FEATURES];
        features[SPEED] = self.speeds[wheel].value(&view);
        let couplings = self.speed_per_momentum.row(wheel);
        let sum = |values: &[f64], unit: f64| {
            couplings
                .iter()
                .zip(values)
                .map(|(c, v)| c * v * unit)
                .sum::<f64>()
        };
        let torques = &link.point[1 + shape.torque_at()..];
        if shape.course == TorqueCourse::Ramps {
            features[TORQUE_BEGIN] = torques[wheel] * unit;
        }
        if link.has_interval() {
            features[LENGTH] = self.length(link) * self.scales.time;
            match shape.course {
                TorqueCourse::Steps => {
                    features[TORQUE_BEGIN] = link.control[wheel] * self.scales.momentum;
                    features[SPEED_CHANGE] =
                        sum(&link.control[..shape.wheels], self.scales.momentum);
                }
                TorqueCourse::Ramps => {
                    features[TORQUE_END] = link.control[wheel] * unit;
                    features[SPEED_CHANGE] = sum(&torques[..shape.wheels], unit);
                    features[SPEED_CHANGE_END] = sum(&link.control[..shape.wheels], unit);
                }
            }
        }
        WheelState {
            course: shape.course,
            features,
        }
    }

    /// Derivatives of a wheel's feature by the variables, counted over state and controls.
    fn feature_gradient(&self, wheel: usize, feature: usize, link: &Link<'_>) -> Vec<(usize, f64)> {
        let (shape, unit) = (&self.shape, self.torque_unit());
        let (torques, controls) = (shape.torque_at(), shape.states());
        let coupled = |first: usize, unit: f64| {
            let couplings = self.speed_per_momentum.row(wheel);
            (0..shape.wheels)
                .map(|j| (first + j, couplings[j] * unit))
                .collect()
        };
        match (feature, shape.course) {
            (SPEED, _) => {
                let mut row = vec![0.0; shape.states()];
                let view = self.base.view(link.point, self.drift(link.point));
                self.base.write_row(&self.speeds[wheel], &view, &mut row);
                let entries = row.into_iter().enumerate();
                entries.filter(|(_, slope)| *slope != 0.0).collect()
            }
            (SPEED_CHANGE, TorqueCourse::Steps) => coupled(controls, self.scales.momentum),
            (SPEED_CHANGE, TorqueCourse::Ramps) => coupled(torques, unit),
            (SPEED_CHANGE_END, TorqueCourse::Ramps) => coupled(controls, unit),
            (TORQUE_BEGIN, TorqueCourse::Steps) => vec![(controls + wheel, self.scales.momentum)],
            (TORQUE_BEGIN, TorqueCourse::Ramps) => vec![(torques + wheel, unit)],
            (TORQUE_END, TorqueCourse::Ramps) => vec![(controls + wheel, unit)],
            (LENGTH, _) => self
                .shape
                .length_variable()
                .map(|at| (at, self.scales.time))
                .into_iter()
                .collect(),
            _ => Vec::new(),
        }
    }

    /// Derivatives of a jet by the program's variables.
    fn local(&self, wheel: usize, jet: &Jet, link: &Link<'_>) -> SparseDerivatives {
        let used: Vec<_> = (0..super::jet::FEATURES)
            .filter(|&f| jet.gradient[f] != 0.0 || jet.hessian[f].iter().any(|h| *h != 0.0))
            .map(|f| (f, self.feature_gradient(wheel, f, link)))
            .collect();
        let mut local = SparseDerivatives::default();
        for (f, by_f) in &used {
            local
                .gradient
                .extend(by_f.iter().map(|(at, c)| (*at, c * jet.gradient[*f])));
            for (g, by_g) in &used {
                let bend = jet.hessian[*f][*g];
                if bend == 0.0 {
                    continue;
                }
                for (i, a) in by_f {
                    for (j, b) in by_g {
                        if i >= j {
                            local.hessian.push((*i, *j, bend * a * b));
                        }
                    }
                }
            }
        }
        local
    }
}
