//! A plan's trajectory as a table: one row per sample.

use super::phases::SegmentKind;
use super::trajectory::{FlightSegment, SampledFlight};
use std::fmt::Write;

const HEAD: &str = "time_s,q_x,q_y,q_z,q_w,body_rate_x_rad_s,body_rate_y_rad_s,body_rate_z_rad_s";

/// The table with a header that names the units.
///
/// The torque of a row is the one in force from that moment on; the last row repeats the torque
/// of the last interval. Wheels are counted from 0, as in JSON pointers. With `phases` two columns say
/// what goes on until that moment, and at which target or on the way to which.
pub(super) fn table(trajectory: &SampledFlight<'_>, phases: bool) -> String {
    let mut text = HEAD.to_owned();
    for quantity in ["speed_rad_s", "torque_nm"] {
        for wheel in 0..trajectory.wheels {
            // Writing to a String cannot fail, here and below.
            let _ = write!(text, ",wheel_{wheel}_{quantity}");
        }
    }
    text += if phases { ",phase,target\n" } else { "\n" };
    for (index, segment) in trajectory.segments.iter().enumerate() {
        // The last sample of a segment is the first of the next.
        for sample in segment.samples.iter().skip(usize::from(index > 0)) {
            let state = &sample.state;
            let row = std::iter::once(state.time_s)
                .chain(state.attitude.xyzw())
                .chain(<[f64; 3]>::from(state.body_rate_rad_s))
                .chain(state.wheel_speed_rad_s.iter().copied())
                .chain(sample.torque.iter().copied());
            for (column, value) in row.enumerate() {
                let separator = if column == 0 { "" } else { "," };
                // The shortest text that parses to the same number, with an exponent for small numbers.
                let _ = write!(text, "{separator}{value:?}");
            }
            if phases {
                text += &phase(segment);
            }
            text.push('\n');
        }
    }
    text
}

/// The cells of a phase.
fn phase(segment: &FlightSegment<'_>) -> String {
    let (kind, target) = match segment.kind {
        SegmentKind::Slew(_, to) => ("slew", to),
        SegmentKind::Wait(place) => ("wait", place),
        SegmentKind::Rest(target) => ("visit", target),
    };
    format!(",{kind},{}", quoted(target))
}

/// A text as a cell, in quotation marks where it needs them.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
