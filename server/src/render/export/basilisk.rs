//! Waypoints for Basilisk's module `waypointReference`.
//!
//! Per line: time, s; quaternion, scalar last (`attitudeType = 2`); body rate, rad/s, and angular
//! acceleration, rad/s², both in the reference frame to be followed (`useReferenceFrame = True`).
//! The module interpolates linearly between two lines and expects no header. At a switch of torques
//! the acceleration is that after the switch: two lines with the same time would make the module
//! divide by zero.

use super::trajectory::SampledFlight;
use std::fmt::Write;

/// The lines, one per sample.
pub(super) fn waypoints(trajectory: &SampledFlight<'_>) -> String {
    let mut text = String::new();
    for sample in trajectory.samples() {
        let state = &sample.state;
        // Writing to a String cannot fail.
        let _ = write!(text, "{:.9}", state.time_s);
        for component in state.attitude.xyzw() {
            let _ = write!(text, ",{component:.15}");
        }
        for component in state.body_rate_rad_s.iter().chain(&sample.acceleration) {
            let _ = write!(text, ",{component:.15}");
        }
        text.push('\n');
    }
    text
}
