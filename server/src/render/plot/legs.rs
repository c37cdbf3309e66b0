//! Bars of every leg and of the eigenaxis slew between the same attitudes.

use super::canvas::{Canvas, Ink, Pen, PlotArea, SERIES};
use super::scale::minus;
use super::written::{WrittenLeg, WrittenPlan};

const HIGHEST: f64 = 42.0;
const LOWEST: f64 = 15.0;
/// Width of a character of a name, and the gap between names and bars.
const CHARACTER: f64 = 7.2;
const GAP: f64 = 12.0;
/// Right ends of the columns of numbers, from the right edge.
const OURS: f64 = 150.0;
const THEIRS: f64 = 64.0;
const SAVED: f64 = 0.0;
const NUMBERS: f64 = OURS + 70.0;
/// Thickness of a bar as a share of its row.
const THICK: f64 = 0.62;
/// Maximum number of characters of a name.
const LONGEST: usize = 9;

/// Draws as many bars as fit.
pub(super) fn draw(canvas: &mut Canvas, frame: PlotArea, plan: &WrittenPlan) {
    let baseline = frame.top + 14.0;
    canvas.text(frame.left, baseline, Ink::HEADING, "Slews");
    let right = frame.left + frame.width;
    for (words, column) in [
        ("slew, s", OURS),
        ("eigenaxis, s", THEIRS),
        ("saved", SAVED),
    ] {
        canvas.text(right - column, baseline, Ink::SMALL.end(), words);
    }
    let room = frame.height - 34.0;
    let count = plan.legs.len();
    let height = (room / (count as f64).max(1.0)).clamp(LOWEST, HIGHEST);
    let shown = plan.legs.iter().enumerate().take_while(|(index, _)| {
        // The last line is reserved for the number of bars left out.
        let lines = *index as f64 + if *index + 1 < count { 2.0 } else { 1.0 };
        lines * height <= room + 1e-9
    });
    let longest = |leg: &WrittenLeg| leg.duration_s.max(leg.eigenaxis_duration_s.unwrap_or(0.0));
    let most = plan.legs.iter().map(longest).fold(1e-9, f64::max);
    let characters = plan.legs.iter().map(|leg| names(leg).chars().count());
    let widest = characters.max().unwrap_or(0) as f64 * CHARACTER + GAP;
    let bars = PlotArea {
        left: frame.left + widest,
        width: frame.width - widest - NUMBERS,
        ..frame
    };
    let scale = bars.width / most;
    let mut top = frame.top + 28.0;
    let mut drawn = 0;
    for (_, leg) in shown {
        let place = PlotArea {
            top,
            height,
            ..bars
        };
        row(canvas, frame.left, place, leg, scale);
        top += height;
        drawn += 1;
    }
    if drawn < count {
        let words = format!("and {} more", count - drawn);
        canvas.text(frame.left, top + height * 0.65, Ink::SMALL, &words);
    }
}

/// A row: names at the left, bars of so many pixels a second in their place, numbers right of them.
fn row(canvas: &mut Canvas, left: f64, place: PlotArea, leg: &WrittenLeg, scale: f64) {
    let middle = place.top + 0.5 * place.height + 4.0;
    canvas.text(left, middle, Ink::PLAIN, &names(leg));
    let bar = |length: f64| PlotArea {
        left: place.left,
        top: place.top + 0.5 * place.height * (1.0 - THICK),
        width: length * scale,
        height: place.height * THICK,
    };
    if let Some(eigenaxis) = leg.eigenaxis_duration_s {
        canvas.rectangle(bar(eigenaxis), "#CFE3F1", 2.0);
    }
    canvas.rectangle(bar(leg.duration_s), SERIES[0], 2.0);
    let right = place.left + place.width + NUMBERS;
    let ours = format!("{:.2}", leg.duration_s);
    canvas.text(right - OURS, middle, Ink::PLAIN.end(), &ours);
    let Some(eigenaxis) = leg.eigenaxis_duration_s else {
        return;
    };
    let whole = bar(eigenaxis);
    let edge = whole.left + whole.width;
    let mark = Pen::new(SERIES[0], 1.0);
    canvas.line((edge, whole.top), (edge, whole.top + whole.height), mark);
    let theirs = format!("{eigenaxis:.2}");
    canvas.text(right - THEIRS, middle, Ink::QUIET.end(), &theirs);
    let saved = format!("{:.1} %", 100.0 * (1.0 - leg.duration_s / eigenaxis));
    canvas.text(right - SAVED, middle, Ink::QUIET.end(), &minus(&saved));
}

fn names(leg: &WrittenLeg) -> String {
    format!("{} \u{2192} {}", short(&leg.from), short(&leg.to))
}

fn short(name: &str) -> String {
    if name.chars().count() <= LONGEST {
        return name.to_owned();
    }
    let kept: String = name.chars().take(LONGEST - 1).collect();
    kept + "\u{2026}"
}
