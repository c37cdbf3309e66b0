//! The picture of a study of envelopes: a projection of the envelopes, and the shares of them that
//! the slews of a turn use (RW/CMG thesis, figures 71 to 76).

mod projection;
#[cfg(test)]
mod tests;
mod written;

pub(crate) use written::WrittenEnvelopes;

use super::canvas::{Canvas, Ink, Pen, PlotArea, SERIES};
use super::panel::{self, GAP, Panel};
use super::scale::minus;
use super::{HEAD, MARGIN, WIDTH};
use nalgebra::Vector3;
use projection::ProjectedPath;
use written::{Array, WrittenEnvelopeSlew, WrittenPolytope, WrittenTurn};

const SOLIDS: f64 = 400.0;
/// Space for the legend, and for the labels beside a panel.
const LEGEND: f64 = 30.0;
const VALUES: f64 = 60.0;
/// Number of parts of a straight piece of a path at whose ends the share of an envelope is
/// evaluated.
const PARTS: usize = 16;

/// The picture of a study's envelopes with one of its turns, counted from zero.
///
/// # Errors
///
/// A message, when there is no such turn.
pub(crate) fn svg(study: &WrittenEnvelopes, turn: usize) -> Result<String, String> {
    let known = study.turns.len();
    if turn > 0 && turn >= known {
        return Err(format!("there is no turn {turn}: the study has {known}"));
    }
    let turn = study.turns.get(turn);
    let slews = turn.map(WrittenTurn::slews).unwrap_or_default();
    let rows = if slews.is_empty() { 0.0 } else { 2.0 };
    let height = HEAD + LEGEND + SOLIDS + rows * (panel::HEIGHT + GAP) + 48.0;
    let summary = turn.map_or_else(String::new, described);
    let mut canvas = Canvas::new(
        WIDTH,
        height,
        &format!("Envelopes of the wheels. {summary}"),
    );
    canvas.text(MARGIN, 44.0, Ink::TITLE, "Envelopes of the wheels");
    canvas.text(MARGIN, 68.0, Ink::QUIET, &summary);
    legend(&mut canvas, &slews);
    let momentum = study.momentum.as_ref().map(|array| Column {
        title: "Momentum",
        array,
        ways: slews.iter().map(WrittenEnvelopeSlew::momenta).collect(),
        joined: true,
    });
    let torque = Column {
        title: "Torque",
        array: &study.torque,
        ways: slews.iter().map(WrittenEnvelopeSlew::torques).collect(),
        joined: false,
    };
    let longest = slews.iter().map(|slew| slew.duration_s);
    let longest = longest.fold(0.0, f64::max);
    let width = (WIDTH - 2.0 * MARGIN) / 2.0;
    for (i, column) in momentum.iter().chain([&torque]).enumerate() {
        let frame = PlotArea {
            left: MARGIN + i as f64 * width,
            top: HEAD + LEGEND,
            width,
            height: SOLIDS,
        };
        column.draw(&mut canvas, frame, longest);
    }
    Ok(canvas.finish())
}

/// The turn with its slews in a line.
fn described(turn: &WrittenTurn) -> String {
    let [x, y, z] = turn.axis;
    let angle = turn.angle_rad.to_degrees();
    let axis = minus(&format!("({x:.3}, {y:.3}, {z:.3})"));
    let mut parts = vec![format!("{angle:.1} degrees about {axis}")];
    let slews = turn.slews().into_iter();
    parts.extend(slews.map(|slew| format!("{} {:.2} s", slew.name, slew.duration_s)));
    parts.join("  \u{b7}  ")
}

fn legend(canvas: &mut Canvas, slews: &[WrittenEnvelopeSlew<'_>]) {
    let y = HEAD + 12.0;
    let mut x = MARGIN;
    for (slew, colour) in slews.iter().zip(SERIES.iter().cycle()) {
        canvas.line((x, y - 4.0), (x + 16.0, y - 4.0), Pen::new(colour, 2.5));
        canvas.text(x + 22.0, y, Ink::SMALL, slew.name);
        x += 50.0 + 6.5 * slew.name.chars().count() as f64;
    }
}

/// One of the two quantities, with a path per slew.
struct Column<'a> {
    title: &'static str,
    array: &'a Array,
    ways: Vec<Vec<(f64, Vector3<f64>)>>,
    joined: bool,
}

impl Column<'_> {
    fn draw(&self, canvas: &mut Canvas, frame: PlotArea, duration: f64) {
        let Array {
            unit,
            full,
            pseudo_inverse,
        } = self.array;
        let title = format!("{}, {unit}", self.title);
        canvas.text(frame.left, frame.top + 14.0, Ink::HEADING, &title);
        for (line, (name, of)) in [("full", full), ("pseudo-inverse, orange", pseudo_inverse)]
            .into_iter()
            .enumerate()
        {
            let words = format!(
                "{name}: sphere inside {:.3}, of equal volume {:.3}, at most {:.3}",
                of.inscribed_radius, of.equal_volume_radius, of.greatest_radius
            );
            let y = frame.top + 32.0 + 16.0 * line as f64;
            canvas.text(frame.left, y, Ink::SMALL, &words);
        }
        let solid = PlotArea {
            top: frame.top + 48.0,
            height: frame.height - 48.0,
            ..frame
        };
        let ways: Vec<_> = self
            .ways
            .iter()
            .map(|way| ProjectedPath {
                points: way.iter().map(|(_, vector)| *vector).collect(),
                joined: self.joined,
            })
            .collect();
        projection::draw(canvas, solid, self.array, &ways);
        if self.ways.is_empty() {
            return;
        }
        let shares = [
            ("share of the full envelope", full),
            ("share of the pseudo-inverse envelope", pseudo_inverse),
        ];
        let mut top = frame.top + frame.height + GAP;
        for (unit, of) in shares {
            let panel = Panel {
                title: self.title,
                unit,
                names: Vec::new(),
                curves: self.ways.iter().map(|way| self.shares(way, of)).collect(),
                limits: vec![(f64::NEG_INFINITY, 1.0)],
                alarms: Vec::new(),
            };
            let place = PlotArea {
                left: frame.left + VALUES,
                top,
                width: frame.width - VALUES - 16.0,
                height: panel::HEIGHT,
            };
            panel::draw(canvas, place, &panel, (place.times(duration), &[]));
            top += panel::HEIGHT + GAP;
        }
    }

    /// The share of an envelope along a path. Between joined points it has a kink where another
    /// facet becomes active; a jump has no points in between.
    fn shares(&self, way: &[(f64, Vector3<f64>)], of: &WrittenPolytope) -> Vec<(f64, f64)> {
        if !self.joined {
            return way.iter().map(|(time, at)| (*time, of.share(at))).collect();
        }
        let pieces = way.windows(2).flat_map(|pair| {
            let [(begin, from), (end, to)] = [pair[0], pair[1]];
            (0..=PARTS).map(move |part| {
                let s = part as f64 / PARTS as f64;
                (begin + (end - begin) * s, of.share(&from.lerp(&to, s)))
            })
        });
        pieces.collect()
    }
}
