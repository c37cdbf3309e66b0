//! Cost and limits of an interval, wheel by wheel, in physical units.
//!
//! A wheel on an interval is described by six features, all of them linear in the variables. With
//! `s` in `[0, 1]` along the interval, `tau` its length and `W` the wheel's speed:
//!
//! | | constant torque | linear torque |
//! |---|---|---|
//! | `TORQUE_BEGIN`, `TORQUE_END` | `m`, - | `u`, `v` |
//! | torque | `m / tau` | `u + s (v - u)` |
//! | `SPEED_CHANGE`, `SPEED_CHANGE_END` | `W(1) - W(0)`, - | acceleration at the two ends |
//! | speed | `W(0) + s SPEED_CHANGE` | `W(0) + tau (s SPEED_CHANGE + s^2 / 2 (SPEED_CHANGE_END - SPEED_CHANGE))` |
//!
//! The speed within an interval leaves out that stored momentum turns in body axes: this acts on a
//! wheel only through the body rate, of the order of the wheel's inertia over the body's.

use super::jet::{FEATURES, Jet};
use super::shape::TorqueCourse;
use crate::model::drive::Drive;
use crate::model::dynamics::Actuator;

/// `W(0)`, rad/s.
pub(super) const SPEED: usize = 0;
/// Change of the speed, rad/s, or acceleration at the beginning, rad/s².
pub(super) const SPEED_CHANGE: usize = 1;
/// Acceleration at the end, rad/s².
pub(super) const SPEED_CHANGE_END: usize = 2;
/// Change of momentum, N m s, or torque at the beginning, N m.
pub(super) const TORQUE_BEGIN: usize = 3;
/// Torque at the end, N m.
pub(super) const TORQUE_END: usize = 4;
/// Length, s.
pub(super) const LENGTH: usize = 5;

/// Speed below which Coulomb friction changes its sign smoothly, as a share of the speed limit: the
/// program needs smooth functions. Below it torque limits hold for friction of either sign.
const TURNOVER: f64 = 0.01;
/// The same speed, rad/s, for a wheel without a speed limit.
const UNLIMITED_TURNOVER: f64 = 1.0;
/// Nodes and weights of Gauss's rule with three points, which is exact for the power of an ideal
/// wheel: of degree two in time under a constant torque, four under a linear one.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How Coulomb friction is smoothed while it changes its sign.
#[derive(Debug, Clone, Copy)]
enum FrictionSign {
    /// Never below the exact function.
    Above,
    /// Between the other two.
    Mean,
    /// Never above the exact function.
    Below,
}

/// One wheel with its drive.
#[derive(Debug, Clone)]
pub(super) struct DrivenWheel {
    /// Limits of the torque, N m.
    min_torque: f64,
    max_torque: f64,
    /// Coefficients of the friction that the motor compensates, N m s and N m; otherwise zero.
    viscous: f64,
    coulomb: f64,
    turnover: f64,
    /// Heat per squared torque `R / k^2`, W/(N m)², where the motor is known.
    heat: Option<f64>,
}

/// The features of a wheel on an interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct WheelState {
    pub(super) course: TorqueCourse,
    pub(super) features: [f64; FEATURES],
}

impl WheelState {
    fn feature(&self, index: usize) -> Jet {
        Jet::feature(index, self.features[index])
    }

    /// Length of the interval, s.
    pub(super) fn length(&self) -> Jet {
        self.feature(LENGTH)
    }

    /// Torque at the beginning of an interval with a linear one, N m.
    fn node_torque(&self) -> Jet {
        self.feature(TORQUE_BEGIN)
    }

    fn torque(&self, s: f64) -> Jet {
        match self.course {
            TorqueCourse::Steps => self.feature(TORQUE_BEGIN) * self.length().recip(),
            TorqueCourse::Ramps => {
                self.feature(TORQUE_BEGIN) * (1.0 - s) + self.feature(TORQUE_END) * s
            }
        }
    }

    fn speed(&self, s: f64) -> Jet {
        let begin = self.feature(SPEED);
        match self.course {
            TorqueCourse::Steps => begin + self.feature(SPEED_CHANGE) * s,
            TorqueCourse::Ramps => {
                let (a, b) = (s - 0.5 * s * s, 0.5 * s * s);
                begin
                    + self.length()
                        * (self.feature(SPEED_CHANGE) * a + self.feature(SPEED_CHANGE_END) * b)
            }
        }
    }

    /// Change of momentum over the interval, N m s.
    pub(super) fn impulse(&self) -> Jet {
        match self.course {
            TorqueCourse::Steps => self.feature(TORQUE_BEGIN),
            TorqueCourse::Ramps => {
                self.length() * (self.feature(TORQUE_BEGIN) + self.feature(TORQUE_END)) * 0.5
            }
        }
    }

    /// Mean of the momentum above the straight line between its ends, N m s.
    pub(super) fn bulge(&self) -> Jet {
        match self.course {
            TorqueCourse::Steps => Jet::constant(0.0),
            TorqueCourse::Ramps => {
                self.length()
                    * (self.feature(TORQUE_END) - self.feature(TORQUE_BEGIN))
                    * (-1.0 / 12.0)
            }
        }
    }

    /// Integral of the squared torque, (N m)² s.
    pub(super) fn effort(&self) -> Jet {
        let (u, v, tau) = (
            self.feature(TORQUE_BEGIN),
            self.feature(TORQUE_END),
            self.length(),
        );
        match self.course {
            TorqueCourse::Steps => u * u * tau.recip(),
            TorqueCourse::Ramps => tau * (u * u + u * v + v * v) * (1.0 / 3.0),
        }
    }
}

impl DrivenWheel {
    /// A wheel with its limits, and its drive's friction and motor.
    pub(super) fn new(wheel: &Actuator, drive: &Drive) -> Self {
        let compensated = f64::from(u8::from(drive.friction_compensated));
        let turnover = if wheel.max_speed.is_finite() {
            TURNOVER * wheel.max_speed
        } else {
            UNLIMITED_TURNOVER
        };
        Self {
            min_torque: wheel.min_torque,
            max_torque: wheel.max_torque,
            viscous: drive.viscous_friction * compensated,
            coulomb: drive.coulomb_friction * compensated,
            turnover,
            heat: drive
                .motor
                .map(|motor| motor.resistance / motor.torque_constant.powi(2)),
        }
    }

    fn has_friction(&self) -> bool {
        self.viscous > 0.0 || self.coulomb > 0.0
    }

    /// Number of inequalities that limit a constant torque.
    pub(super) fn step_rows(&self) -> usize {
        if self.has_friction() { 4 } else { 2 }
    }

    /// Margins of a constant motor torque at the ends of an interval, `tau - M tau / limit`, s. Speed and
    /// friction are almost linear in between.
    pub(super) fn step_margins(&self, wheel: &WheelState) -> impl Iterator<Item = Jet> {
        let ends: &[f64] = if self.has_friction() {
            &[0.0, 1.0]
        } else {
            &[0.0]
        };
        ends.iter().flat_map(|s| {
            let (tau, speed) = (wheel.length(), wheel.speed(*s));
            [
                (FrictionSign::Above, self.max_torque),
                (FrictionSign::Below, self.min_torque),
            ]
            .map(|(sign, limit)| {
                let impulse = wheel.impulse() + tau * self.friction(&speed, sign);
                tau - impulse * limit.recip()
            })
        })
    }

    /// Margins of the motor torque at a node, as shares of the limits.
    pub(super) fn node_margins(&self, wheel: &WheelState) -> [Jet; 2] {
        let speed = wheel.feature(SPEED);
        [
            (FrictionSign::Above, self.max_torque),
            (FrictionSign::Below, self.min_torque),
        ]
        .map(|(sign, limit)| {
            let motor = wheel.node_torque() + self.friction(&speed, sign);
            Jet::constant(1.0) - motor * limit.recip()
        })
    }

    /// Torque of friction, N m.
    fn friction(&self, speed: &Jet, sign: FrictionSign) -> Jet {
        *speed * self.viscous + self.direction(speed, sign) * self.coulomb
    }

    /// The sign of a speed, smoothed within the turnover speed.
    fn direction(&self, speed: &Jet, sign: FrictionSign) -> Jet {
        if self.coulomb == 0.0 {
            return Jet::constant(0.0);
        }
        let slope = 2.0 / self.turnover;
        let shift = match sign {
            FrictionSign::Above => 1.0,
            FrictionSign::Mean => 0.0,
            FrictionSign::Below => -1.0,
        };
        let x = slope * speed.value + shift;
        let values = if x.abs() >= 1.0 {
            [x.signum(), 0.0, 0.0]
        } else {
            let y = 1.0 - x * x;
            [
                x * (15.0 - 10.0 * x * x + 3.0 * x.powi(4)) / 8.0,
                slope * 15.0 / 8.0 * y * y,
                slope * slope * -7.5 * x * y,
            ]
        };
        speed.through(values)
    }

    /// Integral of the motor's power over an interval, J: `P = R/k^2 M^2 + M W`.
    pub(super) fn energy(&self, wheel: &WheelState) -> Jet {
        let Some(heat) = self.heat else {
            return Jet::constant(0.0);
        };
        let power = GAUSS.map(|(s, weight)| {
            let speed = wheel.speed(s);
            let motor = wheel.torque(s) + self.friction(&speed, FrictionSign::Mean);
            (motor * motor * heat + motor * speed) * weight
        });
        wheel.length() * (power[0] + power[1] + power[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coulomb_friction_is_never_underestimated_by_the_limits() {
        let wheel = DrivenWheel {
            min_torque: -1.0,
            max_torque: 1.0,
            viscous: 0.0,
            coulomb: 0.1,
            turnover: 2.0,
            heat: None,
        };
        for speed in [-3.0, -1.5, -0.2, -1e-9, 1e-9, 0.3, 1.9, 5.0_f64] {
            let at = |sign| wheel.friction(&Jet::constant(speed), sign).value;
            let exact = 0.1 * speed.signum();
            assert!(
                at(FrictionSign::Above) >= exact - 1e-15
                    && at(FrictionSign::Below) <= exact + 1e-15
            );
            assert!(
                at(FrictionSign::Below) <= at(FrictionSign::Mean)
                    && at(FrictionSign::Mean) <= at(FrictionSign::Above)
            );
        }
    }
}
