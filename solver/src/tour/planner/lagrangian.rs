//! Prices on the states in which targets are passed, and legs that pay them.
//!
//! The attitude at a target is given, so the state in which it is passed is that of the wheels: the
//! price is on their momenta, and its unit s per N m s.

use super::interruption;
use super::tours::Tours;
use crate::leg::multiphase::solve_through;
use crate::leg::profile::Profile;
use crate::leg::solve::eigenaxis::Perturbation;
use crate::nlp::NlpStatus;
use crate::tour::order::{Evaluation, Place, Price};
use nalgebra::DVector;

impl Tours<'_> {
    /// The prices at the targets between the legs of an order by its flight.
    ///
    /// None with a resolution that polishes: a lagrangian leg is not polished, and as a bound would be
    /// too long by what that gains.
    pub(super) fn prices_of(&self, order: &[usize]) -> Option<Vec<Price>> {
        if self.places.resolution.polished {
            return None;
        }
        let route = self.places.route(order, true);
        let flown = self.fly_route(&route);
        let mut prices = Vec::with_capacity(order.len());
        for (segment, places) in flown.iter().zip(self.split(&route)) {
            segment.duration()?;
            // Where a segment begins, nothing is free.
            if !prices.is_empty() || places[0] != Place::Start {
                prices.push(vec![0.0; self.places.dynamics.wheel_count()]);
            }
            if segment.costates.len() + 2 != places.len() {
                return None;
            }
            prices.extend(segment.costates.iter().map(|p| p.as_slice().to_vec()));
        }
        (prices.len() + 2 == route.len()).then_some(prices)
    }

    /// The least of a leg's duration and what its ends cost, s: from its motion with free ends.
    pub(super) fn price_leg(&self, leg: [Place; 2], prices: [Option<&[f64]>; 2]) -> Evaluation {
        let [from, to] = leg;
        let free = self.free_leg(from, to);
        let Some(free_s) = free.least_duration() else {
            return Evaluation::Unresolved;
        };
        let service = self.places.service_time(to);
        let [begin, end] = prices.map(|price| price.map(DVector::from_column_slice));
        // What takes no time says nothing of how to use some.
        let perturbed_eigenaxis = (self.perturbed_eigenaxis(leg), self.intervals(&leg));
        let motions = [(free.profile, free.intervals), perturbed_eigenaxis].into_iter();
        for (motion, intervals) in motions.filter(|(motion, _)| motion.duration() > 0.0) {
            let mut waypoints = self.program(&leg, &motion, &intervals);
            waypoints[0].costates = begin.as_ref().map(|price| -price);
            waypoints[1].costates.clone_from(&end);
            self.legs.count_solve();
            let dynamics = &self.places.dynamics;
            let flown = solve_through(dynamics, &waypoints, &intervals, &motion, &|| {
                interruption(self.stop)
            });
            if flown.status.is_interrupted() {
                return Evaluation::Stopped;
            }
            if flown.status == NlpStatus::Converged {
                let profile = &flown.profile;
                let ends = [profile.wheels.first(), profile.wheels.last()];
                let costs = waypoints.iter().zip(ends).filter_map(|(waypoint, wheels)| {
                    Some(waypoint.costates.as_ref()?.dot(wheels?))
                });
                return Evaluation::Value(profile.duration() + costs.sum::<f64>() + service);
            }
        }
        let most = [begin, end]
            .iter()
            .flatten()
            .map(|price| self.most(price))
            .sum::<f64>();
        Evaluation::Value(free_s - most + service)
    }

    /// The slew about the eigenaxis, perturbed_eigenaxis.
    fn perturbed_eigenaxis(&self, leg: [Place; 2]) -> Profile {
        let [from, to] = leg.map(|place| self.places.waypoint(place));
        self.places
            .slew(&from, &to)
            .perturbed_eigenaxis(Perturbation::Near)
    }

    /// The most that a price can pay, s; infinite where momenta are not limited.
    fn most(&self, price: &DVector<f64>) -> f64 {
        let dynamics = &self.places.dynamics;
        let rate = dynamics.reachable_rates().norm();
        let wheels = dynamics.actuators.iter().zip(price);
        let of_wheel = wheels
            .filter(|(_, price)| **price != 0.0)
            .map(|(wheel, price)| wheel.inertia * (wheel.max_speed + rate) * price.abs());
        of_wheel.sum()
    }
}
