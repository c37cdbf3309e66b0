//! The wheel loop, faster than the on-board computer: from commands to motor torques.
//!
//! Once per cycle a drive measures its wheel's speed and sets the motor's torque for the cycle
//! (BIROS, equations 14 and 15):
//!
//! ```text
//!   M = u + v W + c sign(W)          friction compensated, with nominal coefficients
//!   M = u                            not compensated
//!   u = -I rate (W - speed)          of a wheel with a speed law, in place of a command
//! ```
//!
//! It then reduces `M` so that the wheel does not exceed its speed limit by the end of the cycle, and
//! limits it to the motor's torque.

use crate::checker::LIMIT_TOLERANCE;
use crate::model::drive::Drive;
use crate::model::spacecraft::Wheel;

/// A motor's torque in a cycle, and which limits were reached.
#[derive(Debug, Clone, Copy)]
pub(super) struct MotorCycle {
    /// N m.
    pub(super) motor_torque: f64,
    pub(super) torque_limited: bool,
    pub(super) speed_limited: bool,
    /// Demanded torque minus the motor's, N m; zero where no limit was reached.
    pub(super) missing: f64,
}

/// Sets the torque of a wheel's motor for a cycle of this length, s, from a command (N m) and the
/// wheel's speed (rad/s).
pub(super) fn cycle(
    wheel: &Wheel,
    drive: &Drive,
    command: f64,
    speed: f64,
    length: f64,
) -> MotorCycle {
    let wanted = drive.speed_law.map_or(command, |law| {
        -wheel.inertia * law.rate * (speed - law.speed)
    });
    let friction = drive.friction(speed);
    let demand = if drive.friction_compensated {
        wanted + friction
    } else {
        wanted
    };
    // An excess over a limit by rounding, as plans may have, is not saturation.
    let rounding = LIMIT_TOLERANCE * wheel.max_torque.max(-wheel.min_torque);
    let most_speed = wheel.max_speed * (1.0 + LIMIT_TOLERANCE);
    let most = wheel.inertia * (most_speed - speed) / length + friction;
    let least = wheel.inertia * (-most_speed - speed) / length + friction;
    let slow_enough = demand.min(most).max(least);
    let motor_torque = slow_enough.min(wheel.max_torque).max(wheel.min_torque);
    let torque_limited = (motor_torque - slow_enough).abs() > rounding;
    let speed_limited = (slow_enough - demand).abs() > rounding;
    MotorCycle {
        motor_torque,
        torque_limited,
        speed_limited,
        missing: if torque_limited || speed_limited {
            demand - motor_torque
        } else {
            0.0
        },
    }
}

/// A commanded torque within the wheel's limits, N m, and whether it was limited.
pub(super) fn commandable(wheel: &Wheel, torque: f64) -> (f64, bool) {
    let limited = torque.min(wheel.max_torque).max(wheel.min_torque);
    let rounding = LIMIT_TOLERANCE * wheel.max_torque.max(-wheel.min_torque);
    (limited, (torque - limited).abs() > rounding)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::drive::SpeedLaw;
    use nalgebra::Vector3;

    const WHEEL: Wheel = Wheel {
        axis: Vector3::new(1.0, 0.0, 0.0),
        inertia: 1e-3,
        min_torque: -0.1,
        max_torque: 0.1,
        max_speed: 100.0,
        enabled: true,
    };
    const RUBBING: Drive = Drive {
        viscous_friction: 1e-4,
        coulomb_friction: 2e-3,
        ..Drive::IDEAL
    };

    #[test]
    fn compensated_friction_is_added_to_the_motor_torque_and_limited_with_it() {
        let free = cycle(&WHEEL, &RUBBING, 0.05, 50.0, 0.01);
        assert!((free.motor_torque - 0.057).abs() < 1e-15);
        assert!(!free.torque_limited && !free.speed_limited);
        let full = cycle(&WHEEL, &RUBBING, 0.099, 50.0, 0.01);
        assert!((full.motor_torque - 0.1).abs() < 1e-15 && full.torque_limited);
        let bare = Drive {
            friction_compensated: false,
            ..RUBBING
        };
        let torque = cycle(&WHEEL, &bare, 0.05, 50.0, 0.01).motor_torque;
        assert!((torque - 0.05).abs() < 1e-15);
    }

    #[test]
    fn a_wheel_is_driven_to_its_speed_limit_and_not_beyond() {
        let near = cycle(&WHEEL, &Drive::IDEAL, 0.1, 99.9, 0.01);
        assert!((near.motor_torque - 0.01).abs() < 2e-5, "{near:?}");
        assert!(near.speed_limited && !near.torque_limited);
        let at = cycle(&WHEEL, &RUBBING, 0.1, 100.0, 0.01);
        assert!((at.motor_torque - 0.012).abs() < 2e-5, "{at:?}");
        let back = cycle(&WHEEL, &Drive::IDEAL, -0.1, 100.0, 0.01);
        assert!((back.motor_torque + 0.1).abs() < 1e-15 && !back.speed_limited);
    }

    #[test]
    fn the_wheel_loop_is_symmetric_in_the_sign_of_command_and_speed() {
        for (command, speed) in [
            (0.05, 50.0),
            (0.099, 50.0),
            (0.1, 99.9),
            (0.1, 100.0),
            (-0.1, 100.0),
            (0.2, -30.0),
            (0.0, 100.2),
        ] {
            let forth = cycle(&WHEEL, &RUBBING, command, speed, 0.01);
            let back = cycle(&WHEEL, &RUBBING, -command, -speed, 0.01);
            let case = format!("{command} N m at {speed} rad/s");
            assert!(
                (forth.motor_torque + back.motor_torque).abs() < 1e-15,
                "{case}: {forth:?} {back:?}"
            );
            assert!((forth.missing + back.missing).abs() < 1e-15, "{case}");
            assert_eq!(forth.torque_limited, back.torque_limited, "{case}");
            assert_eq!(forth.speed_limited, back.speed_limited, "{case}");
            let forth = commandable(&WHEEL, 3.0 * command);
            let back = commandable(&WHEEL, -3.0 * command);
            assert!(
                (forth.0 + back.0).abs() < 1e-15 && forth.1 == back.1,
                "{case}"
            );
        }
    }

    #[test]
    fn a_wheel_with_a_speed_law_ignores_commands() {
        let held = Drive {
            speed_law: Some(SpeedLaw {
                rate: 0.5,
                speed: -20.0,
            }),
            ..Drive::IDEAL
        };
        let torque = cycle(&WHEEL, &held, 0.1, -10.0, 0.01).motor_torque;
        assert!((torque + 5e-3).abs() < 1e-15, "{torque}");
    }
}
