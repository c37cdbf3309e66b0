//! The scenario's epoch, and times after it, as text.
//!
//! Days have 86,400 s here. Where a plan runs through a leap second of UTC, label its epoch in TAI.

use super::ExportError;
use jiff::civil::{DateTime, date};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::TimeSystem;
use std::time::Duration;

/// The epoch of scenarios without one.
pub(super) const NO_EPOCH: DateTime = date(2000, 1, 1).at(12, 0, 0, 0);

/// A moment in the time system of a scenario, in the years -9999 to 9999.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CalendarTime(DateTime);

/// The epoch of a scenario, [`NO_EPOCH`] when it has none.
pub(super) fn epoch(scenario: &Scenario) -> CalendarTime {
    CalendarTime(scenario.epoch().unwrap_or(NO_EPOCH))
}

/// The time system of a scenario, UTC when it has none.
pub(super) fn time_system(scenario: &Scenario) -> TimeSystem {
    scenario.time_system().unwrap_or(TimeSystem::Utc)
}

/// The epoch for formats that know UTC only.
pub(super) fn utc_epoch(scenario: &Scenario, format: &str) -> Result<CalendarTime, ExportError> {
    match time_system(scenario) {
        TimeSystem::Utc => Ok(epoch(scenario)),
        other => Err(ExportError::Label {
            pointer: "/time_system",
            what: format!(
                "{format} counts in UTC and leap seconds are not known here: not {}",
                other.name()
            ),
        }),
    }
}

impl CalendarTime {
    /// So many seconds later, not negative; to the nanosecond.
    pub(super) fn plus(self, time_s: f64) -> Result<Self, ExportError> {
        let later = Duration::try_from_secs_f64(time_s).map_err(|_| ExportError::NotFinite)?;
        let sum = self.0.checked_add(later);
        sum.map(Self).map_err(|_| ExportError::Label {
            pointer: "/epoch",
            what: "the flight goes on after the year 9999".to_owned(),
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::epoch;

    /// A valid epoch.
    fn at(text: &str) -> CalendarTime {
        CalendarTime(epoch::parse(text).expect("a valid epoch"))
    }

    #[test]
    fn times_after_an_epoch_are_written() {
        let cases = [
            ("2026-01-01T00:00:00Z", 0.0, "2026-01-01T00:00:00.000000000"),
            (
                "2024-02-28T23:59:59.75",
                0.5,
                "2024-02-29T00:00:00.250000000",
            ),
            (
                "1999-12-31T23:59:59",
                86_401.0,
                "2000-01-02T00:00:00.000000000",
            ),
            ("1969-12-31T23:59:59", 1e-9, "1969-12-31T23:59:59.000000001"),
        ];
        for (epoch, after, text) in cases {
            assert_eq!(at(epoch).plus(after).unwrap().iso(), text);
        }
        let late = at("9999-12-31T23:59:59").plus(2.0).unwrap_err();
        assert!(
            late.to_string().starts_with("/epoch of the scenario"),
            "{late}"
        );
    }

    #[test]
    fn stk_and_unix_have_their_own_forms() {
        let moment = at("2026-03-05T06:07:08.5");
        assert_eq!(moment.gregorian(), "5 Mar 2026 06:07:08.500000000");
        // date -u -d 2026-03-05T06:07:08 +%s
        assert_eq!(moment.unix_ms(), 1_772_690_828_500);
        assert!(moment.plus(-1.0).is_err() && moment.plus(f64::NAN).is_err());
    }
}
