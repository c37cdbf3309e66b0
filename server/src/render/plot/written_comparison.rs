//! The part of a comparison of wheels and gyroscopes that is drawn, read from its JSON.

use serde::Deserialize;

/// The part of the answer that is read.
#[derive(Debug, Deserialize)]
pub(crate) struct WrittenComparison {
    pub(super) angles_rad: Vec<f64>,
    pub(super) market: Catalogue,
    pub(super) sizes: Vec<Size>,
    pub(super) advantage: WrittenAdvantage,
    pub(super) mass: Mass,
}

#[derive(Debug, Deserialize)]
pub(super) struct Catalogue {
    pub(super) wheel: Fit,
    pub(super) gyroscope: Fit,
}

#[derive(Debug, Deserialize)]
pub(super) struct Fit {
    pub(super) used: WrittenLaw,
    pub(super) devices: Vec<WrittenDevice>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenLaw {
    pub(super) factor: f64,
    pub(super) exponent: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenDevice {
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
pub(super) struct WrittenAdvantage {
    pub(super) momenta_nms: Vec<f64>,
    pub(super) curves: Vec<WrittenAdvantageCurve>,
    pub(super) published: Vec<WrittenPublishedAngle>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenAdvantageCurve {
    pub(super) control: String,
    pub(super) angles_rad: Vec<Option<f64>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenPublishedAngle {
    pub(super) control: String,
    pub(super) momentum_nms: f64,
    pub(super) angle_rad: f64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mass {
    pub(super) crossover_kg: Option<f64>,
    pub(super) points: Vec<WrittenMassPoint>,
}

#[derive(Debug, Deserialize)]
pub(super) struct WrittenMassPoint {
    pub(super) device_mass_kg: f64,
    pub(super) wheel_torque_nm: f64,
    pub(super) gyroscope_torque_nm: f64,
    pub(super) wheel_momentum_nms: f64,
    pub(super) gyroscope_momentum_nms: f64,
}

impl WrittenLaw {
    pub(super) fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }
}
