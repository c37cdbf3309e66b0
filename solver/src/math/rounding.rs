//! Rounding of the numbers that identify a problem, so that the last digits of a caller's unit
//! conversions do not matter.

/// Numbers are rounded to this many units of their scale: far below every tolerance and far above
/// the rounding of conversions.
const RESOLUTION: f64 = 1e13;

/// A number rounded relative to a scale, the typical size of numbers like it.
pub(crate) fn rounded(number: f64, scale: f64) -> f64 {
    if scale == 0.0 {
        return number;
    }
    // A power of two, so that scaling itself does not round.
    let size = scale.log2().ceil().exp2();
    // Adding zero turns -0 into 0.
    (number / size * RESOLUTION).round() / RESOLUTION * size + 0.0
}

/// Turn, rad, that rounding may add without adding a part.
const SAME_TURN: f64 = 1e-9;

/// Into how many parts a turn is cut so that none is longer than `longest`; at most `most`.
pub(crate) fn parts_of(turn: f64, longest: f64, most: usize) -> usize {
    if longest == f64::INFINITY {
        return 0;
    }
    let enough = |parts: &usize| *parts as f64 * longest >= turn - SAME_TURN;
    (0..most).find(enough).unwrap_or(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_digits_are_rounded() {
        for scale in [1e-20, 0.3, 1.0, 7e8] {
            for share in [0.0, 0.1, -0.7, 1.0] {
                let number = share * scale;
                let kept = rounded(number, scale);
                assert!(
                    (kept - number).abs() <= 1e-13 * scale,
                    "{number} of {scale}"
                );
                assert_eq!(rounded(kept, scale).to_bits(), kept.to_bits());
                assert_eq!(
                    rounded(number + 1e-16 * scale, scale).to_bits(),
                    kept.to_bits()
                );
                assert!(rounded(number + 1e-11 * scale, scale) > kept);
            }
            assert_eq!(rounded(-1e-17 * scale, scale).to_bits(), 0);
        }
        assert_eq!(rounded(3.0, 0.0).to_bits(), 3.0_f64.to_bits());
    }
}
