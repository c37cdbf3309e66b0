//! Format of numbers in messages.

/// A number with six significant digits, or in scientific notation below 1e-4 and from 1e9 on.
pub(super) fn figure(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e9).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    // From 0 to 9, by the range above.
    let mut decimals = 5_usize;
    let mut bound = 10.0;
    while magnitude >= bound && decimals > 0 {
        bound *= 10.0;
        decimals -= 1;
    }
    let mut bound = 1.0;
    while magnitude < bound {
        bound *= 0.1;
        decimals += 1;
    }
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::figure;

    #[test]
    fn six_digits_at_every_magnitude() {
        let cases = [
            (0.0, "0"),
            (710.0, "710"),
            (-467.912_345_6, "-467.912"),
            (0.001_234_567_8, "0.00123457"),
            (123_456_789.0, "123456789"),
            (2.5e-8, "2.500e-8"),
            (3e12, "3.000e12"),
            (1.0, "1"),
        ];
        for (value, text) in cases {
            assert_eq!(figure(value), text);
        }
    }
}
