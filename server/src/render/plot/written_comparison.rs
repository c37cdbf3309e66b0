//! A comparison of wheels and gyroscopes as it was written, as far as a picture shows it.

use serde::Deserialize;

/// What is read of the answer to the study.
#[derive(Debug, Deserialize)]
pub(crate) struct WrittenComparison {
    pub(super) angles_rad: Vec<f64>,
    pub(super) market: Catalogue,
    pub(super) sizes: Vec<Size>,
    pub(super) advantage: Advantage,
    pub(super) mass: Mass,
}

#[derive(Debug, Deserialize)]
pub(super) struct Catalogue {
    pub(super) wheel: Fit,
    pub(super) gyroscope: Fit,
}

#[derive(Debug, Deserialize)]
pub(super) struct Fit {
    pub(super) used: Law,
    pub(super) devices: Vec<Device>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Law {
    pub(super) factor: f64,
    pub(super) exponent: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Device {
    pub(super) momentum_nms: f64,
    pub(super) torque_nm: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Size {
    pub(super) momentum_nms: f64,
    pub(super) controls: Vec<Slews>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Slews {
    pub(super) control: String,
    pub(super) durations_s: Vec<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Advantage {
    pub(super) momenta_nms: Vec<f64>,
    pub(super) curves: Vec<AdvantageCurve>,
    pub(super) published: Vec<PublishedAngle>,
}

#[derive(Debug, Deserialize)]
pub(super) struct AdvantageCurve {
    pub(super) control: String,
    pub(super) angles_rad: Vec<Option<f64>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct PublishedAngle {
    pub(super) control: String,
    pub(super) momentum_nms: f64,
    pub(super) angle_rad: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mass {
    pub(super) crossover_kg: Option<f64>,
    pub(super) points: Vec<MassPoint>,
}

#[derive(Debug, Deserialize)]
pub(super) struct MassPoint {
    pub(super) device_mass_kg: f64,
    pub(super) wheel_torque_nm: f64,
    pub(super) gyroscope_torque_nm: f64,
    pub(super) wheel_momentum_nms: f64,
    pub(super) gyroscope_momentum_nms: f64,
}

impl Law {
    pub(super) fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }
}
