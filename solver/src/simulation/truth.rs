//! The true spacecraft: equations of motion with friction and an external torque.
//!
//! With the symbols of [`crate::model::spacecraft`], motor torques `M_i`, friction coefficients `v_i`, `c_i`
//! and an external torque `d` in body axes:
//!
//! ```text
//! H_b      = J_eff w + sum a_i h_i + (locked wheels)
//! u_i      = M_i - v_i W_i - c_i s(W_i / band_i)        W_i = h_i / I_i - a_i . w
//! J_eff w' = -w x H_b - sum a_i u_i + d
//! h_i'     = u_i
//! q'       = 1/2 q (x) [w, 0]
//! ```
//!
//! `s` is the sign function, made linear within a band of speeds that one step could cross, so that a
//! wheel comes to rest instead of chattering. The integrator is the classical Runge-Kutta method of
//! fourth order. The states of the wheels are momenta about their axes instead of speeds, so that the
//! total momentum is conserved to rounding and to the order of the method.

use nalgebra::{Matrix3, Quaternion, Vector3};

/// A wheel with its true axis and friction.
#[derive(Debug, Clone)]
pub(super) struct TrueWheel {
    pub(super) axis: Vector3<f64>,
    pub(super) inertia: f64,
    /// N m s.
    pub(super) viscous: f64,
    /// N m.
    pub(super) coulomb: f64,
    /// Half width of the band of speed in which Coulomb friction rises, rad/s.
    pub(super) band: f64,
    /// A wheel that is not driven keeps its speed relative to the body.
    pub(super) driven: bool,
}

/// Share of the band by which Coulomb friction changes the speed in one step.
const BAND_PER_STEP: f64 = 0.25;

impl TrueWheel {
    /// The band for steps of this length, s.
    pub(super) fn band(coulomb: f64, inertia: f64, step: f64) -> f64 {
        coulomb * step / (BAND_PER_STEP * inertia)
    }

    /// N m, with the sign of the speed.
    fn friction(&self, speed: f64) -> f64 {
        let coulomb = if self.band > 0.0 {
            self.coulomb * (speed / self.band).clamp(-1.0, 1.0)
        } else {
            0.0
        };
        self.viscous * speed + coulomb
    }
}

/// A rigid body with wheels, with its true properties.
#[derive(Debug, Clone)]
pub(super) struct TrueSpacecraft {
    effective: Matrix3<f64>,
    effective_inverse: Matrix3<f64>,
    /// Momentum of the locked wheels relative to the body, body axes, N m s.
    locked: Vector3<f64>,
    pub(super) rotors: Vec<TrueWheel>,
    disturbance: Vector3<f64>,
}

/// The state at one time.
#[derive(Debug, Clone)]
pub(super) struct TrueState {
    pub(super) attitude: Quaternion<f64>,
    /// Body axes, rad/s.
    pub(super) rate: Vector3<f64>,
    /// `h_i`, N m s; of a locked wheel only the part from its speed relative to the body.
    pub(super) momentum: Vec<f64>,
}

/// Storage of the integrator: the derivatives of its four stages, and a state at which they are taken.
#[derive(Debug, Clone)]
pub(super) struct IntegratorScratch {
    probe: TrueState,
    slopes: [StateDerivative; 4],
}

#[derive(Debug, Clone)]
struct StateDerivative {
    attitude: Quaternion<f64>,
    rate: Vector3<f64>,
    momentum: Vec<f64>,
}

impl IntegratorScratch {
    pub(super) fn new(state: &TrueState) -> Self {
        let slope = StateDerivative {
            attitude: Quaternion::default(),
            rate: Vector3::zeros(),
            momentum: vec![0.0; state.momentum.len()],
        };
        Self {
            probe: state.clone(),
            slopes: [slope.clone(), slope.clone(), slope.clone(), slope],
        }
    }
}

/// `J_eff` of a body.
pub(super) fn effective_inertia(inertia: &Matrix3<f64>, rotors: &[TrueWheel]) -> Matrix3<f64> {
    let driven = rotors.iter().filter(|rotor| rotor.driven);
    driven.fold(*inertia, |rest, rotor| {
        rest - rotor.axis * rotor.axis.transpose() * rotor.inertia
    })
}

impl TrueSpacecraft {
    /// A body with the inertia of the whole (kg m²), speeds at which wheels that are not driven are
    /// locked (rad/s, one per wheel) and an external torque (N m). `None` when `J_eff` has no inverse.
    pub(super) fn new(
        inertia: &Matrix3<f64>,
        rotors: Vec<TrueWheel>,
        speed: &[f64],
        disturbance: Vector3<f64>,
    ) -> Option<Self> {
        let effective = effective_inertia(inertia, &rotors);
        let scale = effective.amax();
        let inverse = (effective / scale).try_inverse()? / scale;
        let wheels = rotors.iter().zip(speed);
        let locked = wheels
            .filter(|(rotor, _)| !rotor.driven)
            .map(|(rotor, speed)| rotor.axis * (rotor.inertia * speed))
            .sum();
        Some(Self {
            effective,
            effective_inverse: inverse,
            locked,
            rotors,
            disturbance,
        })
    }

    /// The state of an attitude, a body rate (rad/s) and wheel speeds (rad/s).
    pub(super) fn state(
        &self,
        attitude: Quaternion<f64>,
        rate: Vector3<f64>,
        speed: &[f64],
    ) -> TrueState {
        let momentum = self.rotors.iter().zip(speed).map(|(rotor, speed)| {
            let with_body = if rotor.driven {
                rotor.axis.dot(&rate)
            } else {
                0.0
            };
            rotor.inertia * (speed + with_body)
        });
        TrueState {
            attitude,
            rate,
            momentum: momentum.collect(),
        }
    }

    /// Speed of a wheel relative to the body, rad/s.
    pub(super) fn speed(&self, state: &TrueState, wheel: usize) -> f64 {
        let rotor = &self.rotors[wheel];
        let absolute = state.momentum[wheel] / rotor.inertia;
        if rotor.driven {
            absolute - rotor.axis.dot(&state.rate)
        } else {
            absolute
        }
    }

    /// Total angular momentum in body axes, N m s.
    pub(super) fn body_momentum(&self, state: &TrueState) -> Vector3<f64> {
        let wheels = self.rotors.iter().zip(&state.momentum);
        let driven = wheels.filter(|(rotor, _)| rotor.driven);
        driven.fold(
            self.effective * state.rate + self.locked,
            |sum, (rotor, h)| sum + rotor.axis * *h,
        )
    }

    /// Advances a state by a number of steps of length `step`, s, with constant motor torques, N m.
    pub(super) fn advance(
        &self,
        state: &mut TrueState,
        motor: &[f64],
        step: f64,
        steps: usize,
        scratch: &mut IntegratorScratch,
    ) {
        for _ in 0..steps {
            self.step(state, motor, step, scratch);
        }
    }

    fn step(
        &self,
        state: &mut TrueState,
        motor: &[f64],
        step: f64,
        scratch: &mut IntegratorScratch,
    ) {
        let IntegratorScratch { probe, slopes } = scratch;
        self.slope(state, motor, &mut slopes[0]);
        for (stage, share) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
            let (before, rest) = slopes.split_at_mut(stage);
            let last = &before[stage - 1];
            let length = share * step;
            probe.attitude = state.attitude + last.attitude * length;
            probe.rate = state.rate + last.rate * length;
            for ((to, from), slope) in probe
                .momentum
                .iter_mut()
                .zip(&state.momentum)
                .zip(&last.momentum)
            {
                *to = from + slope * length;
            }
            self.slope(probe, motor, &mut rest[0]);
        }
        let [a, b, c, d] = &*slopes;
        let sixth = step / 6.0;
        state.attitude += (a.attitude + (b.attitude + c.attitude) * 2.0 + d.attitude) * sixth;
        state.rate += (a.rate + (b.rate + c.rate) * 2.0 + d.rate) * sixth;
        for (wheel, h) in state.momentum.iter_mut().enumerate() {
            let inner = b.momentum[wheel] + c.momentum[wheel];
            *h += (a.momentum[wheel] + 2.0 * inner + d.momentum[wheel]) * sixth;
        }
        state.attitude /= state.attitude.norm();
    }

    fn slope(&self, state: &TrueState, motor: &[f64], slope: &mut StateDerivative) {
        let mut torque = self.disturbance - state.rate.cross(&self.body_momentum(state));
        for (wheel, rotor) in self.rotors.iter().enumerate().filter(|(_, r)| r.driven) {
            let h = state.momentum[wheel];
            let speed = h / rotor.inertia - rotor.axis.dot(&state.rate);
            let net = motor[wheel] - rotor.friction(speed);
            torque -= rotor.axis * net;
            slope.momentum[wheel] = net;
        }
        slope.rate = self.effective_inverse * torque;
        slope.attitude = state.attitude * Quaternion::from_imag(state.rate) * 0.5;
    }
}
