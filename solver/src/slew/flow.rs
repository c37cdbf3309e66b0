//! The motion between nodes, integrated from the torques: turns, momenta and excesses over limits.

use super::motion::SlewMotion;
use super::vehicle::Vehicle;
use crate::leg::kinematics::exact_flow;
use crate::leg::multiphase::{deepest, depths_inside, excess_inside};
use crate::leg::transcription::ConeDepth;
use crate::math::quaternion::{Quat, rotate_back};
use crate::model::attitude::Attitude;
use nalgebra::{DVector, Vector3};

/// Parts of an interval at whose ends the limits are evaluated; between them a parabola finds the
/// peak. With linear torque, 8 parts miss a peak near a node by 2e-5 of a rate limit.
const SAMPLES: usize = 32;

/// The motion at one time.
#[derive(Debug, Clone)]
pub(super) struct MotionSample {
    /// Attitude.
    pub(super) attitude: Attitude,
    /// Body rate, rad/s.
    pub(super) rate: Vector3<f64>,
    /// Total momentum in body axes, N m s.
    pub(super) stored: Vector3<f64>,
    /// Momenta of the commanded wheels, N m s.
    pub(super) momenta: DVector<f64>,
    /// Their speeds relative to the body, rad/s.
    pub(super) speeds: Vec<f64>,
    /// Their commanded torques, N m.
    pub(super) torques: DVector<f64>,
    /// Rate of change of the momentum of the speed-law wheels, body axes, N m.
    pub(super) drift_rate: Vector3<f64>,
}

/// Excesses over limits between nodes.
pub(super) struct Excesses {
    /// Relative, over the limits of [`Dynamics::limit_shares`](crate::model::dynamics::Dynamics::limit_shares),
    /// interval by interval, where the peak inside is larger than at both ends.
    pub(super) shares: Vec<f64>,
    /// Relative, over the motor torques, one per interval.
    pub(super) torques: Vec<f64>,
    /// Depths inside cones, rad, interval by interval.
    pub(super) depths: Vec<ConeDepth>,
}

impl Excesses {
    /// The greatest relative excess; zero where no limit is exceeded.
    pub(super) fn greatest(&self) -> f64 {
        let all = self.shares.iter().chain(&self.torques);
        all.copied().fold(0.0, f64::max)
    }

    /// The greatest depth inside a cone, rad.
    pub(super) fn depth(&self) -> f64 {
        deepest(&self.depths)
    }
}

impl Vehicle {
    /// Wheel momenta at the share `s` of an interval, N m s.
    fn momenta(motion: &SlewMotion, k: usize, s: f64) -> DVector<f64> {
        let length = motion.lengths[k];
        let (begin, end) = (&motion.begin[k], &motion.end[k]);
        &motion.momenta[k] + begin * (length * (s - 0.5 * s * s)) + end * (length * 0.5 * s * s)
    }

    /// Body rate, rad/s, at a time, s, for the total momentum in body axes and the wheels' momenta, N m s.
    fn rate(&self, momentum: &Vector3<f64>, wheels: &DVector<f64>, time: f64) -> Vector3<f64> {
        let dynamics = &self.dynamics;
        let held = dynamics.locked_momentum + self.speed_law_wheels.drift(time)[0];
        dynamics.inertia_inverse * (momentum - held - &dynamics.axes * wheels)
    }

    /// The turn over the part of an interval from one share of its length to another; the interval
    /// begins at `time`, s, the part in the attitude `q`.
    fn turn(
        &self,
        motion: &SlewMotion,
        k: usize,
        time: f64,
        [from, to]: [f64; 2],
        q: &Attitude,
    ) -> Quat {
        let length = motion.lengths[k];
        let momentum = q.to_body(self.dynamics.momentum);
        exact_flow(|sigma, p| {
            let s = from + (to - from) * sigma;
            let momentum = rotate_back(p, &momentum);
            let wheels = Self::momenta(motion, k, s);
            self.rate(&momentum, &wheels, time + length * s) * (length * (to - from))
        })
    }

    /// The exact turn over every interval, from its first node.
    pub(super) fn turns(&self, motion: &SlewMotion) -> Vec<Quat> {
        let times = motion.times();
        (0..motion.lengths.len())
            .map(|k| self.turn(motion, k, times[k], [0.0, 1.0], &motion.attitudes[k]))
            .collect()
    }

    /// The motion at both ends of an interval and between its equal parts; the interval begins at
    /// `begin`, s.
    pub(super) fn samples(
        &self,
        motion: &SlewMotion,
        k: usize,
        begin: f64,
        parts: usize,
    ) -> Vec<MotionSample> {
        let at = |i: usize| i as f64 / parts as f64;
        let mut attitude = motion.attitudes[k];
        let mut samples = Vec::with_capacity(parts + 1);
        for i in 0..=parts {
            if i > 0 {
                let turn = self.turn(motion, k, begin, [at(i - 1), at(i)], &attitude);
                attitude =
                    Attitude::from_xyzw(turn).map_or(attitude, |turn| attitude.then_in_body(&turn));
            }
            let s = at(i);
            let momenta = Self::momenta(motion, k, s);
            let stored = attitude.to_body(self.dynamics.momentum);
            let rate = self.rate(&stored, &momenta, begin + motion.lengths[k] * s);
            let actuators = self.dynamics.actuators.iter().zip(momenta.iter());
            let speeds = actuators.map(|(wheel, h)| h / wheel.inertia - wheel.axis.dot(&rate));
            samples.push(MotionSample {
                attitude,
                speeds: speeds.collect(),
                torques: &motion.begin[k] * (1.0 - s) + &motion.end[k] * s,
                drift_rate: self.speed_law_wheels.drift(begin + motion.lengths[k] * s)[1],
                stored,
                rate,
                momenta,
            });
        }
        samples
    }

    /// The excesses over limits inside the intervals of a motion.
    pub(super) fn excesses(&self, motion: &SlewMotion) -> Excesses {
        let times = motion.times();
        let (mut shares, mut torques, mut depths) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..motion.lengths.len() {
            let samples = self.samples(motion, k, times[k], SAMPLES);
            let usages: Vec<Vec<f64>> = samples
                .iter()
                .map(|at| self.dynamics.limit_shares(&at.rate, &at.momenta).collect())
                .collect();
            for share in 0..usages[0].len() {
                let series: Vec<f64> = usages.iter().map(|usage| usage[share]).collect();
                shares.push(excess_inside(&series));
            }
            let motors: Vec<f64> = samples.iter().map(|at| self.motor_usage(at)).collect();
            torques.push(excess_inside(&motors));
            let attitudes: Vec<Attitude> = samples.iter().map(|at| at.attitude).collect();
            depths.extend(depths_inside(&self.dynamics.cones, &attitudes));
        }
        Excesses {
            shares,
            torques,
            depths,
        }
    }

    /// The greatest motor torque as a share of its limit.
    fn motor_usage(&self, at: &MotionSample) -> f64 {
        let motors = self.drives.iter().zip(at.torques.iter()).zip(&at.speeds);
        let torques = motors.map(|((drive, torque), speed)| drive.motor_torque(*torque, *speed));
        self.dynamics
            .torque_usage(&DVector::from_iterator(at.speeds.len(), torques))
    }
}
