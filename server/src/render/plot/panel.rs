//! A panel of one quantity over time: curves, grid, limits, legend.

use super::axes::{self, Key};
use super::canvas::{ALARM, Canvas, Ink, LINE, Pen, PlotArea, SERIES};
use super::scale::Scale;
use super::scale::minus;

/// Height of a panel, and space between two.
pub(super) const HEIGHT: f64 = 150.0;
pub(super) const GAP: f64 = 44.0;
/// A limit beyond this multiple of the largest value is noted as text, not drawn.
const FAR: f64 = 2.5;
/// Margin between the largest value and the frame, as a share.
const AIR: f64 = 0.1;
const ALARM_HEIGHT: f64 = 5.0;
/// Width per tick of the time axis.
const TICK: f64 = 89.0;

/// One quantity with several curves.
#[derive(Debug)]
pub(super) struct Panel {
    pub(super) title: &'static str,
    pub(super) unit: &'static str,
    pub(super) names: Vec<String>,
    pub(super) curves: Vec<Vec<(f64, f64)>>,
    /// Lower and upper limit of each curve.
    pub(super) limits: Vec<(f64, f64)>,
    /// Highlighted spans of time, s.
    pub(super) alarms: Vec<(f64, f64)>,
}

/// One panel over a time axis; rests, from a time to a time, are shaded.
pub(super) fn draw(
    canvas: &mut Canvas,
    frame: PlotArea,
    panel: &Panel,
    (times, stays): (Scale, &[(f64, f64)]),
) {
    let bottom = frame.top + frame.height;
    let values = Scale::linear(panel.range(), (bottom, frame.top));
    axes::grid(canvas, frame, (times, values), (frame.width / TICK, 5.0));
    canvas.text(
        frame.left - 24.0,
        bottom + 16.0,
        Ink::SMALL.end(),
        "time, s",
    );
    for (begin, end) in stays {
        let x = times.at(*begin);
        let pen = Pen::new(LINE, 1.0).dashed();
        canvas.line((x, frame.top), (x, bottom), pen);
        let stay = PlotArea {
            left: x,
            width: times.at(*end) - x,
            ..frame
        };
        if stay.width > 0.5 {
            canvas.rectangle(stay, "#FDF1DC", 0.0);
        }
    }
    for &(begin, end) in &panel.alarms {
        let mark = PlotArea {
            left: times.at(begin),
            // A moment is to be seen too.
            width: (times.at(end) - times.at(begin)).max(1.0),
            height: ALARM_HEIGHT,
            ..frame
        };
        canvas.rectangle(mark, ALARM, 0.0);
    }
    for (limit, colour) in panel.lines() {
        if values.holds(limit) {
            let y = values.at(limit);
            let pen = Pen::new(colour, 1.4).dashed();
            canvas.line((frame.left, y), (frame.left + frame.width, y), pen);
        }
    }
    for (curve, colour) in panel.curves.iter().zip(SERIES.iter().cycle()) {
        let points: Vec<_> = curve
            .iter()
            .map(|(t, v)| (times.at(*t), values.at(*v)))
            .collect();
        canvas.path(&points, Pen::new(colour, 1.5));
    }
    legend(canvas, frame, panel);
}

fn legend(canvas: &mut Canvas, frame: PlotArea, panel: &Panel) {
    let baseline = frame.top - 8.0;
    let title = format!("{}, {}", panel.title, panel.unit);
    canvas.text(frame.left, baseline, Ink::HEADING, &title);
    let mut right = frame.left + frame.width;
    if let Some(words) = panel.limit_words() {
        canvas.text(right, baseline, Ink::SMALL.end().coloured(ALARM), &words);
        right -= 7.0 * words.chars().count() as f64 + 14.0;
    }
    let names = panel.names.iter().zip(SERIES.iter().cycle());
    let keys: Vec<Key> = names
        .map(|(name, colour)| Key {
            name: name.clone(),
            colour,
        })
        .collect();
    axes::legend(canvas, (right, baseline), &keys);
}

impl Panel {
    /// Curves of one quantity without names and limits.
    pub(super) fn unlimited(
        title: &'static str,
        unit: &'static str,
        curves: Vec<Vec<(f64, f64)>>,
    ) -> Self {
        Self {
            title,
            unit,
            names: Vec::new(),
            curves,
            limits: Vec::new(),
            alarms: Vec::new(),
        }
    }

    fn largest(&self) -> f64 {
        let values = self.curves.iter().flatten();
        values.map(|(_, value)| value.abs()).fold(0.0, f64::max)
    }

    /// Whether a limit is close enough to the values to be drawn.
    fn is_shown(&self, limit: f64) -> bool {
        limit.is_finite() && limit.abs() <= FAR * self.largest()
    }

    /// Minimum and maximum of the axis.
    fn range(&self) -> (f64, f64) {
        let curves = self.curves.iter().flatten().map(|(_, value)| *value);
        let limits = self.limits.iter().flat_map(|(low, high)| [*low, *high]);
        let shown = limits.filter(|limit| self.is_shown(*limit));
        let (mut least, mut most) = (0.0_f64, 0.0_f64);
        for value in curves.chain(shown) {
            least = least.min(value);
            most = most.max(value);
        }
        let air = if most > least {
            AIR * (most - least)
        } else {
            1.0
        };
        (least - air, most + air)
    }

    /// Limits to draw: in one colour where all curves have the same, else in those of the curves.
    fn lines(&self) -> Vec<(f64, &'static str)> {
        let limits = self.limits.iter().zip(SERIES.iter().cycle());
        let mut lines = Vec::new();
        for ((low, high), colour) in limits {
            let colour = if self.has_one_limit() { ALARM } else { colour };
            for limit in [*low, *high] {
                if self.is_shown(limit) && !lines.contains(&(limit, colour)) {
                    lines.push((limit, colour));
                }
            }
        }
        lines
    }

    fn has_one_limit(&self) -> bool {
        self.limits.windows(2).all(|pair| pair[0] == pair[1])
    }

    /// The legend of the limit lines, or the limits that are too far to be drawn.
    fn limit_words(&self) -> Option<String> {
        let (low, high) = *self.limits.first()?;
        if !self.has_one_limit() {
            return (!self.lines().is_empty()).then(|| "limits dashed".to_owned());
        }
        let rounded = |value: f64| {
            format!("{value:.3}")
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        };
        if !high.is_finite() {
            let least = || format!("at least {}", minus(&rounded(low)));
            let words = low.is_finite().then(least);
            return Some(words.unwrap_or_else(|| "no limit".to_owned()));
        }
        let words = if !low.is_finite() {
            format!("limit {}", rounded(high))
        } else if (low + high).abs() < 1e-12 * high {
            format!("limit \u{b1}{}", rounded(high))
        } else {
            minus(&format!("limits {} and {}", rounded(low), rounded(high)))
        };
        let beyond = if self.is_shown(high) { "" } else { ", beyond" };
        Some(words + beyond)
    }
}
