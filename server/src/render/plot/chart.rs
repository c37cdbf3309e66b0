//! Diagrams: curves of one quantity over another.

use super::axes;
use super::canvas::{Canvas, Ink, LINE, Pen, PlotArea};
use super::scale::Scale;
use super::scale::minus;

/// Margin between the extreme values and the frame, as a share.
const AIR: f64 = 0.06;
/// Space for labels left of the frame, below it and above it.
const LEFT: f64 = 60.0;
const BELOW: f64 = 42.0;
const ABOVE: f64 = 22.0;
/// Width of the picture for one tick of the abscissa, height for one of the ordinate.
const COLUMN: f64 = 70.0;
const ROW: f64 = 55.0;
const INK: &str = "#14202B";

/// A diagram.
#[derive(Debug)]
pub(super) struct Chart {
    /// Title of the ordinate, with its unit.
    pub(super) title: String,
    /// Title of the abscissa, with its unit.
    pub(super) across: String,
    /// Whether values that span decades have logarithmic axes.
    pub(super) logarithms: bool,
    pub(super) curves: Vec<Curve>,
    /// Values of the abscissa to mark.
    pub(super) marks: Vec<f64>,
    /// Values of the ordinate to mark, and where curves cross them.
    pub(super) levels: Vec<f64>,
}

/// Style of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stroke {
    Line,
    Dashes,
    /// A line with a dot at each point.
    Dotted,
    /// Only a dot at each point.
    Dots,
}

#[derive(Debug)]
pub(super) struct Curve {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) colour: &'static str,
    pub(super) stroke: Stroke,
}

/// Draws a diagram with its labels and titles into an area.
pub(super) fn draw(canvas: &mut Canvas, place: PlotArea, chart: &Chart) {
    let frame = PlotArea {
        left: place.left + LEFT,
        top: place.top + ABOVE,
        width: place.width - LEFT,
        height: place.height - ABOVE - BELOW,
    };
    let (right, bottom) = (frame.left + frame.width, frame.top + frame.height);
    let scales = chart.scales(frame);
    let about = (frame.width / COLUMN, frame.height / ROW);
    axes::grid(canvas, frame, scales, about);
    canvas.text(place.left, place.top + 8.0, Ink::HEADING, &chart.title);
    canvas.text(right, bottom + 34.0, Ink::SMALL.end(), &chart.across);
    let (across, up) = scales;
    for &mark in chart.marks.iter().filter(|mark| across.holds(**mark)) {
        let x = across.at(mark);
        let pen = Pen::new(LINE, 1.2).dashed();
        canvas.line((x, frame.top), (x, bottom), pen);
        canvas.text(x + 4.0, frame.top + 12.0, Ink::SMALL, &significant(mark));
    }
    for curve in &chart.curves {
        draw_curve(canvas, scales, curve);
    }
    for &level in chart.levels.iter().filter(|level| up.holds(**level)) {
        let y = up.at(level);
        let pen = Pen::new(LINE, 1.2).dashed();
        canvas.line((frame.left, y), (right, y), pen);
        canvas.text(right, y - 5.0, Ink::SMALL.end(), &significant(level));
        for curve in &chart.curves {
            draw_crossings(canvas, scales, curve, level);
        }
    }
}

fn draw_curve(canvas: &mut Canvas, (across, up): (Scale, Scale), curve: &Curve) {
    let points = curve.points.iter();
    let points: Vec<_> = points.map(|(x, y)| (across.at(*x), up.at(*y))).collect();
    let pen = Pen::new(curve.colour, 1.8);
    match curve.stroke {
        Stroke::Line | Stroke::Dotted => canvas.path(&points, pen),
        Stroke::Dashes => canvas.path(&points, pen.dashed()),
        Stroke::Dots => {}
    }
    if matches!(curve.stroke, Stroke::Dotted | Stroke::Dots) {
        for point in points {
            canvas.circle(point, 2.6, curve.colour, Pen::new("#FFFFFF", 0.8));
        }
    }
}

/// Marks where the drawn polyline of a curve crosses a level.
fn draw_crossings(canvas: &mut Canvas, (across, up): (Scale, Scale), curve: &Curve, level: f64) {
    if curve.stroke != Stroke::Dotted {
        return;
    }
    let y = up.at(level);
    for pair in curve.points.windows(2) {
        let ends = [up.at(pair[0].1) - y, up.at(pair[1].1) - y];
        // A pair on the same side does not cross, nor does one that lies on the level.
        if (ends[0] > 0.0) == (ends[1] > 0.0) {
            continue;
        }
        let share = ends[0] / (ends[0] - ends[1]);
        let (from, to) = (across.at(pair[0].0), across.at(pair[1].0));
        let x = from + share * (to - from);
        canvas.circle((x, y), 4.0, "none", Pen::new(INK, 1.4));
        let words = significant(across.value(x));
        canvas.text(x + 7.0, y - 7.0, Ink::SMALL.coloured(INK), &words);
    }
}

/// A number with four significant digits, as many as can be read off a diagram.
pub(super) fn significant(value: f64) -> String {
    let text = if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        let whole = value.abs().max(1e-3).log10().floor() + 1.0;
        let digits = (4.0 - whole).clamp(0.0, 6.0);
        // From 0 to 6.
        let digits = (0..6_u8).filter(|d| f64::from(*d) < digits).count();
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.3e}")
    };
    minus(&text)
}

impl Chart {
    fn scales(&self, frame: PlotArea) -> (Scale, Scale) {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let scale = if self.logarithms {
            Scale::around
        } else {
            Scale::around_linear
        };
        let (bottom, right) = (frame.top + frame.height, frame.left + frame.width);
        let mut across = points().map(|point| point.0);
        let mut up = points().map(|point| point.1);
        (
            scale(&mut across, 0.5 * AIR, (frame.left, right)),
            scale(&mut up, AIR, (bottom, frame.top)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_significant_digits() {
        let texts = [910.1, 28.364, 0.013_567, 1234.5, 0.0, -2.5, 1e-7].map(significant);
        assert_eq!(
            texts,
            [
                "910.1",
                "28.36",
                "0.01357",
                "1234",
                "0",
                "\u{2212}2.5",
                "1.000e\u{2212}7"
            ]
        );
    }

    #[test]
    fn crossings_of_a_level_are_labelled() {
        let mut canvas = Canvas::new(400.0, 300.0, "");
        let place = PlotArea {
            left: 0.0,
            top: 0.0,
            width: 400.0,
            height: 300.0,
        };
        let curve = |stroke| Curve {
            points: vec![(0.0, 0.0), (10.0, 5.0), (20.0, 0.0)],
            colour: INK,
            stroke,
        };
        let mut chart = Chart {
            title: "up".into(),
            across: "across".into(),
            logarithms: true,
            curves: vec![curve(Stroke::Dotted), curve(Stroke::Dashes)],
            marks: vec![12.25, 30.0],
            levels: vec![1.25],
        };
        draw(&mut canvas, place, &chart);
        let drawn = canvas.finish();
        for words in ["2.5", "17.5", "12.25", "1.25"] {
            assert_eq!(drawn.matches(&format!(">{words}<")).count(), 1, "{words}");
        }
        // Out of the frame.
        assert!(!drawn.contains(">30<"));
        chart.levels = vec![7.0];
        let mut canvas = Canvas::new(400.0, 300.0, "");
        draw(&mut canvas, place, &chart);
        assert!(!canvas.finish().contains(">17.5<"));
    }
}
