//! Wall-clock time of records: whole microseconds since 1970, and its text.

use jiff::Timestamp;
use std::time::{SystemTime, UNIX_EPOCH};

/// Now, microseconds since 1970-01-01 UTC.
#[expect(clippy::disallowed_methods, reason = "the one clock of records")]
pub(crate) fn now_us() -> i64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .ok()
        .and_then(|since| i64::try_from(since.as_micros()).ok())
        .unwrap_or(0)
}

/// RFC 3339 in UTC with microseconds. Times beyond the years -9999 to 9999 become the nearest there.
pub(crate) fn rfc3339(time_us: i64) -> String {
    let nearest = if time_us < 0 {
        Timestamp::MIN
    } else {
        Timestamp::MAX
    };
    let time = Timestamp::from_microsecond(time_us).unwrap_or(nearest);
    format!("{time:.6}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_moments_have_their_calendar_dates() {
        let cases = [
            (0, "1970-01-01T00:00:00.000000Z"),
            (951_782_400_000_000, "2000-02-29T00:00:00.000000Z"),
            (1_767_225_599_999_999, "2025-12-31T23:59:59.999999Z"),
            (4_107_542_400_000_000, "2100-03-01T00:00:00.000000Z"),
        ];
        for (time_us, text) in cases {
            assert_eq!(rfc3339(time_us), text);
        }
    }
}
