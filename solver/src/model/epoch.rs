//! The epoch of a scenario: a calendar date and time in the scenario's time system.

use jiff::civil::DateTime;

/// The form of an epoch, for descriptions.
pub const PATTERN: &str = r"^[0-9]{4}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])T([01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9](\.[0-9]{1,9})?Z?$";
/// The part that every epoch has; `0` stands for a digit.
const SHAPE: &[u8] = b"0000-00-00T00:00:00";

/// Reads `YYYY-MM-DDThh:mm:ss` with a fraction of at most nine digits or `Z` or both or none, which is
/// what ISO 8601, RFC 3339 and calendar dates of CCSDS have in common.
#[must_use]
pub fn parse(text: &str) -> Option<DateTime> {
    let whole = text.get(..SHAPE.len())?;
    let shaped = whole.bytes().zip(SHAPE).all(|(byte, shape)| match shape {
        b'0' => byte.is_ascii_digit(),
        other => byte == *other,
    });
    // The library takes a leap second for the one before; days have 86,400 s here.
    let counted = shaped && !whole.ends_with("60");
    let rest = &text[SHAPE.len()..];
    let rest = rest.strip_suffix('Z').unwrap_or(rest);
    let fraction = match rest.strip_prefix('.') {
        Some(digits) => {
            (1..=9).contains(&digits.len()) && digits.bytes().all(|d| d.is_ascii_digit())
        }
        None => rest.is_empty(),
    };
    // Without Z, which the library wants to have a time zone for.
    (counted && fraction).then(|| text.trim_end_matches('Z').parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::civil::date;

    #[test]
    fn dates_with_times_are_read_to_the_nanosecond() {
        let noon = date(2026, 1, 31).at(12, 0, 0, 0);
        for text in [
            "2026-01-31T12:00:00",
            "2026-01-31T12:00:00Z",
            "2026-01-31T12:00:00.000Z",
        ] {
            assert_eq!(parse(text), Some(noon), "{text}");
        }
        let last = date(2024, 2, 29).at(23, 59, 59, 123_456_789);
        assert_eq!(parse("2024-02-29T23:59:59.123456789"), Some(last));
    }

    #[test]
    fn everything_else_is_refused() {
        for wrong in [
            "",
            "soon",
            "2026-05-05",
            "2026-05-05 12:00",
            "2026-05-05 12:00:00",
            "2026-05-05T12:00",
            "2026-05-05t12:00:00",
            "2026-5-5T12:00:00",
            "2026-13-01T00:00:00",
            "2026-02-29T00:00:00",
            "2026-01-01T24:00:00",
            "2026-12-31T23:59:60",
            "2026-01-01T00:00:00.",
            "2026-01-01T00:00:00.1234567890",
            "2026-01-01T00:00:00ZZ",
            "2026-01-01T00:00:00+01:00",
            "2026-01-01T00:00:00[UTC]",
            "2026-01-01T00:00:+1",
            "12026-01-01T00:00:00",
            "20260101T000000",
            "2026-01-01T00:00:0\u{e9}",
        ] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
