//! Tolerances within which a flight meets its scenario.
//!
//! The checker accepts a flight within them, and certified bounds give them away, so that no flight
//! that passes is faster than its bound.

/// Largest angle, rad, by which a target or the end may be missed: 0.2 arc seconds, well below
/// what any attitude sensor resolves, well above the error of the integration.
pub const ATTITUDE_TOLERANCE: f64 = 1e-6;

/// Largest error of a required body rate component, rad/s: over ten seconds it turns the
/// spacecraft by no more than the attitude tolerance.
pub const RATE_TOLERANCE: f64 = 1e-7;

/// Largest excess over a limit, relative to the limit: of the order of an optimiser's rounding.
pub const LIMIT_TOLERANCE: f64 = 1e-6;

/// Largest error of a prescribed final wheel speed, relative to the wheel's speed limit or,
/// without one, to the fastest wheel.
pub const END_SPEED_TOLERANCE: f64 = 1e-6;

/// Largest difference of times, relative to the duration of the flight: times written with ten digits
/// pass.
pub const TIME_TOLERANCE: f64 = 1e-9;

/// Largest torque during settle and dwell, relative to the wheel's limit, that counts as zero.
pub const REST_TORQUE_TOLERANCE: f64 = 1e-9;
