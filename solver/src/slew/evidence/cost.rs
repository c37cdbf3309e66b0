//! The running cost of the wheels with its derivatives, and the limits of their torques.

use crate::model::drive::Drive;
use crate::model::dynamics::Dynamics;
use crate::slew::cost_weights::CostWeights;
use crate::slew::flow::MotionSample;
use crate::slew::spec::EnergyMeasure;
use crate::slew::vehicle::Vehicle;

/// Share of a limit above which it counts as active.
pub(super) const NEAR: f64 = 0.999;

/// The running cost `l` for a constant weight of energy, and the limits of torques.
pub(super) struct RunningCost<'a> {
    vehicle: &'a Vehicle,
    cost_weights: &'a CostWeights,
    /// Weight of energy, unit of the objective per J.
    energy_weight: f64,
}

impl<'a> RunningCost<'a> {
    pub(super) fn new(
        vehicle: &'a Vehicle,
        cost_weights: &'a CostWeights,
        energy_weight: f64,
    ) -> Self {
        Self {
            vehicle,
            cost_weights,
            energy_weight,
        }
    }

    pub(super) fn dynamics(&self) -> &'a Dynamics {
        &self.vehicle.dynamics
    }

    /// The drive of a wheel and its motor, where energy has a weight and the motor is known.
    fn costed_motor(&self, wheel: usize) -> Option<(&'a Drive, &'a crate::model::drive::Motor)> {
        let drive = &self.vehicle.drives[wheel];
        let motor = drive.motor.as_ref().filter(|_| self.energy_weight != 0.0);
        motor.map(|motor| (drive, motor))
    }

    /// Whether energy at this power, W, counts in the running cost.
    fn counts(&self, power: f64) -> bool {
        self.cost_weights.measure == EnergyMeasure::Proxy || power > 0.0
    }

    /// `dl / dW` of a wheel.
    pub(super) fn by_speed(&self, wheel: usize, at: &MotionSample) -> f64 {
        let Some((drive, motor)) = self.costed_motor(wheel) else {
            return 0.0;
        };
        let (torque, speed) = (at.torques[wheel], at.speeds[wheel]);
        let given = drive.motor_torque(torque, speed);
        let viscous = if drive.friction_compensated {
            drive.viscous_friction
        } else {
            0.0
        };
        let heat = 2.0 * motor.resistance / motor.torque_constant.powi(2) * given;
        if self.counts(motor.power(given, speed)) {
            let share = self.cost_weights.supply_factor(motor.efficiency);
            self.energy_weight * share * (heat * viscous + given + viscous * speed)
        } else {
            0.0
        }
    }

    /// `dl / du` of a wheel.
    pub(super) fn by_torque(&self, wheel: usize, at: &MotionSample) -> f64 {
        let (torque, speed) = (at.torques[wheel], at.speeds[wheel]);
        let effort = 2.0 * self.cost_weights.effort * torque;
        let motor = self.costed_motor(wheel).map_or(0.0, |(drive, motor)| {
            let given = drive.motor_torque(torque, speed);
            let heat = 2.0 * motor.resistance / motor.torque_constant.powi(2) * given;
            let share = self.cost_weights.supply_factor(motor.efficiency);
            if self.counts(motor.power(given, speed)) {
                self.energy_weight * share * (heat + speed)
            } else {
                0.0
            }
        });
        effort + motor
    }

    /// The running cost of one wheel as a function of its torque, N m.
    pub(super) fn of_wheel(&self, wheel: usize, torque: f64, at: &MotionSample) -> f64 {
        let effort = self.cost_weights.effort * torque * torque;
        let Some((drive, motor)) = self.costed_motor(wheel) else {
            return effort;
        };
        let speed = at.speeds[wheel];
        let power = motor.power(drive.motor_torque(torque, speed), speed);
        let share = self.cost_weights.supply_factor(motor.efficiency);
        effort
            + if self.counts(power) {
                self.energy_weight * share * power
            } else {
                0.0
            }
    }

    /// The whole running cost.
    pub(super) fn value(&self, at: &MotionSample) -> f64 {
        let wheels = 0..at.speeds.len();
        let torques: f64 = wheels.map(|w| self.of_wheel(w, at.torques[w], at)).sum();
        let idle = if self.cost_weights.measure == EnergyMeasure::Bill {
            let motors = self.vehicle.drives.iter().filter_map(|drive| drive.motor);
            self.energy_weight * motors.map(|motor| motor.quiescent_power).sum::<f64>()
        } else {
            0.0
        };
        self.cost_weights.time + torques + idle
    }

    /// The range of commanded torques within the motor's limits, N m.
    pub(super) fn range(&self, wheel: usize, at: &MotionSample) -> [f64; 2] {
        let actuator = &self.vehicle.dynamics.actuators[wheel];
        let friction = self.vehicle.drives[wheel].motor_torque(0.0, at.speeds[wheel]);
        [
            actuator.min_torque - friction,
            actuator.max_torque - friction,
        ]
    }

    /// 1 or -1 for a torque at its upper or lower limit.
    pub(super) fn side(&self, wheel: usize, at: &MotionSample) -> Option<f64> {
        let ([least, most], torque) = (self.range(wheel, at), at.torques[wheel]);
        let slack = (1.0 - NEAR) * (most - least);
        if torque >= most - slack {
            Some(1.0)
        } else {
            (torque <= least + slack).then_some(-1.0)
        }
    }

    /// For every wheel, whether an active limit of speed or body rate determines its torque.
    pub(super) fn held(&self, at: &MotionSample) -> Vec<bool> {
        let shares = self.vehicle.dynamics.limit_shares(&at.rate, &at.momenta);
        let active: Vec<bool> = shares.map(|share| share.abs() > NEAR).collect();
        let (wheels, rates) = active.split_at(at.speeds.len());
        // A limit on the body rate involves all wheels.
        let together = rates.contains(&true);
        wheels.iter().map(|own| *own || together).collect()
    }
}
