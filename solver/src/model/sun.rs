//! Where the Sun stands, to 0.01 degrees.
//!
//! The apparent direction from the centre of the Earth by the low-precision series of Meeus
//! (Astronomical Algorithms, 2nd edition, 1998, chapter 25, "lower accuracy"), which are the formulas
//! of the Astronomical Almanac ("Low-precision formulas for the Sun", page C5) with their terms in
//! `T` and one digit more. They give the longitude in the mean ecliptic and equinox of date; with
//! the mean obliquity, and the precession of Lieske et al. (Astronomy and Astrophysics 58, 1977,
//! equations 6 and 7), they become a direction in the mean equator and equinox of J2000 (EME2000;
//! ICRF axes differ by 0.02 arc seconds).
//!
//! `T` is in Julian centuries of terrestrial time from J2000.0:
//!
//! ```text
//! L   = 280.46646 + 36000.76983 T + 0.0003032 T^2       (mean longitude, degrees)
//! M   = 357.52911 + 35999.05029 T - 0.0001537 T^2       (mean anomaly)
//! C   = (1.914602 - 0.004817 T) sin M + (0.019993 - 0.000101 T) sin 2M + 0.000289 sin 3M
//! l   = L + C - 0.00569                                 (aberration)
//! e   = 23.439291 - 0.0130042 T
//! s   = (cos l, cos e sin l, sin e sin l)               (of date)
//! ```
//!
//! Neglected are the perturbations by Moon and planets (0.009 degrees at most), nutation, which does
//! not move the axes of J2000, and the parallax of a spacecraft that is not at the Earth's centre:
//! 0.003 degrees in geostationary orbit, 0.15 degrees at the Moon. From 1800 to 2300 the result is
//! within 0.0105 degrees of the apparent place by the series VSOP2000 as ERFA has them (`epv00`,
//! every 2.4 days), from 1950 to 2050 within 0.01.

use super::spec::TimeSystem;
use jiff::civil::{DateTime, date};
use nalgebra::{Rotation3, Vector3};
use std::ops::RangeInclusive;

/// Years of epochs for which the error is known.
pub(crate) const YEARS: RangeInclusive<i16> = 1800..=2299;

/// Terrestrial time minus atomic time, s.
const TT_FROM_TAI: f64 = 32.184;
/// Terrestrial time minus the time of the Global Positioning System, s.
const TT_FROM_GPS: f64 = TT_FROM_TAI + 19.0;
/// Terrestrial time minus universal time since 2017, s. It was 42 s in 1972; a minute turns the
/// direction by 0.0007 degrees.
const TT_FROM_UTC: f64 = TT_FROM_TAI + 37.0;
const SECONDS_PER_CENTURY: f64 = 36_525.0 * 86_400.0;

/// The unit vector from the centre of the Earth to the Sun at an epoch, in EME2000 axes.
pub(crate) fn direction(epoch: DateTime, system: TimeSystem) -> Vector3<f64> {
    let century = centuries(epoch, system);
    let degrees = |at_j2000: f64, per_century: f64, squared: f64| {
        (at_j2000 + century * (per_century + century * squared)).to_radians()
    };
    let mean_longitude = degrees(280.466_46, 36_000.769_83, 0.000_303_2);
    let anomaly = degrees(357.529_11, 35_999.050_29, -0.000_153_7);
    let centre = degrees(1.914_602, -0.004_817, 0.0) * anomaly.sin()
        + degrees(0.019_993, -0.000_101, 0.0) * (2.0 * anomaly).sin()
        + degrees(0.000_289, 0.0, 0.0) * (3.0 * anomaly).sin();
    let longitude = mean_longitude + centre - degrees(0.005_69, 0.0, 0.0);
    let obliquity = degrees(23.439_291, -0.013_004_2, 0.0);
    let (up, along) = longitude.sin_cos();
    let of_date = Vector3::new(along, obliquity.cos() * up, obliquity.sin() * up);
    precession_to_j2000(century) * of_date
}

/// Julian centuries of terrestrial time since J2000.0.
fn centuries(epoch: DateTime, system: TimeSystem) -> f64 {
    let to_tt = match system {
        TimeSystem::Utc | TimeSystem::Ut1 => TT_FROM_UTC,
        TimeSystem::Tai => TT_FROM_TAI,
        TimeSystem::Gps => TT_FROM_GPS,
        // The coordinate times are ahead by at most a minute within a century of 1977 (TCB).
        TimeSystem::Tt | TimeSystem::Tdb | TimeSystem::Tcb | TimeSystem::Tcg => 0.0,
    };
    let since = epoch.duration_since(date(2000, 1, 1).at(12, 0, 0, 0));
    (since.as_secs_f64() + to_tt) / SECONDS_PER_CENTURY
}

/// The rotation of vectors from the mean equator and equinox of date to those of J2000.
fn precession_to_j2000(century: f64) -> Rotation3<f64> {
    let arc_seconds = |linear: f64, squared: f64, cubed: f64| {
        let angle = century * (linear + century * (squared + century * cubed));
        (angle / 3600.0).to_radians()
    };
    let zeta = arc_seconds(2306.2181, 0.301_88, 0.017_998);
    let z = arc_seconds(2306.2181, 1.094_68, 0.018_203);
    let theta = arc_seconds(2004.3109, -0.426_65, -0.041_833);
    // Lieske's P = R3(-z) R2(theta) R3(-zeta) turns axes from J2000 to the date. Its transpose is
    // made of turns of vectors by the same angles.
    Rotation3::from_axis_angle(&Vector3::z_axis(), -zeta)
        * Rotation3::from_axis_angle(&Vector3::y_axis(), theta)
        * Rotation3::from_axis_angle(&Vector3::z_axis(), -z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::epoch;

    /// Apparent directions from the Earth's centre in GCRS axes at epochs in UTC, by astropy 7
    /// (`get_sun`, which uses ERFA's `epv00`): the seasons of 2026 to the minute, and others.
    const ALMANAC: [(&str, [f64; 3]); 8] = [
        (
            "2000-01-01T12:00:00",
            [0.180_052_031_2, -0.902_489_389_8, -0.391_272_497_7],
        ),
        (
            "2026-03-20T14:46:00",
            [0.999_979_382_9, -0.005_890_140_5, -0.002_557_346_4],
        ),
        (
            "2026-06-21T08:24:00",
            [0.006_497_308_1, 0.917_486_967_1, 0.397_712_773_5],
        ),
        (
            "2026-09-23T00:05:00",
            [-0.999_978_469_3, 0.006_018_617_4, 0.002_614_804_9],
        ),
        (
            "2026-12-21T20:50:00",
            [-0.006_626_198_5, -0.917_487_884_4, -0.397_708_530_9],
        ),
        (
            "2026-01-31T12:00:00",
            [0.659_357_758_7, -0.689_807_178_9, -0.299_020_738_2],
        ),
        (
            "1985-07-04T06:30:00",
            [-0.215_302_192_4, 0.895_953_561_9, 0.388_474_170_1],
        ),
        (
            "2045-10-30T18:00:00",
            [-0.797_840_517_3, -0.553_149_440_7, -0.239_741_953_4],
        ),
    ];

    fn at(text: &str, system: TimeSystem) -> Vector3<f64> {
        direction(epoch::parse(text).expect("an epoch"), system)
    }

    #[test]
    fn the_sun_stands_where_the_almanac_says() {
        for (text, expected) in ALMANAC {
            let found = at(text, TimeSystem::Utc);
            let off = found.angle(&Vector3::from(expected)).to_degrees();
            assert!(off < 0.01, "{text}: {off} degrees");
            assert!((found.norm() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_precession_since_j2000_is_taken_off() {
        // At the equinox of 2026 the Sun is on the equator of date, at right ascension 0; in axes
        // of J2000 that place has moved by 26.2 years of 50.3 arc seconds.
        let found = at("2026-03-20T14:46:00", TimeSystem::Utc);
        let off = found.angle(&Vector3::x()).to_degrees();
        assert!((off - 0.366).abs() < 0.01, "{off}");
        assert!(found.y < 0.0 && found.z < 0.0, "{found}");
    }

    #[test]
    fn time_systems_differ_by_their_offsets() {
        let utc = at("2026-01-31T12:00:00", TimeSystem::Utc);
        for (text, system) in [
            ("2026-01-31T12:00:37", TimeSystem::Tai),
            ("2026-01-31T12:00:18", TimeSystem::Gps),
            ("2026-01-31T12:01:09.184", TimeSystem::Tt),
            ("2026-01-31T12:01:09.184", TimeSystem::Tdb),
        ] {
            let same = at(text, system);
            assert!((same - utc).norm() < 1e-12, "{text} {system}");
            // An offset of ten seconds would be seen.
            let other = at("2026-01-31T12:00:00", system);
            assert!((other - utc).norm() > 1e-6, "{system}");
        }
    }
}
