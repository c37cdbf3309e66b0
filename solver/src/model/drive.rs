//! The drives of wheels: friction, motor, and speed laws that replace commands.
//!
//! With `u` the torque that changes a wheel's momentum and `W` its speed relative to the body, the
//! motor has to give
//!
//! ```text
//!   M = u + v W + c sign(W)                   (BIROS section on the wheel's inner loop)
//!   P = (R / k^2) M^2 + M W                   (energy thesis, equation 1.15, with c = 0)
//! ```
//!
//! with viscous and Coulomb friction `v`, `c`, winding resistance `R` and torque constant `k`. The
//! supply gives `max(P, 0) / efficiency + quiescent`: nothing is fed back (equation 1.16).

use crate::model::findings::Findings;
use crate::model::input::{input_object, optional, required};
use crate::model::problem::{Code, Problem};

input_object! {
    /// How a wheel is driven: with nothing given, by an ideal drive.
    #[derive(Default)]
    pub struct DriveSpec as "WheelDrive" {
        /// Viscous friction `v`.
        pub viscous_friction_nms: Option<f64> = optional().at_least(0.0).means(0.0),
        /// Coulomb friction `c`.
        pub coulomb_friction_nm: Option<f64> = optional().at_least(0.0).means(0.0),
        /// Whether an inner loop compensates friction: the torque limits are then the motor's. Without it
        /// a commanded torque is the motor's, and friction is subtracted from it.
        pub friction_compensated: Option<bool> = optional().means(true),
        /// The motor, for its power consumption.
        pub motor: Option<MotorSpec> = optional(),
        /// A speed law that the wheel follows instead of commands.
        pub speed_law: Option<SpeedLawSpec> = optional(),
    }
}

input_object! {
    /// An electric motor. Its power is `resistance (torque / torque constant)^2 + torque speed`.
    pub struct MotorSpec as "Motor" {
        /// Resistance of the winding `R`.
        pub resistance_ohm: f64 = required().above(0.0),
        /// Torque constant `k`, N m/A, which is also V s/rad.
        pub torque_constant_nm_a: f64 = required().above(0.0),
        /// Share of the supplied power that reaches the motor.
        pub efficiency: Option<f64> = optional().above(0.0).at_most(1.0).means(1.0),
        /// Power of the electronics without torque.
        pub quiescent_power_w: Option<f64> = optional().at_least(0.0).means(0.0),
    }
}

input_object! {
    /// The speed `W` relative to the body follows `W' = -rate (W - speed)`.
    pub struct SpeedLawSpec as "SpeedLaw" {
        /// Zero leaves the wheel idle.
        pub rate_per_s: f64 = required().at_least(0.0),
        /// The speed that is held.
        pub speed_rad_s: f64 = required(),
    }
}

/// A valid drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// `v`, N m s.
    pub viscous_friction: f64,
    /// `c`, N m.
    pub coulomb_friction: f64,
    /// Whether commands are net of friction.
    pub friction_compensated: bool,
    /// The motor, where its consumption is known.
    pub motor: Option<Motor>,
    /// The law that the wheel follows instead of commands.
    pub speed_law: Option<SpeedLaw>,
}

/// A valid motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// `R`, ohm.
    pub resistance: f64,
    /// `k`, N m/A.
    pub torque_constant: f64,
    /// Share of the supplied power that reaches the motor, above zero and at most one.
    pub efficiency: f64,
    /// Power of the electronics without torque, W.
    pub quiescent_power: f64,
}

/// `W' = -rate (W - speed)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLaw {
    /// Return rate, 1/s.
    pub rate: f64,
    /// The speed that is held, rad/s.
    pub speed: f64,
}

impl Drive {
    /// A drive without friction, whose motor is unknown.
    pub const IDEAL: Self = Self {
        viscous_friction: 0.0,
        coulomb_friction: 0.0,
        friction_compensated: true,
        motor: None,
        speed_law: None,
    };

    /// Validates one description per wheel, none for ideal drives; `pointer` is that of the list.
    ///
    /// # Errors
    ///
    /// All problems at once.
    pub fn read_all(
        specs: &[DriveSpec],
        wheels: usize,
        pointer: &str,
    ) -> Result<Vec<Self>, Vec<Problem>> {
        let mut findings = Findings::default();
        if specs.is_empty() {
            return Ok(vec![Self::IDEAL; wheels]);
        }
        if specs.len() != wheels {
            findings.refuse(
                pointer,
                Code::WrongLength,
                format!("there are {} drives for {wheels} wheels", specs.len()),
                "give one drive for each wheel, in the order of the wheels, or none at all",
            );
        }
        // All are read before they are collected: collecting into an option stops at the first
        // fault.
        let drives: Vec<_> = specs
            .iter()
            .enumerate()
            .map(|(i, spec)| Self::read(spec, &format!("{pointer}/{i}"), &mut findings))
            .collect();
        let drives: Option<Vec<Self>> = drives.into_iter().collect();
        let drives = drives.filter(|drives| drives.len() == wheels);
        findings.conclude(drives).map(|(drives, _)| drives)
    }

    fn read(spec: &DriveSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        let viscous = spec.viscous_friction_nms.unwrap_or(0.0);
        let viscous = findings.not_negative(&format!("{pointer}/viscous_friction_nms"), viscous);
        let coulomb = spec.coulomb_friction_nm.unwrap_or(0.0);
        let coulomb = findings.not_negative(&format!("{pointer}/coulomb_friction_nm"), coulomb);
        let motor = spec.motor.as_ref();
        let motor = motor.map(|motor| Motor::read(motor, &format!("{pointer}/motor"), findings));
        let law = spec.speed_law.as_ref();
        let law = law.map(|law| SpeedLaw::read(law, &format!("{pointer}/speed_law"), findings));
        Some(Self {
            viscous_friction: viscous?,
            coulomb_friction: coulomb?,
            friction_compensated: spec.friction_compensated.unwrap_or(true),
            motor: motor.map_or(Some(None), |motor| motor.map(Some))?,
            speed_law: law.map_or(Some(None), |law| law.map(Some))?,
        })
    }

    /// Friction torque at a speed (rad/s), N m, with the sign of the speed.
    #[must_use]
    pub fn friction(&self, speed: f64) -> f64 {
        let coulomb = if speed == 0.0 {
            0.0
        } else {
            self.coulomb_friction.copysign(speed)
        };
        self.viscous_friction * speed + coulomb
    }

    /// Motor torque, N m, for a commanded torque at a speed (rad/s): friction is added where an
    /// inner loop compensates it.
    #[must_use]
    pub fn motor_torque(&self, commanded: f64, speed: f64) -> f64 {
        if self.friction_compensated {
            commanded + self.friction(speed)
        } else {
            commanded
        }
    }
}

impl Motor {
    fn read(spec: &MotorSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        let resistance =
            findings.positive(&format!("{pointer}/resistance_ohm"), spec.resistance_ohm);
        let torque_constant = findings.positive(
            &format!("{pointer}/torque_constant_nm_a"),
            spec.torque_constant_nm_a,
        );
        let at = format!("{pointer}/efficiency");
        let efficiency = findings.positive(&at, spec.efficiency.unwrap_or(1.0));
        let efficiency = efficiency.filter(|&efficiency| {
            if efficiency > 1.0 {
                findings.refuse(
                    &at,
                    Code::OutOfRange,
                    format!("the efficiency is {efficiency}, it must be at most 1"),
                    "give the share of the supplied power that reaches the motor",
                );
            }
            efficiency <= 1.0
        });
        let quiescent = spec.quiescent_power_w.unwrap_or(0.0);
        let quiescent = findings.not_negative(&format!("{pointer}/quiescent_power_w"), quiescent);
        Some(Self {
            resistance: resistance?,
            torque_constant: torque_constant?,
            efficiency: efficiency?,
            quiescent_power: quiescent?,
        })
    }

    /// `P`, W, of a motor torque (N m) at a speed (rad/s); below zero where it brakes.
    #[must_use]
    pub fn power(&self, motor_torque: f64, speed: f64) -> f64 {
        let current = motor_torque / self.torque_constant;
        self.resistance * current * current + motor_torque * speed
    }

    /// Power of the supply for it, W: nothing is fed back.
    #[must_use]
    pub fn bill(&self, motor_torque: f64, speed: f64) -> f64 {
        self.power(motor_torque, speed).max(0.0) / self.efficiency + self.quiescent_power
    }
}

impl SpeedLaw {
    fn read(spec: &SpeedLawSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        let rate = findings.not_negative(&format!("{pointer}/rate_per_s"), spec.rate_per_s);
        let speed = findings.finite(&format!("{pointer}/speed_rad_s"), spec.speed_rad_s);
        Some(Self {
            rate: rate?,
            speed: speed?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fault_of_every_drive_is_found() {
        let motor = MotorSpec {
            resistance_ohm: 0.0,
            torque_constant_nm_a: f64::NAN,
            efficiency: Some(1.5),
            quiescent_power_w: Some(-1.0),
        };
        let faulty = DriveSpec {
            viscous_friction_nms: Some(-1e-6),
            motor: Some(motor),
            ..DriveSpec::default()
        };
        let problems = Drive::read_all(&[DriveSpec::default(), faulty], 3, "/drives").unwrap_err();
        let pointers: Vec<&str> = problems.iter().map(|p| p.pointer.as_str()).collect();
        assert_eq!(
            pointers,
            [
                "/drives",
                "/drives/1/viscous_friction_nms",
                "/drives/1/motor/resistance_ohm",
                "/drives/1/motor/torque_constant_nm_a",
                "/drives/1/motor/efficiency",
                "/drives/1/motor/quiescent_power_w",
            ]
        );
    }

    #[test]
    fn a_braking_motor_takes_no_power_from_the_supply() {
        let motor = Motor {
            resistance: 0.343,
            torque_constant: 0.0705,
            efficiency: 0.8,
            quiescent_power: 0.1,
        };
        // -0.01 N m at 50 rad/s: 0.0069 W of heat, 0.5 W from the wheel.
        let power = motor.power(-0.01, 50.0);
        assert!((power - (0.343 * (0.01_f64 / 0.0705).powi(2) - 0.5)).abs() < 1e-12);
        assert!((motor.bill(-0.01, 50.0) - 0.1).abs() < 1e-12);
        assert!((motor.bill(0.01, 50.0) - (motor.power(0.01, 50.0) / 0.8 + 0.1)).abs() < 1e-12);
    }

    #[test]
    fn friction_has_the_sign_of_the_speed() {
        let drive = Drive {
            viscous_friction: 5e-6,
            coulomb_friction: 5e-4,
            ..Drive::IDEAL
        };
        assert!((drive.friction(-200.0) + 1.5e-3).abs() < 1e-15);
        assert!(drive.friction(0.0).abs() < 1e-15);
    }
}
