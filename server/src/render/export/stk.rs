//! An attitude file of STK (`.a`): quaternions from the reference axes to the body axes, scalar
//! last, with angular velocities in degrees per second about the body axes.

use super::ExportError;
use super::calendar::{self, CalendarTime};
use super::trajectory::SampledFlight;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::ReferenceFrame;
use std::fmt::Write;

/// Epoch and axes.
pub(super) fn labels(scenario: &Scenario) -> Result<(CalendarTime, &'static str), ExportError> {
    let epoch = calendar::utc_epoch(scenario, "STK")?;
    let axes = axes(scenario.reference_frame().unwrap_or_default())?;
    Ok((epoch, axes))
}

/// The file; the first line is the oldest version of the format with these contents.
pub(super) fn attitude_file(
    scenario: &Scenario,
    trajectory: &SampledFlight<'_>,
    rates: bool,
) -> Result<String, ExportError> {
    let (epoch, axes) = labels(scenario)?;
    let epoch = epoch.gregorian();
    let kind = if rates {
        "AttitudeTimeQuatAngVels"
    } else {
        "AttitudeTimeQuaternions"
    };
    let points = trajectory.samples().count();
    let mut text = format!(
        "stk.v.8.0\nBEGIN Attitude\nNumberOfAttitudePoints {points}\nScenarioEpoch {epoch}\n\
         BlockingFactor 20\nInterpolationOrder 1\nCentralBody Earth\nCoordinateAxes {axes}\n\
         {kind}\n"
    );
    for sample in trajectory.samples() {
        let state = &sample.state;
        // Writing to a String cannot fail.
        let _ = write!(text, "{:.9}", state.time_s);
        for component in state.attitude.xyzw() {
            let _ = write!(text, " {component:.15}");
        }
        for component in state.body_rate_rad_s.iter().filter(|_| rates) {
            let _ = write!(text, " {:.14}", component.to_degrees());
        }
        text.push('\n');
    }
    text.push_str("END Attitude\n");
    Ok(text)
}

/// STK's name of a frame.
fn axes(frame: ReferenceFrame) -> Result<&'static str, ExportError> {
    match frame {
        ReferenceFrame::Eme2000 | ReferenceFrame::J2000 => Ok("J2000"),
        ReferenceFrame::Icrf | ReferenceFrame::Gcrf => Ok("ICRF"),
        other => Err(ExportError::Label {
            pointer: "/reference_frame",
            what: format!(
                "STK has EME2000 (J2000) and ICRF (GCRF) here, not {}",
                other.name()
            ),
        }),
    }
}
