//! CCSDS Attitude Ephemeris Message 2.0 (504.0-B-2), as keywords and values or as XML.
//!
//! A message turns frame A, the reference frame, into frame B, the body: `Q1 Q2 Q3 QC` with the
//! scalar last are the numbers of our quaternion, and angular velocities are in degrees per second
//! about the body axes. Every slew and every rest has a segment of its own, because readers must
//! not interpolate from one segment into another. Switch times are samples and the interpolation
//! is linear, so that it never reaches across a switch; readers that use the angular velocities
//! come closer to the motion than that.

use super::calendar::{self, CalendarTime, NO_EPOCH};
use super::phases::SegmentKind;
use super::trajectory::{FlightSample, FlightSegment, SampledFlight};
use super::{ExportError, ExportOptions};
use crate::base::clock;
use slewplan_solver::model::scenario::Scenario;
use std::fmt::Write;

const BODY: &str = "SC_BODY_1";
/// Longest value, so that no line exceeds the 254 characters of the standard.
const LONGEST: usize = 200;
const UNKNOWN: &str = "UNKNOWN";

/// A message that can be written either way.
#[derive(Debug)]
pub(super) struct Message {
    header: Vec<(&'static str, String)>,
    segments: Vec<Block>,
    rates: bool,
}

/// Metadata and data lines.
#[derive(Debug)]
struct Block {
    metadata: Vec<(&'static str, String)>,
    lines: Vec<DataLine>,
}

/// Epoch, quaternion with the scalar last, angular velocity in degrees per second.
#[derive(Debug)]
struct DataLine {
    epoch: String,
    quaternion: [f64; 4],
    velocity: [f64; 3],
}

/// The message of a trajectory.
pub(super) fn message(
    scenario: &Scenario,
    trajectory: &SampledFlight<'_>,
    options: &ExportOptions,
) -> Result<Message, ExportError> {
    let epoch = calendar::epoch(scenario);
    let segments = trajectory.segments.iter();
    Ok(Message {
        header: header(scenario, options),
        segments: segments
            .map(|segment| block(scenario, segment, epoch, options))
            .collect::<Result<_, _>>()?,
        rates: options.rates,
    })
}

fn header(scenario: &Scenario, options: &ExportOptions) -> Vec<(&'static str, String)> {
    let mut header = Vec::new();
    if let Some(name) = scenario.name() {
        header.push(("COMMENT", format!("Plan of the scenario {}", plain(name))));
    }
    if scenario.epoch().is_none() {
        let text = format!("The scenario has no epoch: times count from {NO_EPOCH}");
        header.push(("COMMENT", text));
    }
    let created = clock::rfc3339(options.created_us);
    let created = created.strip_suffix('Z').unwrap_or(&created);
    header.push(("CREATION_DATE", created.to_owned()));
    header.push(("ORIGINATOR", "SLEWPLAN".to_owned()));
    header
}

fn block(
    scenario: &Scenario,
    segment: &FlightSegment<'_>,
    epoch: CalendarTime,
    options: &ExportOptions,
) -> Result<Block, ExportError> {
    let lines: Vec<DataLine> = segment
        .samples
        .iter()
        .map(|sample| line(epoch, sample))
        .collect::<Result<_, _>>()?;
    let at = |line: Option<&DataLine>| line.map(|line| line.epoch.clone()).unwrap_or_default();
    let named = |name: &Option<String>| name.as_deref().map_or(UNKNOWN.to_owned(), plain);
    let what = match segment.kind {
        SegmentKind::Slew(from, to) => format!("Slew from {} to {}", plain(from), plain(to)),
        SegmentKind::Wait(place) => format!("Waiting at rest at {}", plain(place)),
        SegmentKind::Rest(target) => format!("At rest at {}", plain(target)),
    };
    let frame = scenario.reference_frame().unwrap_or_default();
    let time_system = calendar::time_system(scenario);
    let mut metadata = vec![
        ("COMMENT", what),
        ("OBJECT_NAME", named(&options.object_name)),
        ("OBJECT_ID", named(&options.object_id)),
        ("REF_FRAME_A", frame.name().to_owned()),
        ("REF_FRAME_B", BODY.to_owned()),
        ("TIME_SYSTEM", time_system.name().to_owned()),
        ("START_TIME", at(lines.first())),
        ("STOP_TIME", at(lines.last())),
    ];
    if options.rates {
        metadata.push(("ATTITUDE_TYPE", "QUATERNION/ANGVEL".to_owned()));
        metadata.push(("ANGVEL_FRAME", BODY.to_owned()));
    } else {
        metadata.push(("ATTITUDE_TYPE", "QUATERNION".to_owned()));
    }
    metadata.push(("INTERPOLATION_METHOD", "LINEAR".to_owned()));
    metadata.push(("INTERPOLATION_DEGREE", "1".to_owned()));
    Ok(Block { metadata, lines })
}

fn line(epoch: CalendarTime, sample: &FlightSample) -> Result<DataLine, ExportError> {
    let state = &sample.state;
    Ok(DataLine {
        epoch: epoch.plus(state.time_s)?.iso(),
        quaternion: state.attitude.xyzw(),
        velocity: <[f64; 3]>::from(state.body_rate_rad_s).map(f64::to_degrees),
    })
}

/// One line of printable ASCII, not too long.
fn plain(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let printable = |c: char| {
        if c.is_ascii_graphic() || c == ' ' {
            c
        } else {
            '?'
        }
    };
    let line: String = words
        .join(" ")
        .chars()
        .map(printable)
        .take(LONGEST)
        .collect();
    if line.is_empty() {
        UNKNOWN.to_owned()
    } else {
        line
    }
}

impl Message {
    /// Keywords and values.
    pub(super) fn kvn(&self) -> String {
        let mut text = String::new();
        pair(&mut text, "CCSDS_AEM_VERS", "2.0");
        for (keyword, value) in &self.header {
            pair(&mut text, keyword, value);
        }
        for block in &self.segments {
            text.push_str("\nMETA_START\n");
            for (keyword, value) in &block.metadata {
                pair(&mut text, keyword, value);
            }
            text.push_str("META_STOP\n\nDATA_START\n");
            for line in &block.lines {
                text.push_str(&line.epoch);
                // Writing to a String cannot fail, here and below.
                for component in line.quaternion {
                    let _ = write!(text, " {component:.15}");
                }
                for component in line.velocity.iter().filter(|_| self.rates) {
                    let _ = write!(text, " {component:.14}");
                }
                text.push('\n');
            }
            text.push_str("DATA_STOP\n");
        }
        text
    }

    /// XML after the schema of navigation data messages, version 4.
    pub(super) fn xml(&self) -> String {
        let mut text = concat!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
            "<aem xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" ",
            "xsi:noNamespaceSchemaLocation=\"https://sanaregistry.org/r/ndmxml_unqualified/",
            "ndmxml-4.0.0-master-4.0.xsd\" id=\"CCSDS_AEM_VERS\" version=\"2.0\">\n",
            "<header>\n",
        )
        .to_owned();
        for (keyword, value) in &self.header {
            element(&mut text, keyword, value);
        }
        text.push_str("</header>\n<body>\n");
        for block in &self.segments {
            text.push_str("<segment>\n<metadata>\n");
            for (keyword, value) in &block.metadata {
                element(&mut text, keyword, value);
            }
            text.push_str("</metadata>\n<data>\n");
            for line in &block.lines {
                self.state(&mut text, line);
            }
            text.push_str("</data>\n</segment>\n");
        }
        text.push_str("</body>\n</aem>\n");
        text
    }

    fn state(&self, text: &mut String, line: &DataLine) {
        let name = if self.rates {
            "quaternionAngVel"
        } else {
            "quaternionEphemeris"
        };
        let [x, y, z, w] = line.quaternion;
        let _ = write!(
            text,
            "<attitudeState><{name}><EPOCH>{}</EPOCH><quaternion><Q1>{x:.15}</Q1><Q2>{y:.15}</Q2>\
             <Q3>{z:.15}</Q3><QC>{w:.15}</QC></quaternion>",
            line.epoch
        );
        if self.rates {
            text.push_str("<angVel>");
            for (axis, component) in ["X", "Y", "Z"].iter().zip(line.velocity) {
                let _ = write!(
                    text,
                    "<ANGVEL_{axis} units=\"deg/s\">{component:.14}</ANGVEL_{axis}>"
                );
            }
            text.push_str("</angVel>");
        }
        let _ = writeln!(text, "</{name}></attitudeState>");
    }
}

fn pair(text: &mut String, keyword: &str, value: &str) {
    // Comments have no equals sign.
    let _ = match keyword {
        "COMMENT" => writeln!(text, "COMMENT {value}"),
        _ => writeln!(text, "{keyword} = {value}"),
    };
}

fn element(text: &mut String, name: &str, value: &str) {
    let value = value.replace('&', "&amp;").replace('<', "&lt;");
    // "]]>" must not stand in text.
    let value = value.replace('>', "&gt;");
    let _ = writeln!(text, "<{name}>{value}</{name}>");
}
