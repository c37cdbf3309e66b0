//! Points of a step at which a smooth quantity can have its maximum or minimum.

/// Greatest number of iterations of the bracketed search.
const MAX_ITERATIONS: usize = 60;

/// Width of the bracket, relative to the grid interval, at which the search ends. The error of the
/// value at an extremum is of the order of its square.
const WIDTH: f64 = 1e-9;

/// Calls `visit` with every grid point and every extremum between grid points, in order.
pub(super) fn critical_points(
    grid: &[f64],
    slope: impl Fn(f64) -> f64,
    mut visit: impl FnMut(f64),
) {
    let mut previous: Option<(f64, f64)> = None;
    for &here in grid {
        let slope_here = slope(here);
        if let Some((there, slope_there)) = previous
            && slope_here * slope_there < 0.0
        {
            visit(root((there, slope_there), (here, slope_here), &slope));
        }
        visit(here);
        previous = Some((here, slope_here));
    }
}

/// A zero between two points with values of opposite sign (regula falsi with the Illinois rule).
pub(super) fn root(
    (mut a, mut value_a): (f64, f64),
    (mut b, mut value_b): (f64, f64),
    function: impl Fn(f64) -> f64,
) -> f64 {
    let enough = WIDTH * (b - a).abs();
    for _ in 0..MAX_ITERATIONS {
        if (b - a).abs() <= enough || value_b == 0.0 {
            break;
        }
        let inside = (a * value_b - b * value_a) / (value_b - value_a);
        // Outside of the bracket by rounding, or because products of tiny values underflow.
        let next = if inside > a.min(b) && inside < a.max(b) {
            inside
        } else {
            0.5 * (a + b)
        };
        let value = function(next);
        let last = b;
        if value * value_b < 0.0 {
            (a, value_a) = (b, value_b);
        } else {
            value_a *= 0.5;
        }
        (b, value_b) = (next, value);
        // The bracket may shrink from one side only: a tiny change ends the search too.
        if (b - last).abs() <= enough {
            break;
        }
    }
    b
}

#[cfg(test)]
mod tests {
    use super::{critical_points, root};
    use std::cell::Cell;

    #[test]
    fn finds_the_peak_between_two_grid_points() {
        let mut best = f64::MIN;
        let height = |s: f64| 1.0 - (s - 0.37).powi(2);
        critical_points(
            &[0.0, 1.0],
            |s| 2.0 * (0.37 - s),
            |s| best = best.max(height(s)),
        );
        assert!((best - 1.0).abs() < 1e-15, "{best}");
    }

    #[test]
    fn finds_zeros_to_the_same_relative_width_in_under_thirty_evaluations() {
        for length in [1e-6, 1.0, 1e6] {
            for share in [0.01, 0.37, 0.5, 0.999] {
                let count = Cell::new(0);
                let function = |s: f64| {
                    count.set(count.get() + 1);
                    ((s - share * length) / length).sinh()
                };
                let zero = root((0.0, function(0.0)), (length, function(length)), function);
                let error = (zero - share * length).abs();
                assert!(error < 1e-8 * length, "{share} of {length}: {error}");
                assert!(
                    count.get() < 30,
                    "{share} of {length}: {} values",
                    count.get()
                );
            }
        }
    }

    #[test]
    fn stays_in_the_bracket_for_subnormal_values_and_for_a_step_function() {
        for scale in [1e-310, 1e-200] {
            let function = |s: f64| scale * (s - 0.3);
            let looked = |s: f64| {
                assert!((0.0..=1.0).contains(&s), "{s}");
                function(s)
            };
            let zero = root((0.0, function(0.0)), (1.0, function(1.0)), looked);
            assert!((zero - 0.3).abs() < 1e-3, "{zero}");
        }
        let step = |s: f64| {
            assert!((2.0..=5.0).contains(&s), "{s}");
            if s < 3.0 { -f64::MAX } else { f64::MAX }
        };
        let zero = root((2.0, step(2.0)), (5.0, step(5.0)), step);
        assert!((2.0..=5.0).contains(&zero), "{zero}");
    }

    #[test]
    fn finds_the_zero_of_a_steep_function() {
        let function = |s: f64| (s - 0.1).powi(9) + 1e-3 * (s - 0.1);
        let zero = root((0.0, function(0.0)), (3.0, function(3.0)), function);
        assert!((zero - 0.1).abs() < 1e-7, "{zero}");
    }
}
