//! Directions of the sky in the reference frame.

use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::{CelestialBody, DirectionSpec, ReferenceFrame, ScenarioSpec, TimeSystem};
use crate::model::sun;
use jiff::civil::DateTime;
use nalgebra::Vector3;

/// What the direction of a body depends on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sky {
    /// An epoch that is refused has been reported where it stands.
    has_epoch: bool,
    epoch: Option<DateTime>,
    time_system: TimeSystem,
    frame: ReferenceFrame,
}

impl Sky {
    pub(super) fn of(spec: &ScenarioSpec, epoch: Option<DateTime>) -> Self {
        Self {
            has_epoch: spec.epoch.is_some(),
            epoch,
            time_system: spec.time_system.unwrap_or_default(),
            frame: spec.reference_frame.unwrap_or_default(),
        }
    }

    /// The unit vector of a direction in the reference frame.
    pub(super) fn direction(
        &self,
        spec: &DirectionSpec,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Vector3<f64>> {
        match spec {
            DirectionSpec::Vector(vector) => findings.direction(pointer, *vector),
            DirectionSpec::RaDecDeg(angles) => ra_dec(*angles, pointer, findings),
            DirectionSpec::Body(CelestialBody::Sun) => self.sun(pointer, findings),
        }
    }

    fn sun(&self, pointer: &str, findings: &mut Findings) -> Option<Vector3<f64>> {
        let framed = self.allow_frame(pointer, findings);
        if !self.has_epoch {
            findings.refuse(
                pointer,
                Code::EpochRequired,
                "where the Sun stands depends on the date, but the scenario has no epoch",
                "give the epoch of time zero, such as \"epoch\": \"2026-01-31T12:00:00Z\", or the \
                 direction as a vector or as ra_dec_deg",
            );
        }
        let epoch = self.epoch?;
        let known = sun::YEARS.contains(&epoch.year());
        if !known {
            findings.refuse(
                pointer,
                Code::OutOfRange,
                format!(
                    "the epoch is in the year {}, the Sun's place is computed from {} to {}",
                    epoch.year(),
                    sun::YEARS.start(),
                    sun::YEARS.end()
                ),
                "give the direction as a vector or as ra_dec_deg",
            );
        }
        (framed && known).then(|| sun::direction(epoch, self.time_system))
    }

    /// Refuses the axes in which the Sun's direction is not computed.
    fn allow_frame(&self, pointer: &str, findings: &mut Findings) -> bool {
        // The others differ from EME2000 by less than 0.1 arc seconds.
        let known = matches!(
            self.frame,
            ReferenceFrame::Eme2000
                | ReferenceFrame::J2000
                | ReferenceFrame::Gcrf
                | ReferenceFrame::Icrf
                | ReferenceFrame::Icrf2
                | ReferenceFrame::Icrf3
        );
        if !known {
            findings.refuse(
                pointer,
                Code::ConflictingFields,
                format!(
                    "the Sun's direction is computed in EME2000 axes, the reference frame is {}",
                    self.frame.name()
                ),
                "give the direction as a vector or as ra_dec_deg in that frame, or everything in \
                 EME2000",
            );
        }
        known
    }
}

/// The unit vector to a right ascension and declination, degrees.
fn ra_dec(angles: [f64; 2], pointer: &str, findings: &mut Findings) -> Option<Vector3<f64>> {
    let pointer = format!("{pointer}/ra_dec_deg");
    let [ascension, declination] = findings.finite_all(&pointer, angles)?;
    if declination.abs() > 90.0 {
        findings.refuse(
            format!("{pointer}/1"),
            Code::OutOfRange,
            format!("the declination is {declination} degrees, it must be from -90 to 90"),
            "write right ascension and declination in this order, both in degrees",
        );
        return None;
    }
    let (sine, cosine) = declination.to_radians().sin_cos();
    // Whole turns are taken off in degrees, where they are exact.
    let (north, east) = (ascension % 360.0).to_radians().sin_cos();
    Some(Vector3::new(cosine * east, cosine * north, sine))
}
