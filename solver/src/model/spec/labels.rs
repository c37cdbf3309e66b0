//! The labels of a scenario's time and axes, with the names of the CCSDS registries (SANA).

use crate::model::input::input_choice;

input_choice! {
    /// A time system with days of 86,400 SI seconds and calendar dates.
    pub enum TimeSystem as "TimeSystem" {
        /// Coordinated universal time.
        Utc = "UTC",
        /// International atomic time.
        Tai = "TAI",
        /// Terrestrial time.
        Tt = "TT",
        /// Time of the Global Positioning System.
        Gps = "GPS",
        /// Barycentric dynamical time.
        Tdb = "TDB",
        /// Barycentric coordinate time.
        Tcb = "TCB",
        /// Geocentric coordinate time.
        Tcg = "TCG",
        /// Universal time of the Earth's rotation.
        Ut1 = "UT1",
    }
}

input_choice! {
    /// A reference frame. Plans are computed in inertial axes; a frame that turns gets a warning.
    pub enum ReferenceFrame as "ReferenceFrame" {
        /// Earth mean equator and equinox of J2000.
        Eme2000 = "EME2000",
        /// The same, as other tools call it.
        J2000 = "J2000",
        /// Geocentric celestial reference frame.
        Gcrf = "GCRF",
        /// International celestial reference frame.
        Icrf = "ICRF",
        /// Its second realization.
        Icrf2 = "ICRF2",
        /// Its third realization.
        Icrf3 = "ICRF3",
        /// Mean equator and equinox of B1950.
        B1950 = "B1950",
        /// Mars centred inertial.
        Mci = "MCI",
        /// True equator, mean equinox.
        Teme = "TEME",
        /// True equator, mean equinox, of date.
        TemeOfDate = "TEMEOFDATE",
        /// True equator, mean equinox, of epoch.
        TemeOfEpoch = "TEMEOFEPOCH",
        /// True equator and equinox of date.
        Tod = "TOD",
        /// The same of the Earth.
        TodEarth = "TOD_EARTH",
        /// The same of another body.
        TodBody = "TOD_CB",
        /// True equator and equinox of epoch of the Earth.
        ToeEarth = "TOE_EARTH",
        /// The same of another body.
        ToeBody = "TOE_CB",
        /// Mean equator and equinox of date of the Earth.
        ModEarth = "MOD_EARTH",
        /// The same of another body.
        ModBody = "MOD_CB",
        /// Mean equator and equinox of epoch of the Earth.
        MoeEarth = "MOE_EARTH",
        /// The same of another body.
        MoeBody = "MOE_CB",
        /// Inertial, along the Earth-fixed frame at an epoch.
        AlignEarth = "ALIGN_EARTH",
        /// The same of another body.
        AlignBody = "ALIGN_CB",
        /// Celestial intermediate reference system.
        Cirs = "CIRS",
        /// Turns: international terrestrial reference frame.
        Itrf = "ITRF",
        /// Turns: its realization of 1993.
        Itrf93 = "ITRF-93",
        /// Turns: its realization of 1997.
        Itrf97 = "ITRF-97",
        /// Turns: its realization of 2000.
        Itrf2000 = "ITRF2000",
        /// Turns: its realization of 2005.
        Itrf2005 = "ITRF2005",
        /// Turns: its realization of 2008.
        Itrf2008 = "ITRF2008",
        /// Turns: its realization of 2014.
        Itrf2014 = "ITRF2014",
        /// Turns: its realization of 2020.
        Itrf2020 = "ITRF2020",
        /// Turns: Greenwich true of date.
        Gtod = "GTOD",
        /// Turns: Greenwich rotating coordinates.
        Grc = "GRC",
        /// Turns: true of date, rotating.
        Tdr = "TDR",
        /// Turns: terrestrial intermediate reference system.
        Tirs = "TIRS",
        /// Turns: Earth fixed, Greenwich.
        Efg = "EFG",
        /// Turns: World Geodetic System 1984.
        Wgs84 = "WGS84",
        /// Turns: fixed to the Earth.
        FixedEarth = "FIXED_EARTH",
        /// Turns: fixed to another body.
        FixedBody = "FIXED_CB",
        /// Turns: Moon, mean Earth and rotation axis.
        MoonMe = "MOON_ME",
        /// Turns: local vertical, local horizontal.
        Lvlh = "LVLH",
        /// Turns: radial, transverse, normal.
        Rtn = "RTN",
        /// Turns: the same under its other name.
        Rsw = "RSW",
        /// Turns: the same under its third name.
        Qsw = "QSW",
        /// Turns: tangential, normal, cross-track.
        Tnw = "TNW",
        /// Turns: in-track along the velocity.
        Ntw = "NTW",
    }
}

impl ReferenceFrame {
    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Whether the frame turns with a body or along an orbit, unlike the axes that plans are computed in.
    #[must_use]
    pub fn turns(self) -> bool {
        // Declared last, after all that do not.
        self as usize >= Self::Itrf as usize
    }
}

impl TimeSystem {
    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }
}
