//! Axes and legends of all diagrams.

use super::canvas::{Canvas, FAINT, Ink, LINE, Pen, PlotArea};
use super::scale::Scale;

/// Approximate width of a character of small text, and the gap between two entries of a legend.
const CHARACTER: f64 = 6.5;
const SWATCH: f64 = 16.0;
const APART: f64 = 24.0;

/// Grid lines at round values of the ordinate and ticks at those of the abscissa, about as many of
/// each as asked for.
pub(super) fn grid(
    canvas: &mut Canvas,
    frame: PlotArea,
    (across, up): (Scale, Scale),
    (columns, rows): (f64, f64),
) {
    let (right, bottom) = (frame.left + frame.width, frame.top + frame.height);
    for tick in up.ticks(rows) {
        let y = up.at(tick.value);
        canvas.line((frame.left, y), (right, y), Pen::new(FAINT, 1.0));
        canvas.text(frame.left - 8.0, y + 4.0, Ink::SMALL.end(), &tick.words);
    }
    for tick in across.ticks(columns) {
        let x = across.at(tick.value);
        canvas.line((x, bottom), (x, bottom + 4.0), Pen::new(LINE, 1.0));
        canvas.text(x, bottom + 16.0, Ink::SMALL.middle(), &tick.words);
    }
    canvas.line((frame.left, bottom), (right, bottom), Pen::new(LINE, 1.0));
}

/// An entry of a legend.
#[derive(Debug, Clone)]
pub(super) struct Key {
    pub(super) name: String,
    pub(super) colour: &'static str,
}

/// The names of curves in a row, aligned to the right at a point.
pub(super) fn legend(canvas: &mut Canvas, (right, baseline): (f64, f64), keys: &[Key]) {
    let mut right = right;
    for key in keys.iter().rev() {
        canvas.text(right, baseline, Ink::SMALL.end(), &key.name);
        right -= CHARACTER * key.name.chars().count() as f64 + 6.0;
        swatch(canvas, (right - SWATCH, baseline), key);
        right -= SWATCH + 14.0;
    }
}

/// The names of many curves in rows from the left; returns the baseline of the last.
pub(super) fn legend_rows(
    canvas: &mut Canvas,
    (left, baseline): (f64, f64),
    width: f64,
    keys: &[Key],
) -> f64 {
    let (mut x, mut y) = (left, baseline);
    for key in keys {
        let needed = SWATCH + 6.0 + CHARACTER * key.name.chars().count() as f64;
        if x > left && x + needed > left + width {
            (x, y) = (left, y + 20.0);
        }
        swatch(canvas, (x, y), key);
        canvas.text(x + SWATCH + 6.0, y, Ink::SMALL, &key.name);
        x += needed + APART;
    }
    y
}

fn swatch(canvas: &mut Canvas, (left, baseline): (f64, f64), key: &Key) {
    let y = baseline - 4.0;
    let pen = Pen::new(key.colour, 2.5);
    canvas.line((left, y), (left + SWATCH, y), pen);
}
