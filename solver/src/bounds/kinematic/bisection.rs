//! The end of a range, by doubling and halving.

/// Halvings, enough to reach rounding.
const HALVINGS: usize = 60;

/// The end of the numbers from `from` on for which something holds, from below and to rounding; `from` itself
/// where it holds for none beyond. It holds for all numbers before one for which it holds, and ends somewhere. The
/// first step should be of the order of the range.
pub(crate) fn last_where(from: f64, mut step: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let mut low = from;
    while holds(from + step) {
        low = from + step;
        step *= 2.0;
    }
    let mut high = from + step;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_range_is_found_from_below() {
        for (from, step, end) in [(0.0, 1.0, 10.0), (2.0, 1e-3, 3.5), (2.0, 50.0, 3.5)] {
            let found = last_where(from, step, |x| x < end);
            assert!(found < end && end - found < 1e-12, "{found} of {end}");
        }
        assert!((last_where(4.0, 1.0, |_| false) - 4.0).abs() < 1e-15);
    }
}
