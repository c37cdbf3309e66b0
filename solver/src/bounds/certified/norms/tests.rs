//! Closed forms of single legs, and what a motion covers.

use super::*;

#[test]
fn a_trapezoid_has_the_mean_of_its_parts() {
    let at_rest = Trapezoid {
        most: 2.0,
        slope: 1.0,
        ends: [0.0; 2],
    };
    // Up for 2 s, along for 6 s, down for 2 s.
    assert!((at_rest.mean(10.0) - 1.6).abs() < 1e-12);
    // A triangle.
    assert!((at_rest.mean(2.0) - 0.5).abs() < 1e-12);
    assert!((at_rest.mean(f64::INFINITY) - 2.0).abs() < 1e-12);
    let free = Trapezoid {
        ends: [0.0, f64::INFINITY],
        ..at_rest
    };
    assert!((free.mean(10.0) - 1.8).abs() < 1e-12);
    assert!((free.at(9.9, 10.0) - 2.0).abs() < 1e-12);
}

#[test]
fn a_norm_covers_an_angle_between_its_ramps() {
    let at_rest = Trapezoid {
        most: 2.0,
        slope: 1.0,
        ends: [0.0; 2],
    };
    // A coast of 3 s between ramps of 2 s, and a triangle.
    for (angle, duration) in [(10.0, 7.0), (0.25, 1.0)] {
        let found = rate_norm::least_duration(angle, &at_rest);
        assert!((found - duration).abs() < 1e-9, "{found} for {angle}");
    }
    let unlimited = Trapezoid {
        slope: f64::INFINITY,
        ..at_rest
    };
    assert!((rate_norm::least_duration(10.0, &unlimited) - 5.0).abs() < 1e-9);
    assert!(rate_norm::least_duration(-1.0, &unlimited).abs() < 1e-9);
}
