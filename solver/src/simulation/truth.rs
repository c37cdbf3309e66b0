//! The body that is really flown: equations of motion with friction and an external torque.
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
//! `s` is the sign, but rises in proportion within a band of speed that one step could cross, so
//! that a wheel comes to rest instead of chattering. Steps are those of the classical Runge-Kutta
//! method of fourth order. The momenta of the wheels about their axes stand for their speeds: their
//! sum with the body's is conserved to rounding and to the order of the method.

use nalgebra::{Matrix3, Quaternion, Vector3};

/// A wheel as it really is.
#[derive(Debug, Clone)]
pub(super) struct Rotor {
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

/// Share of a band that Coulomb friction crosses in one step.
const BAND_PER_STEP: f64 = 0.25;

impl Rotor {
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

/// A rigid body with wheels, as it really is.
#[derive(Debug, Clone)]
pub(super) struct Truth {
    effective: Matrix3<f64>,
    effective_inverse: Matrix3<f64>,
    /// Momentum of the locked wheels relative to the body, body axes, N m s.
    locked: Vector3<f64>,
    pub(super) rotors: Vec<Rotor>,
    disturbance: Vector3<f64>,
}

/// The state at one moment.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) attitude: Quaternion<f64>,
    /// Body axes, rad/s.
    pub(super) rate: Vector3<f64>,
    /// `h_i`, N m s; of a locked wheel its part relative to the body.
    pub(super) momentum: Vec<f64>,
}

/// Derivatives of a state, and a state on the way.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    probe: State,
    slopes: [Slope; 4],
}

#[derive(Debug, Clone)]
struct Slope {
    attitude: Quaternion<f64>,
    rate: Vector3<f64>,
    momentum: Vec<f64>,
}

impl Scratch {
    pub(super) fn new(state: &State) -> Self {
        let slope = Slope {
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
pub(super) fn effective_inertia(inertia: &Matrix3<f64>, rotors: &[Rotor]) -> Matrix3<f64> {
    let driven = rotors.iter().filter(|rotor| rotor.driven);
    driven.fold(*inertia, |rest, rotor| {
        rest - rotor.axis * rotor.axis.transpose() * rotor.inertia
    })
}

impl Truth {
    /// A body with the inertia of the whole (kg m²), speeds at which wheels that are not driven are
    /// locked (rad/s, one per wheel) and an external torque (N m). `None` when `J_eff` has no inverse.
    pub(super) fn new(
        inertia: &Matrix3<f64>,
        rotors: Vec<Rotor>,
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
    ) -> State {
        let momentum = self.rotors.iter().zip(speed).map(|(rotor, speed)| {
            let with_body = if rotor.driven {
                rotor.axis.dot(&rate)
            } else {
                0.0
            };
            rotor.inertia * (speed + with_body)
        });
        State {
            attitude,
            rate,
            momentum: momentum.collect(),
        }
    }

    /// Speed of a wheel relative to the body, rad/s.
    pub(super) fn speed(&self, state: &State, wheel: usize) -> f64 {
        let rotor = &self.rotors[wheel];
        let absolute = state.momentum[wheel] / rotor.inertia;
        if rotor.driven {
            absolute - rotor.axis.dot(&state.rate)
        } else {
            absolute
        }
    }

    /// Total angular momentum in body axes, N m s.
    pub(super) fn body_momentum(&self, state: &State) -> Vector3<f64> {
        let wheels = self.rotors.iter().zip(&state.momentum);
        let driven = wheels.filter(|(rotor, _)| rotor.driven);
        driven.fold(
            self.effective * state.rate + self.locked,
            |sum, (rotor, h)| sum + rotor.axis * *h,
        )
    }

    /// Advances a state by so many steps of a length, s, with constant motor torques, N m.
    pub(super) fn advance(
        &self,
        state: &mut State,
        motor: &[f64],
        (step, steps): (f64, usize),
        scratch: &mut Scratch,
    ) {
        for _ in 0..steps {
            self.step(state, motor, step, scratch);
        }
    }

    fn step(&self, state: &mut State, motor: &[f64], step: f64, scratch: &mut Scratch) {
        let Scratch { probe, slopes } = scratch;
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

    fn slope(&self, state: &State, motor: &[f64], slope: &mut Slope) {
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
