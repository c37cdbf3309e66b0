//! Momentum and torque of arrays over their mass.
//!
//! Momentum over mass is a law fitted to the tables (RW/CMG thesis, figure 87). The body momentum of a
//! pyramid of four follows with its radius, its torque by the laws of torque over momentum (figures 88
//! and 89). Per mass, wheels hold an order of magnitude more momentum than gyroscopes. Below the
//! crossover mass they give more torque too.
//!
//! The thesis prints a crossover of 0.898 kg per device, but not the fits that it follows from. Its
//! printed laws and radii with fits of momentum over mass to its tables give 0.908 kg, one per cent
//! more; the law of torque fitted to its table of gyroscopes gives 1.036 kg (see [`crate::catalogue`] for
//! the points that are not in the table).

use super::{Laws, PyramidControl, Radii};
use crate::catalogue::{GYROSCOPES, PowerLaw, WHEELS};

/// Devices of a pyramid.
const DEVICES: f64 = 4.0;

/// Arrays of four wheels and of four gyroscopes of one mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassPoint {
    /// Mass of a device, kg.
    pub device_mass_kg: f64,
    /// Mass of the four, kg.
    pub array_mass_kg: f64,
    /// Body momentum of wheels, N m s.
    pub wheel_momentum_nms: f64,
    /// Body momentum of gyroscopes, N m s.
    pub gyroscope_momentum_nms: f64,
    /// Body torque of wheels, N m.
    pub wheel_torque_nm: f64,
    /// Body torque of gyroscopes, N m.
    pub gyroscope_torque_nm: f64,
}

/// Momentum and torque of pyramids over the mass of a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassStudy {
    /// Momentum (N m s) of a wheel over its mass (kg).
    pub wheel_momentum: PowerLaw,
    /// Momentum (N m s) of a gyroscope over its mass (kg).
    pub gyroscope_momentum: PowerLaw,
    radii: Radii,
    laws: Laws,
}

impl MassStudy {
    /// The crossover that the thesis prints, kg per device.
    pub const PUBLISHED_CROSSOVER_KG: f64 = 0.898;

    /// The study of the tables, with the radii of eigenaxis control for wheels; always `Some` for these
    /// tables.
    #[must_use]
    pub fn of(radii: Radii, laws: Laws) -> Option<Self> {
        let momentum = |devices| PowerLaw::of_devices(devices, |d| d.mass_kg, |d| d.momentum_nms);
        Some(Self {
            wheel_momentum: momentum(&WHEELS)?,
            gyroscope_momentum: momentum(&GYROSCOPES)?,
            radii,
            laws,
        })
    }

    /// Body torque (N m) over the mass of a device (kg), of wheels.
    #[must_use]
    pub fn wheel_torque(&self) -> PowerLaw {
        let device = self.laws.wheel.of(&self.wheel_momentum);
        device.times(self.radii.of(PyramidControl::Eigenaxis).torque)
    }

    /// Body torque (N m) over the mass of a device (kg), of gyroscopes.
    #[must_use]
    pub fn gyroscope_torque(&self) -> PowerLaw {
        let device = self.laws.gyroscope.of(&self.gyroscope_momentum);
        device.times(self.radii.of(PyramidControl::Gyroscopes).torque)
    }

    /// Mass of a device, kg, below which wheels give more torque.
    #[must_use]
    pub fn crossover_kg(&self) -> Option<f64> {
        self.wheel_torque().crossing(&self.gyroscope_torque())
    }

    /// Momentum and torque of arrays of devices of a mass (kg, above zero).
    #[must_use]
    pub fn at(&self, device_mass_kg: f64) -> MassPoint {
        let wheels = self.radii.of(PyramidControl::Eigenaxis).momentum;
        let gyroscopes = self.radii.of(PyramidControl::Gyroscopes).momentum;
        MassPoint {
            device_mass_kg,
            array_mass_kg: DEVICES * device_mass_kg,
            wheel_momentum_nms: wheels * self.wheel_momentum.at(device_mass_kg),
            gyroscope_momentum_nms: gyroscopes * self.gyroscope_momentum.at(device_mass_kg),
            wheel_torque_nm: self.wheel_torque().at(device_mass_kg),
            gyroscope_torque_nm: self.gyroscope_torque().at(device_mass_kg),
        }
    }
}
