//! Costates: the multipliers at the nodes, integrated by the costate equations in between.

use super::{OptimalityTest, cost::RunningCost};
use crate::slew::flow::MotionSample;
use nalgebra::{DVector, Vector3};

/// Integration steps of the costates per interval; the conditions are evaluated at their ends.
pub(super) const PARTS: usize = 8;

/// The costates at one time.
#[derive(Debug, Clone)]
pub(super) struct Costate {
    /// `p`, unit of the objective per rad, body axes.
    pub(super) attitude: Vector3<f64>,
    /// `r`, per N m s.
    pub(super) momenta: DVector<f64>,
    /// `p_t`, per s.
    pub(super) time: f64,
}

impl Costate {
    fn moved(&self, by: f64, slope: &Self) -> Self {
        Self {
            attitude: self.attitude + slope.attitude * by,
            momenta: &self.momenta + &slope.momenta * by,
            time: self.time + slope.time * by,
        }
    }
}

impl OptimalityTest<'_> {
    /// The costates at the end of an interval: the multipliers of its link in physical units.
    pub(super) fn end_costate(&self, k: usize) -> Costate {
        let program = self.program();
        let lambda = &self.solved.iterate.lambda[self.layout.link(k)];
        let unit = program.units.cost;
        let wheels = program.shape.wheels;
        let time = if self.slew.vehicle().speed_law_wheels.any_drift() {
            let per_second = unit / program.scales.time;
            (lambda[program.shape.clock_at()] - self.duration_multiplier()) * per_second
        } else {
            0.0
        };
        Costate {
            attitude: Vector3::from_column_slice(&lambda[..3]) * (unit / program.scales.angle),
            momenta: DVector::from_column_slice(&lambda[3..3 + wheels])
                * (unit / program.scales.momentum),
            time,
        }
    }

    /// The multiplier of the condition on the clock at the end, scaled; zero where the duration is free.
    fn duration_multiplier(&self) -> f64 {
        let row = self.program().clock_end_row();
        let at = |row: usize| self.layout.equality(self.layout.intervals).start + row;
        row.map_or(0.0, |row| self.solved.iterate.nu[at(row)])
    }

    /// Costates at the ends of equal parts of an interval, integrated backwards from its end.
    pub(super) fn costates(
        &self,
        k: usize,
        samples: &[MotionSample],
        running: &RunningCost<'_>,
    ) -> Vec<Costate> {
        let step = -self.solved.motion.lengths[k] / PARTS as f64;
        let mut costates = vec![self.end_costate(k)];
        for part in (0..PARTS).rev() {
            let from = costates[costates.len() - 1].clone();
            let [first, middle, last] = [2, 1, 0].map(|i| &samples[2 * part + i]);
            let a = slope(&from, first, running);
            let b = slope(&from.moved(0.5 * step, &a), middle, running);
            let c = slope(&from.moved(0.5 * step, &b), middle, running);
            let d = slope(&from.moved(step, &c), last, running);
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
}

/// Time derivatives of the costates.
fn slope(p: &Costate, at: &MotionSample, running: &RunningCost<'_>) -> Costate {
    let dynamics = running.dynamics();
    // The running cost depends on attitude, momenta and time through the wheels' speeds.
    let wheels = 0..at.speeds.len();
    let by_speed: Vec<f64> = wheels.map(|wheel| running.by_speed(wheel, at)).collect();
    let mut lever = p.attitude;
    for (wheel, slope) in dynamics.actuators.iter().zip(&by_speed) {
        lever -= wheel.axis * *slope;
    }
    let onto_controls = dynamics.inertia_inverse.tr_mul(&lever);
    let momenta = dynamics.actuators.iter().zip(&by_speed);
    Costate {
        attitude: at.stored.cross(&onto_controls) - at.rate.cross(&p.attitude),
        momenta: DVector::from_iterator(
            by_speed.len(),
            momenta.map(|(wheel, slope)| wheel.axis.dot(&onto_controls) - slope / wheel.inertia),
        ),
        time: onto_controls.dot(&at.drift_rate),
    }
}
