//! Waypoints for Basilisk's module `waypointReference`.
//!
//! Per line: time, s; quaternion, scalar last (`attitudeType = 2`); body rate, rad/s, and angular
//! acceleration, rad/s², both in the frame that is to be followed (`useReferenceFrame = True`).
//! The module interpolates linearly between two lines and wants no head. Where torques switch, the
//! acceleration is the one from then on: two lines of one time would divide by zero there.

use super::trajectory::Trajectory;
use std::fmt::Write;

/// The lines, one per sample.
pub(super) fn waypoints(trajectory: &Trajectory<'_>) -> String {
    let mut text = String::new();
    for sample in trajectory.samples() {
        let state = &sample.state;
        // Writing into a text cannot fail.
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
