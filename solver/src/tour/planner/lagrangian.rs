//! Costates at the passages of a tour, and legs with the Lagrangian terms of their boundary states.
//!
//! The free state of a passage is that of the wheels: costates belong to the wheel momenta, their unit is
//! s per N m s. A free roll has none; the bound holds without.

use super::tours::Tours;
use crate::leg::multiphase::solve_through;
use crate::leg::profile::Profile;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::nlp::NlpStatus;
use crate::tour::order::{Evaluation, PassageCostate, Place};
use nalgebra::DVector;

impl Tours<'_> {
    /// The costates at the targets between the legs of an order, from the solution of its tour.
    ///
    /// `None` when the resolution asks for polishing: Lagrangian legs are not polished, and an
    /// unpolished leg is longer than the bound may be.
    pub(super) fn flight_costates(&self, order: &[usize]) -> Option<Vec<PassageCostate>> {
        if self.places.resolution.polished {
            return None;
        }
        let route = self.places.route(order, true);
        let solutions = self.solve_route(&route);
        let mut costates = Vec::with_capacity(order.len());
        for (segment, places) in solutions.iter().zip(self.places.split(&route)) {
            segment.duration()?;
            // Nothing is free where a segment begins, and its costate has no effect.
            if !costates.is_empty() || places[0] != Place::Start {
                costates.push(vec![0.0; self.places.dynamics.wheel_count()]);
            }
            if segment.costates.len() + 2 != places.len() {
                return None;
            }
            costates.extend(segment.costates.iter().map(|p| p.as_slice().to_vec()));
        }
        (costates.len() + 2 == route.len()).then_some(costates)
    }

    /// Minimum over a leg's motions of its duration plus the costate terms of its boundary states,
    /// s. The initial guess is the leg with free ends.
    pub(super) fn solve_lagrangian_leg(
        &self,
        leg: [Place; 2],
        costates: [Option<&[f64]>; 2],
    ) -> Evaluation {
        let [from, to] = leg;
        let free = self.free_leg(from, to);
        let Some(free_s) = free.least_duration() else {
            return Evaluation::Unresolved;
        };
        let service = self.places.service_time(to);
        let [begin, end] = costates.map(|costate| costate.map(DVector::from_column_slice));
        // A motion of zero duration is no initial guess.
        let perturbed_eigenaxis = (self.perturbed_eigenaxis(leg), self.intervals(&leg));
        let motions = [(free.profile, free.intervals), perturbed_eigenaxis].into_iter();
        for (motion, intervals) in motions.filter(|(motion, _)| motion.duration() > 0.0) {
            let mut waypoints = self.signed_waypoints(&leg, &motion, &intervals);
            waypoints[0].costates = begin.as_ref().map(|costate| -costate);
            waypoints[1].costates.clone_from(&end);
            self.legs.count_solve();
            let dynamics = &self.places.dynamics;
            let solution = solve_through(dynamics, &waypoints, &intervals, &motion, &|| {
                self.stop.reason()
            });
            if solution.status.is_interrupted() {
                return Evaluation::Stopped;
            }
            if solution.status == NlpStatus::Converged {
                let profile = &solution.profile;
                let ends = [profile.wheels.first(), profile.wheels.last()];
                let terms = waypoints.iter().zip(ends).filter_map(|(waypoint, wheels)| {
                    Some(waypoint.costates.as_ref()?.dot(wheels?))
                });
                return Evaluation::Value(profile.duration() + terms.sum::<f64>() + service);
            }
        }
        let reduction = [begin, end]
            .iter()
            .flatten()
            .map(|costate| self.max_term(costate))
            .sum::<f64>();
        Evaluation::Value(free_s - reduction + service)
    }

    /// The eigenaxis slew of a leg, perturbed off its axis.
    fn perturbed_eigenaxis(&self, leg: [Place; 2]) -> Profile {
        let ends = self.places.waypoints(&leg);
        self.places
            .slew(&ends[0], &ends[1])
            .perturbed_eigenaxis(Perturbation::Near)
    }

    /// Largest absolute value of the product of a costate and the wheel momenta, s; infinite where
    /// momenta are not limited.
    fn max_term(&self, costate: &DVector<f64>) -> f64 {
        let dynamics = &self.places.dynamics;
        let rate = dynamics.reachable_rates().norm();
        let wheels = dynamics.actuators.iter().zip(costate);
        let of_wheel = wheels
            .filter(|(_, costate)| **costate != 0.0)
            .map(|(wheel, costate)| wheel.inertia * (wheel.max_speed + rate) * costate.abs());
        of_wheel.sum()
    }
}
