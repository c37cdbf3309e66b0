//! The Euclidean norm, where the norm of the rate has a limit.
//!
//! Its unit ball is no polytope and needs none: the least length of a turn is its angle, exactly. What a slew of a
//! duration covers is `int min(limit, b + a t, e + a (T - t)) dt` with the largest norms of the acceleration and of
//! the rates at both ends.

use crate::bounds::kinematic::inversion::last_below;
use crate::bounds::polytope::trapezoid::Trapezoid;

/// The longest duration, s, in which a norm within such limits cannot cover an angle, rad.
pub(super) fn least_duration(angle: f64, limits: &Trapezoid) -> f64 {
    if angle <= 0.0 {
        return 0.0;
    }
    last_below(0.0, angle / limits.most, angle, |duration| {
        limits.integral(duration)
    })
}
