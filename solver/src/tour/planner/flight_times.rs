//! Times of the legs of a solved tour.

use super::tours::Tours;

impl Tours<'_> {
    /// Times of the legs of the tour of an order, s, each with the service at its end; `None` where the
    /// tour is not solved.
    pub(super) fn flight_leg_times(&self, order: &[usize]) -> Option<Vec<f64>> {
        let route = self.places.route(order, true);
        let mut times = Vec::with_capacity(route.len());
        for segment in self.solve_route(&route) {
            segment.duration()?;
            let mut lengths = segment.profile.lengths.iter();
            for &intervals in &segment.intervals {
                let leg: f64 = lengths.by_ref().take(intervals).sum();
                times.push(leg + self.places.service_time(*route.get(times.len() + 1)?));
            }
        }
        (times.len() + 1 == route.len()).then_some(times)
    }
}
