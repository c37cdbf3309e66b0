//! The equations of motion, implemented a second time on purpose.
//!
//! Nothing is shared with the planning code, so that an error there does not occur here too. With
//! the symbols of [`crate::model::spacecraft`] and the conventions of [`crate::model::attitude`]:
//!
//! ```text
//! H_b      = J w + sum a_i I_i W_i                  (all wheels)
//! J_eff w' = -w x H_b - sum a_i u_i                 (driven wheels)
//! W_i'     = u_i / I_i - a_i . w'                   (driven wheels; 0 for locked ones)
//! W_i'     = -r_i (W_i - S_i)                       (wheels with a speed law, whose -a_i I_i W_i'
//!                                                   joins the right-hand side of J_eff w')
//! q'       = 1/2 q (x) [w, 0]
//! J_eff    = J - sum I_i a_i a_i^T                  (driven wheels)
//! ```

use crate::model::scenario::Scenario;
use crate::model::spacecraft::Wheel;
use nalgebra::{Matrix3, Vector3};

/// Scalar-last quaternion components, sign included.
pub(super) type QuaternionComponents = [f64; 4];

/// Hamilton's product `a (x) b`.
pub(super) fn product(a: &QuaternionComponents, b: &QuaternionComponents) -> QuaternionComponents {
    let [ax, ay, az, aw] = *a;
    let [bx, by, bz, bw] = *b;
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// The inverse of a unit quaternion.
pub(super) fn conjugate(q: &QuaternionComponents) -> QuaternionComponents {
    [-q[0], -q[1], -q[2], q[3]]
}

/// A body vector seen in the reference frame: `q v q*`.
pub(super) fn to_reference(q: &QuaternionComponents, v: &Vector3<f64>) -> Vector3<f64> {
    let p = product(&product(q, &[v.x, v.y, v.z, 0.0]), &conjugate(q));
    Vector3::new(p[0], p[1], p[2])
}

/// Length of a quaternion.
pub(super) fn norm(q: &QuaternionComponents) -> f64 {
    q.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The state at one time: quaternion, body rate (rad/s) and wheel speeds relative to the body
/// (rad/s).
#[derive(Debug, Clone)]
pub(super) struct Snapshot {
    pub(super) time_s: f64,
    pub(super) quaternion: QuaternionComponents,
    pub(super) rate: Vector3<f64>,
    pub(super) wheel_speed: Vec<f64>,
}

impl Snapshot {
    /// The state in which a scenario starts.
    pub(super) fn at_start(scenario: &Scenario) -> Self {
        let start = scenario.start();
        Self {
            time_s: 0.0,
            quaternion: start.attitude.xyzw(),
            rate: start.rate,
            wheel_speed: start.wheel_speed.clone(),
        }
    }

    /// Whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        self.quaternion.iter().all(|c| c.is_finite())
            && self.rate.iter().all(|c| c.is_finite())
            && self.wheel_speed.iter().all(|c| c.is_finite())
    }
}

/// Properties of a wheel in the equations of motion.
#[derive(Debug, Clone)]
pub(super) struct CheckedWheel {
    pub(super) axis: Vector3<f64>,
    pub(super) inertia: f64,
    /// A wheel that is not driven keeps its speed relative to the body, or follows its speed law.
    pub(super) driven: bool,
    /// Rate, 1/s, and speed, rad/s, of the wheel's speed law.
    pub(super) law: Option<(f64, f64)>,
}

/// A rigid body with wheels.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub(super) inertia: Matrix3<f64>,
    pub(super) effective_inverse: Matrix3<f64>,
    pub(super) rotors: Vec<CheckedWheel>,
}

impl Body {
    /// The body of a whole-spacecraft inertia (kg m²) and its wheels; a sentence when `J_eff` has no
    /// inverse.
    pub(super) fn new(inertia: &Matrix3<f64>, wheels: &[Wheel]) -> Result<Self, String> {
        let rotors: Vec<CheckedWheel> = wheels
            .iter()
            .map(|wheel| CheckedWheel {
                axis: wheel.axis,
                inertia: wheel.inertia,
                driven: wheel.enabled,
                law: None,
            })
            .collect();
        let mut effective = *inertia;
        for rotor in rotors.iter().filter(|r| r.driven) {
            effective -= rotor.axis * rotor.axis.transpose() * rotor.inertia;
        }
        // Scaled to order one first: a determinant of very small inertias underflows.
        let scale = effective.amax();
        let Some(inverse) = (effective / scale).try_inverse() else {
            return Err("the inertia without the wheels' spin has no inverse".to_owned());
        };
        Ok(Self {
            inertia: *inertia,
            effective_inverse: inverse / scale,
            rotors,
        })
    }

    /// `H_b`, N m s.
    pub(super) fn momentum(&self, rate: &Vector3<f64>, wheel_speed: &[f64]) -> Vector3<f64> {
        let mut momentum = self.inertia * rate;
        for (rotor, speed) in self.rotors.iter().zip(wheel_speed) {
            momentum += rotor.axis * (rotor.inertia * speed);
        }
        momentum
    }

    /// Sum of the norms of the parts of `H_b`, N m s: the scale of its rounding error.
    pub(super) fn momentum_scale(&self, rate: &Vector3<f64>, wheel_speed: &[f64]) -> f64 {
        let wheels = self.rotors.iter().zip(wheel_speed);
        wheels.fold((self.inertia * rate).norm(), |sum, (rotor, speed)| {
            sum + rotor.axis.norm() * (rotor.inertia * speed).abs()
        })
    }

    /// Reaction of the motors on the body, N m: `-sum a_i u_i`.
    pub(super) fn motor_torque(&self, torque: &[f64]) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for (rotor, u) in self.rotors.iter().zip(torque) {
            if rotor.driven {
                sum -= rotor.axis * *u;
            }
        }
        sum
    }

    /// `w'`, rad/s².
    pub(super) fn rate_derivative(&self, state: &Snapshot, torque: &[f64]) -> Vector3<f64> {
        let momentum = self.momentum(&state.rate, &state.wheel_speed);
        let mut moment = self.motor_torque(torque) - state.rate.cross(&momentum);
        for (rotor, speed) in self.rotors.iter().zip(&state.wheel_speed) {
            if let Some(acceleration) = rotor.law_acceleration(*speed) {
                moment -= rotor.axis * (rotor.inertia * acceleration);
            }
        }
        self.effective_inverse * moment
    }

    /// `W_i'`, rad/s², of a wheel with its torque and speed, given `w'`.
    pub(super) fn wheel_derivative(
        &self,
        wheel: usize,
        torque: f64,
        speed: f64,
        rate_derivative: &Vector3<f64>,
    ) -> f64 {
        let rotor = &self.rotors[wheel];
        if rotor.driven {
            torque / rotor.inertia - rotor.axis.dot(rate_derivative)
        } else {
            rotor.law_acceleration(speed).unwrap_or(0.0)
        }
    }
}

impl CheckedWheel {
    /// `W'`, rad/s², at a speed (rad/s), of a wheel with a speed law.
    fn law_acceleration(&self, speed: f64) -> Option<f64> {
        self.law.map(|(rate, held)| -rate * (speed - held))
    }
}

/// `q'`, 1/s.
pub(super) fn quaternion_derivative(
    q: &QuaternionComponents,
    rate: &Vector3<f64>,
) -> QuaternionComponents {
    product(q, &[rate.x, rate.y, rate.z, 0.0]).map(|c| 0.5 * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_with_one_number_that_is_not_finite_is_not_finite() {
        let whole = Snapshot {
            time_s: 0.0,
            quaternion: [0.0, 0.0, 0.0, 1.0],
            rate: Vector3::zeros(),
            wheel_speed: vec![0.0; 3],
        };
        assert!(whole.is_finite());
        for index in 0..10 {
            let mut state = whole.clone();
            let mut numbers = state.quaternion.iter_mut();
            let mut numbers = numbers
                .by_ref()
                .chain(state.rate.iter_mut())
                .chain(&mut state.wheel_speed);
            *numbers.nth(index).expect("ten numbers") = f64::NAN;
            assert!(!state.is_finite(), "{index}");
        }
    }
}
