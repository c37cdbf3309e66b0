//! From a motion in physical units to the program's scaled variables, and back.

use super::Program;
use crate::model::attitude::Attitude;
use crate::nlp::{Chain, Iterate, Layout, Link};
use crate::slew::motion::SlewMotion;
use crate::slew::shape::{IntervalLengths, TorqueCourse};
use nalgebra::DVector;

impl Program {
    /// An iterate at a motion with as many intervals as the program, without multipliers.
    pub(in crate::slew) fn iterate_at(&self, motion: &SlewMotion) -> Iterate {
        let (shape, scales) = (&self.shape, &self.scales);
        let torque = scales.momentum / scales.time;
        let intervals = motion.lengths.len();
        let mean = motion.duration() / intervals as f64;
        let mut iterate = Iterate::cold(Vec::new(), Vec::new());
        for (node, (attitude, momenta)) in motion.attitudes.iter().zip(&motion.momenta).enumerate()
        {
            let points = &mut iterate.points;
            points.extend_from_slice(&attitude.xyzw());
            points.extend(momenta.iter().map(|h| h / scales.momentum));
            if shape.course == TorqueCourse::Ramps {
                points.extend(motion.node_torque(node).iter().map(|u| u / torque));
            }
            if shape.lengths == IntervalLengths::Shared {
                points.push(mean / scales.time);
            }
            if shape.clock {
                let passed: f64 = motion.lengths[..node].iter().sum();
                points.push(passed / scales.time);
            }
            if shape.energy_account {
                points.push(0.0);
            }
        }
        for k in 0..intervals {
            let controls = &mut iterate.controls;
            match shape.course {
                TorqueCourse::Steps => {
                    let change = &motion.momenta[k + 1] - &motion.momenta[k];
                    controls.extend(change.iter().map(|m| m / scales.momentum));
                }
                TorqueCourse::Ramps => {
                    controls.extend(motion.node_torque(k + 1).iter().map(|u| u / torque));
                }
            }
            if shape.lengths == IntervalLengths::Free {
                controls.push(motion.lengths[k] / scales.time);
            }
            if shape.slacks {
                controls.extend(std::iter::repeat_n(0.0, shape.wheels));
            }
        }
        self.fill_energies(&mut iterate);
        iterate
    }

    /// The motion of an iterate, in physical units.
    pub(in crate::slew) fn motion_of(&self, iterate: &Iterate) -> SlewMotion {
        let layout = Layout::of(self);
        let (shape, scales) = (&self.shape, &self.scales);
        let (wheels, torque) = (shape.wheels, scales.momentum / scales.time);
        let mut motion = SlewMotion {
            attitudes: Vec::new(),
            momenta: Vec::new(),
            lengths: Vec::new(),
            begin: Vec::new(),
            end: Vec::new(),
        };
        for node in 0..=self.intervals() {
            let link = iterate.link(&layout, node);
            let point = link.point;
            // Retraction keeps quaternions at unit length.
            let attitude = Attitude::from_xyzw([point[0], point[1], point[2], point[3]]);
            motion
                .attitudes
                .push(attitude.unwrap_or_else(Attitude::identity));
            let momenta = DVector::from_column_slice(&point[4..4 + wheels]);
            motion.momenta.push(momenta * scales.momentum);
            if !link.has_interval() {
                break;
            }
            let length = self.length(&link) * scales.time;
            let control = DVector::from_column_slice(&link.control[..wheels]);
            let (begin, end) = match shape.course {
                TorqueCourse::Steps => {
                    let constant = if length > 0.0 {
                        control * (scales.momentum / length)
                    } else {
                        DVector::zeros(wheels)
                    };
                    (constant.clone(), constant)
                }
                TorqueCourse::Ramps => {
                    let at = 1 + shape.torque_at();
                    let begin = DVector::from_column_slice(&point[at..at + wheels]);
                    (begin * torque, control * torque)
                }
            };
            motion.lengths.push(length.max(0.0));
            motion.begin.push(begin);
            motion.end.push(end);
        }
        motion
    }

    /// Energy of the motors over the motion of an iterate, J; negative energy of an interval counts as 0.
    pub(in crate::slew) fn energy_of(&self, iterate: &Iterate) -> f64 {
        let layout = Layout::of(self);
        let energy = |link: &Link<'_>| -> f64 {
            let wheels = self.wheels.iter().enumerate();
            let energies = wheels.map(|(i, w)| w.energy(&self.wheel_state(i, link)).value);
            energies.map(|energy| energy.max(0.0)).sum()
        };
        (0..self.base.intervals())
            .map(|node| energy(&iterate.link(&layout, node)))
            .sum()
    }

    /// Fills the slacks and the energy account of an iterate with the energies of its motion.
    fn fill_energies(&self, iterate: &mut Iterate) {
        if !self.cost_weights.uses_energy() {
            return;
        }
        let layout = Layout::of(self);
        let mut spent = 0.0;
        for node in 0..self.base.intervals() {
            let link = iterate.link(&layout, node);
            let energies: Vec<f64> = (0..self.shape.wheels)
                .map(|i| self.wheels[i].energy(&self.wheel_state(i, &link)).value)
                .collect();
            let length = self.length(&link) * self.scales.time;
            if self.shape.slacks {
                let at = layout.control(node).start + self.shape.slack_at();
                for (i, energy) in energies.iter().enumerate() {
                    iterate.controls[at + i] = energy.max(0.0) / self.units.energy;
                }
                let supplied = energies.iter().zip(&self.efficiency);
                spent += self.quiescent_power * length;
                spent += supplied.map(|(e, share)| e.max(0.0) / share).sum::<f64>();
            } else {
                spent += energies.iter().sum::<f64>();
            }
            if self.shape.energy_account {
                let at = layout.point(node + 1).start + 1 + self.shape.energy_account_at();
                iterate.points[at] = spent / self.units.energy;
            }
        }
    }
}
