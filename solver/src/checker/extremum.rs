//! Points of a step at which a smooth quantity can be largest or smallest.

/// Iterations of the bracketed search; each at least keeps the bracket, most gain digits.
const MAX_ITERATIONS: usize = 60;

/// Width of the bracket, relative to the grid interval, at which the search ends. The value at
/// an extremum is then off by its square.
const WIDTH: f64 = 1e-9;

/// Shows every grid point and every extremum between grid points to `visit`, in order.
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
        // Rounding, or slopes so small that their products vanish.
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
        // The Illinois rule converges from one side; a tiny move is the end too.
        if (b - last).abs() <= enough {
            break;
        }
    }
    b
}

#[cfg(test)]
mod tests {
    use super::{critical_points, root};

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
    fn finds_the_zero_of_a_steep_function() {
        let function = |s: f64| (s - 0.1).powi(9) + 1e-3 * (s - 0.1);
        let zero = root((0.0, function(0.0)), (3.0, function(3.0)), function);
        assert!((zero - 0.1).abs() < 1e-7, "{zero}");
    }
}
