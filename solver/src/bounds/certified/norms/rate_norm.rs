//! The Euclidean norm, where the norm of the rate has a limit.
//!
//! Its unit ball is no polytope and needs none: the least length of a turn is its angle, exactly. What a slew of a
//! duration covers is `int min(limit, b + a t, e + a (T - t)) dt` with the largest norms of the acceleration and of
//! the rates at both ends.

use super::facet_limits::Trapezoid;

/// Halvings of a duration.
const BISECTIONS: usize = 60;

/// The longest duration, s, in which a norm within such limits cannot cover an angle, rad.
pub(super) fn least_duration(angle: f64, limits: &Trapezoid) -> f64 {
    if angle <= 0.0 {
        return 0.0;
    }
    let covers = |duration: f64| limits.mean(duration) * duration >= angle;
    let mut low = angle / limits.most;
    let mut high = low;
    while !covers(high) {
        high *= 2.0;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if covers(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}
