//! The scenario's epoch, and times after it, as text.
//!
//! Days have 86,400 s here. Where a plan runs through a leap second of UTC, label its epoch in TAI.

use super::ExportError;
use jiff::civil::{DateTime, date};
use slewplan_solver::model::scenario::Scenario;
use std::str::FromStr;
use std::time::Duration;

/// The epoch of scenarios without one.
pub(super) const NO_EPOCH: &str = "2000-01-01T12:00:00";

/// A moment in the time system of a scenario, in the years -9999 to 9999.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CalendarTime(DateTime);

/// The epoch of a scenario, [`NO_EPOCH`] when it has none.
pub(super) fn epoch(scenario: &Scenario) -> Result<CalendarTime, ExportError> {
    let text = scenario.epoch().unwrap_or(NO_EPOCH);
    CalendarTime::parse(text).ok_or_else(|| ExportError::Label {
        pointer: "/epoch",
        what: format!("{text:?} is not of the form 2026-01-31T12:00:00.5 or with Z at its end"),
    })
}

/// The time system of a scenario, UTC when it has none.
pub(super) fn time_system(scenario: &Scenario) -> &str {
    scenario.time_system().unwrap_or("UTC")
}

/// The epoch for formats that know UTC only.
pub(super) fn utc_epoch(scenario: &Scenario, format: &str) -> Result<CalendarTime, ExportError> {
    match time_system(scenario) {
        "UTC" => epoch(scenario),
        other => Err(ExportError::Label {
            pointer: "/time_system",
            what: format!(
                "{format} counts in UTC and leap seconds are not known here: not {other:?}"
            ),
        }),
    }
}

impl CalendarTime {
    /// Reads `YYYY-MM-DDThh:mm:ss`, with a fraction or `Z` or both or none.
    fn parse(text: &str) -> Option<Self> {
        let text = text.strip_suffix(['Z', 'z']).unwrap_or(text);
        let (date, time) = text.split_once(['T', 't', ' '])?;
        let mut date = date.splitn(3, '-');
        let (year, month, day) = (date.next()?, date.next()?, date.next()?);
        let (time, fraction) = time.split_once('.').unwrap_or((time, "0"));
        let mut time = time.splitn(3, ':');
        let (hour, minute, second) = (time.next()?, time.next()?, time.next()?);
        whole::<u32>(fraction, 9)?;
        let moment = DateTime::new(
            whole(year, 10)?,
            whole(month, 10)?,
            whole(day, 10)?,
            whole(hour, 2)?,
            whole(minute, 2)?,
            whole(second, 2)?,
            format!("{fraction:0<9}").parse().ok()?,
        );
        moment.ok().map(Self)
    }

    /// So many seconds later, not negative; to the nanosecond.
    pub(super) fn plus(self, time_s: f64) -> Result<Self, ExportError> {
        let later = Duration::try_from_secs_f64(time_s).map_err(|_| ExportError::NotFinite)?;
        let sum = self.0.checked_add(later);
        sum.map(Self).map_err(|_| ExportError::NotFinite)
    }

    /// `YYYY-MM-DDThh:mm:ss.nnnnnnnnn`, without a zone: the time system stands elsewhere in the file.
    pub(super) fn iso(self) -> String {
        format!("{:.9}", self.0)
    }

    /// `D Mon YYYY hh:mm:ss.nnnnnnnnn`, as STK writes dates.
    pub(super) fn gregorian(self) -> String {
        self.0.strftime("%-d %b %-Y %H:%M:%S.%9f").to_string()
    }

    /// Milliseconds since 1970, rounded down.
    pub(super) fn unix_ms(self) -> i64 {
        let since = self.0.duration_since(date(1970, 1, 1).at(0, 0, 0, 0));
        since.as_secs() * 1000 + i64::from(since.subsec_nanos()).div_euclid(1_000_000)
    }
}

/// A number of decimal digits only, at most so many.
fn whole<T: FromStr>(text: &str, longest: usize) -> Option<T> {
    let digits = text.bytes().all(|byte| byte.is_ascii_digit());
    (digits && text.len() <= longest).then(|| text.parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epochs_are_read_and_times_after_them_written() {
        let cases = [
            ("2026-01-01T00:00:00Z", 0.0, "2026-01-01T00:00:00.000000000"),
            (
                "2024-02-28T23:59:59.75",
                0.5,
                "2024-02-29T00:00:00.250000000",
            ),
            (
                "1999-12-31 23:59:59",
                86_401.0,
                "2000-01-02T00:00:00.000000000",
            ),
            ("1969-12-31T23:59:59", 1e-9, "1969-12-31T23:59:59.000000001"),
        ];
        for (epoch, after, text) in cases {
            let moment = CalendarTime::parse(epoch).unwrap();
            assert_eq!(moment.plus(after).unwrap().iso(), text);
        }
        for wrong in [
            "2026-01-01",
            "2026-13-01T00:00:00",
            "2026-02-29T00:00:00",
            "2026-01-01T24:00:00",
            "2026-01-01T00:00:60",
            "2026-01-01T00:00:00+01:00",
            "2026-01-01T00:00:+1",
            "12026-01-01T00:00:00",
            "tomorrow",
        ] {
            assert_eq!(CalendarTime::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn stk_and_unix_have_their_own_forms() {
        let moment = CalendarTime::parse("2026-03-05T06:07:08.5").unwrap();
        assert_eq!(moment.gregorian(), "5 Mar 2026 06:07:08.500000000");
        // date -u -d 2026-03-05T06:07:08 +%s
        assert_eq!(moment.unix_ms(), 1_772_690_828_500);
        assert!(moment.plus(-1.0).is_err() && moment.plus(f64::NAN).is_err());
    }
}
