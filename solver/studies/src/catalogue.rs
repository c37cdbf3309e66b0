//! Catalogue of reaction wheels and control moment gyroscopes, and power laws fitted to it.
//!
//! The tables are those of the RW/CMG thesis (appendix B, tables 7 to 9), from manufacturers' data
//! sheets and papers. All 61 wheels and 16 gyroscopes are here ([`LEFT_OUT`] is zero). Devices that the
//! thesis lists twice are listed twice here too, as they count in its fit.
//!
//! A law `y = a x^b` is the least-squares line in logarithms. For wheels this gives the published law of
//! torque (equation 269) in all printed digits. For gyroscopes the table gives `0.995 h^1.019`, the
//! thesis prints `1.0967 h^1.0019` (equation 268): its figure 77 also has points of another publication
//! that are not in the table.

mod table;

pub use table::{GYROSCOPES, WHEELS};

use slewplan_solver::model::input::{input_object, required};

/// Number of rows of the published tables that are missing here.
pub const LEFT_OUT: usize = 0;

/// A device of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Device {
    /// Manufacturer.
    pub manufacturer: &'static str,
    /// Model.
    pub model: &'static str,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Greatest momentum, N m s.
    pub momentum_nms: f64,
    /// Greatest torque, N m.
    pub torque_nm: f64,
}

input_object! {
    /// `y = factor x^exponent`, in the units of the data.
    #[derive(Copy)]
    pub struct PowerLaw as "GivenLaw" {
        /// `y` at one.
        pub factor: f64 = required().at_least(1e-9).at_most(1e9),
        /// Slope in logarithms.
        pub exponent: f64 = required().at_least(-8.0).at_most(8.0),
    }
}

impl PowerLaw {
    /// Torque (N m) of a wheel over its momentum (N m s) as published, equation 269.
    pub const PUBLISHED_WHEEL: Self = Self {
        factor: 0.0270,
        exponent: 0.5351,
    };
    /// Torque (N m) of a gyroscope over its momentum (N m s) as published, equation 268.
    pub const PUBLISHED_GYROSCOPE: Self = Self {
        factor: 1.0967,
        exponent: 1.0019,
    };

    /// The law of least squares in logarithms of points `(x, y)` above zero. `None` with fewer than
    /// two different `x`, or with a number that is not above zero.
    #[must_use]
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let valid = |x: f64| x > 0.0 && x.is_finite();
        if !points.iter().all(|&(x, y)| valid(x) && valid(y)) {
            return None;
        }
        let logarithms = || points.iter().map(|(x, y)| (x.ln(), y.ln()));
        let count = points.len() as f64;
        let mean_x = logarithms().map(|(x, _)| x).sum::<f64>() / count;
        let mean_y = logarithms().map(|(_, y)| y).sum::<f64>() / count;
        let spread = logarithms().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>();
        let joint = logarithms()
            .map(|(x, y)| (x - mean_x) * (y - mean_y))
            .sum::<f64>();
        let exponent = joint / spread;
        (spread > 0.0).then(|| Self {
            factor: (mean_y - exponent * mean_x).exp(),
            exponent,
        })
    }

    /// The law of one quantity of devices over another.
    #[must_use]
    pub fn of_devices(
        devices: &[Device],
        over: impl Fn(&Device) -> f64,
        quantity: impl Fn(&Device) -> f64,
    ) -> Option<Self> {
        let points: Vec<_> = devices.iter().map(|d| (over(d), quantity(d))).collect();
        Self::fit(&points)
    }

    /// `y` at `x`, above zero.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }

    /// The composition of this law with an inner one: `y = self(inner(x))`.
    #[must_use]
    pub fn of(&self, inner: &Self) -> Self {
        Self {
            factor: self.at(inner.factor),
            exponent: self.exponent * inner.exponent,
        }
    }

    /// This law times a number.
    #[must_use]
    pub fn times(&self, number: f64) -> Self {
        Self {
            factor: self.factor * number,
            ..*self
        }
    }

    /// The `x` at which this law and another have the same value; `None` for equal exponents.
    #[must_use]
    pub fn crossing(&self, other: &Self) -> Option<f64> {
        let power = other.exponent - self.exponent;
        (power != 0.0).then(|| (self.factor / other.factor).powf(1.0 / power))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_to_points_of_a_law_gives_that_law() {
        let law = PowerLaw {
            factor: 0.3,
            exponent: -1.7,
        };
        let points: Vec<_> = [0.01, 0.5, 3.0, 200.0].map(|x| (x, law.at(x))).into();
        let found = PowerLaw::fit(&points).unwrap();
        assert!((found.factor - 0.3).abs() < 1e-14 && (found.exponent + 1.7).abs() < 1e-14);
        assert_eq!(PowerLaw::fit(&points[..1]), None);
        assert_eq!(PowerLaw::fit(&[(1.0, 0.0), (2.0, 1.0)]), None);
        assert_eq!(PowerLaw::fit(&[]), None);
    }

    #[test]
    fn laws_compose_and_cross() {
        let law = PowerLaw {
            factor: 2.0,
            exponent: 0.5,
        };
        let inner = PowerLaw {
            factor: 3.0,
            exponent: 2.0,
        };
        assert!((law.of(&inner).at(1.7) - law.at(inner.at(1.7))).abs() < 1e-14);
        let crossing = law.crossing(&inner).unwrap();
        assert!((law.at(crossing) - inner.at(crossing)).abs() < 1e-14);
        assert_eq!(law.crossing(&law.times(2.0)), None);
    }

    #[test]
    fn the_table_gives_the_published_law_of_wheels() {
        assert_eq!((WHEELS.len(), GYROSCOPES.len(), LEFT_OUT), (61, 16, 0));
        let torque = |devices| PowerLaw::of_devices(devices, |d| d.momentum_nms, |d| d.torque_nm);
        let wheels = torque(&WHEELS).unwrap();
        assert!((wheels.factor - 0.0270).abs() < 5e-5, "{wheels:?}");
        assert!((wheels.exponent - 0.5351).abs() < 5e-5, "{wheels:?}");
        // Not the published one, which rests on more points.
        let gyroscopes = torque(&GYROSCOPES).unwrap();
        assert!((gyroscopes.factor - 0.9946).abs() < 5e-5, "{gyroscopes:?}");
        assert!(
            (gyroscopes.exponent - 1.0186).abs() < 5e-5,
            "{gyroscopes:?}"
        );
    }

    #[test]
    fn the_torque_of_a_gyroscope_is_its_momentum_times_a_gimbal_rate() {
        // The rates that the table prints beside the torques, rad/s.
        let rates: [f64; 16] = [
            1.5, 3.0, 3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.2, 1.0,
        ];
        for (device, rate) in GYROSCOPES.iter().zip(rates) {
            let found = device.torque_nm / device.momentum_nms;
            assert!((found / rate - 1.0).abs() < 0.005, "{device:?}");
        }
    }
}
