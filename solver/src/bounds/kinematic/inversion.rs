//! The inverse of an increasing function, from below.

/// Width of the interval in which the result lies, relative to its upper end: a few times the rounding of the
/// functions.
const WIDTH: f64 = 1e-14;
/// Steps that may be lost to secants that do not help, beyond those of bisection.
const SPARE: f64 = 1.0;

/// The largest number from `from` on for which a nondecreasing function is below a level, from below and to
/// rounding; `from` itself where it is not. The function reaches the level somewhere, and the first step should be
/// of the order of the distance to there.
///
/// The interval is found by doubling and narrowed by the method of Oliveira and Takahashi ("An enhancement of the
/// bisection method average performance preserving minmax optimality", 2020): the secant, moved towards the middle,
/// and no further from it than what keeps the number of steps to that of bisection.
pub(crate) fn last_below(
    from: f64,
    mut step: f64,
    level: f64,
    function: impl Fn(f64) -> f64,
) -> f64 {
    let (mut low, mut short) = (from, level - function(from));
    if short <= 0.0 {
        return from;
    }
    let (mut high, mut beyond) = loop {
        let (at, value) = (from + step, function(from + step));
        if value < level {
            (low, short) = (at, level - value);
        } else {
            break (at, value - level);
        }
        step *= 2.0;
    };
    let tolerance = 0.5 * WIDTH * high.abs();
    let steps = (0.5 * (high - low) / tolerance).log2().ceil();
    // Half the width that is left to every step, so that bisection would still end in time.
    let mut allowed = tolerance * (steps + SPARE).exp2();
    let towards_middle = 0.2 / (high - low);
    while high - low > 2.0 * tolerance {
        let width = high - low;
        let middle = 0.5 * (low + high);
        let secant = low + width * (short / (short + beyond));
        let aside = middle - secant;
        let moved = (towards_middle * width * width).max(tolerance);
        let moved = secant + moved.min(aside.abs()).copysign(aside);
        let radius = (allowed - 0.5 * width).max(0.0);
        allowed *= 0.5;
        let at = middle - (middle - moved).max(-radius).min(radius);
        let value = function(at);
        if value < level {
            (low, short) = (at, level - value);
        } else {
            (high, beyond) = (at, value - level);
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn the_inverse_is_found_from_below_in_few_steps() {
        let functions: [fn(f64) -> f64; 4] = [
            |x| x,
            |x| x * x * x,
            |x| x.min(1.0) + 1e-3 * x,
            |x| x.max(3.0) + (x - 3.0).max(0.0).powi(2),
        ];
        for (number, function) in functions.iter().enumerate() {
            for (from, step, end) in [(0.0, 1.0, 10.0), (2.0, 1e-3, 3.5), (2.0, 50.0, 3.5)] {
                let evaluated = Cell::new(0_u32);
                let found = last_below(from, step, function(end), |x| {
                    evaluated.set(evaluated.get() + 1);
                    function(x)
                });
                assert!(
                    found < end && end - found < 1e-12,
                    "{found} of {end}, {number}"
                );
                let doubled = ((end - from) / step).max(1.0).log2();
                let steps = f64::from(evaluated.get()) - doubled;
                assert!(steps < 32.0, "{steps} steps for {number}");
            }
        }
        assert!((last_below(4.0, 1.0, 4.0, |x| x) - 4.0).abs() < 1e-15);
    }

    #[test]
    fn a_jump_takes_no_more_steps_than_bisection() {
        let evaluated = Cell::new(0);
        let found = last_below(0.0, 1.0, 1.0, |x| {
            evaluated.set(evaluated.get() + 1);
            if x < 0.7 { 0.0 } else { 1e9 }
        });
        assert!(found < 0.7 && 0.7 - found < 1e-13, "{found}");
        assert!(evaluated.get() < 55, "{} steps", evaluated.get());
    }
}
