//! Numbers for people: no sign of a zero, no exponent where none is needed.

use slewplan_solver::checker::NOT_COMPUTED;

/// Shares in per cent from this size on are written with an exponent.
const LARGEST_IN_DIGITS: f64 = 1e6;

/// A number in words where it could not be computed.
pub(super) fn computed(value: f64, written: impl FnOnce(f64) -> String) -> String {
    if value.abs() >= NOT_COMPUTED {
        "not computed".to_owned()
    } else {
        written(value)
    }
}

/// A number with so many decimals.
pub(super) fn decimals(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    // A zero has no sign, whatever was rounded to it.
    let is_zero = !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    match text.strip_prefix('-') {
        Some(zero) if is_zero => zero.to_owned(),
        _ => text,
    }
}

/// A share in per cent. What exceeds a limit many times over is not written out in digits.
pub(super) fn percent(share: f64, digits: usize) -> String {
    let percent = share * 100.0;
    if percent.abs() < LARGEST_IN_DIGITS {
        format!("{} %", decimals(percent, digits))
    } else {
        format!("{percent:.1e} %")
    }
}

/// A difference in per cent, with its sign.
pub(super) fn difference(share: f64, digits: usize) -> String {
    let text = percent(share, digits);
    let is_positive = share > 0.0 && text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if is_positive {
        format!("+{text}")
    } else {
        text
    }
}

/// An error or excess, most often far below one.
pub(super) fn small(value: f64) -> String {
    computed(value, |value| {
        if value == 0.0 {
            "0".to_owned()
        } else {
            format!("{value:.1e}")
        }
    })
}

/// A number of any size with four digits that count.
pub(super) fn significant(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    // Six from a thousandth on, and one less for every power of ten.
    let (mut digits, mut bound) = (6_usize, 1e-2);
    while size >= bound && digits > 0 {
        digits -= 1;
        bound *= 10.0;
    }
    decimals(value, digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_have_neither_sign_nor_exponent() {
        assert_eq!(percent(-1e-9, 1), "0.0 %");
        assert_eq!(percent(-0.012, 1), "-1.2 %");
        assert_eq!([difference(-1e-9, 1), difference(1e-9, 1)], ["0.0 %"; 2]);
        assert_eq!(difference(0.02, 1), "+2.0 %");
        assert_eq!([small(0.0), small(-0.0)], ["0", "0"]);
        assert_eq!(small(2.5e-9), "2.5e-9");
        assert_eq!(small(NOT_COMPUTED), "not computed");
    }

    #[test]
    fn four_digits_count_at_every_size() {
        let found = [0.0, 12.345_67, 0.012_345, 123_456.0, 1e-7, -2.5].map(significant);
        let expected = ["0", "12.35", "0.01235", "123456", "1.000e-7", "-2.500"];
        assert_eq!(found, expected);
    }
}
