//! What happens when: a strip of slews and rests, and quantities over the same time axis.

use super::canvas::{ALARM, Canvas, FAINT, Frame, Ink, LINE, Pen, SERIES, WARM, minus};
use super::scale::Scale;
use super::written::WrittenPlan;
use slewplan_solver::scenario::Scenario;

/// A limit this many times the largest value is told in words, not drawn.
const FAR: f64 = 2.5;
/// Room between the largest value and the frame, as a share.
const AIR: f64 = 0.1;

/// One quantity with several curves.
#[derive(Debug)]
pub(super) struct Panel {
    title: &'static str,
    unit: &'static str,
    names: Vec<String>,
    curves: Vec<Vec<(f64, f64)>>,
    /// Lower and upper limit of each curve.
    limits: Vec<(f64, f64)>,
}

/// Body rates, wheel speeds and wheel torques.
pub(super) fn panels(plan: &WrittenPlan, scenario: Option<&Scenario>) -> Vec<Panel> {
    let states = &plan.trajectory.states;
    let wheels = plan.wheels();
    let names = |word: &str| (0..wheels).map(|i| format!("{word} {i}")).collect();
    let craft = scenario.map(Scenario::spacecraft);
    let rate = |axis: usize| {
        states
            .iter()
            .map(move |s| (s.time_s, s.body_rate_rad_s[axis].to_degrees()))
    };
    let speed = |wheel: usize| {
        states
            .iter()
            .map(move |s| (s.time_s, s.wheel_speed_rad_s[wheel]))
    };
    let torque = |wheel: usize| {
        plan.trajectory.controls.iter().flat_map(move |control| {
            let value = control.wheel_torque_nm[wheel] * 1e3;
            let end = control.start_s + control.duration_s;
            [(control.start_s, value), (end, value)]
        })
    };
    let rate_limits = |craft: &slewplan_solver::spacecraft::Spacecraft| {
        let norm = craft.max_rate_norm();
        let each = craft.max_rate().map(|limit| limit.min(norm).to_degrees());
        each.iter().map(|limit| (-limit, *limit)).collect()
    };
    vec![
        Panel {
            title: "Body rate",
            unit: "deg/s",
            names: ["x", "y", "z"].map(str::to_owned).into(),
            curves: (0..3).map(|axis| rate(axis).collect()).collect(),
            limits: craft.map_or_else(Vec::new, rate_limits),
        },
        Panel {
            title: "Wheel speed",
            unit: "rad/s",
            names: names("wheel"),
            curves: (0..wheels).map(|wheel| speed(wheel).collect()).collect(),
            limits: craft.map_or_else(Vec::new, |craft| {
                let wheels = craft.wheels().iter();
                wheels.map(|w| (-w.max_speed, w.max_speed)).collect()
            }),
        },
        Panel {
            title: "Motor torque on the wheel",
            unit: "mN m",
            names: names("wheel"),
            curves: (0..wheels).map(|wheel| torque(wheel).collect()).collect(),
            limits: craft.map_or_else(Vec::new, |craft| {
                let wheels = craft.wheels().iter();
                wheels
                    .map(|w| (w.min_torque * 1e3, w.max_torque * 1e3))
                    .collect()
            }),
        },
    ]
}

fn time_scale(frame: Frame, plan: &WrittenPlan) -> Scale {
    Scale {
        least: 0.0,
        most: plan.total_time_s,
        from: frame.left,
        to: frame.left + frame.width,
    }
}

/// Slews and rests, with the targets numbered in visiting order.
pub(super) fn strip(canvas: &mut Canvas, frame: Frame, plan: &WrittenPlan, height: f64) {
    let times = time_scale(frame, plan);
    let bar = |begin: f64, end: f64| Frame {
        left: times.at(begin),
        top: frame.top + height - 12.0,
        width: times.at(end) - times.at(begin),
        height: 12.0,
    };
    for leg in &plan.legs {
        canvas.rectangle(
            bar(leg.start_s, leg.start_s + leg.duration_s),
            "#CFE3F1",
            0.0,
        );
    }
    let mut last = f64::NEG_INFINITY;
    for (index, passage) in plan.passages.iter().enumerate() {
        canvas.rectangle(bar(passage.time_s, passage.departure_s), WARM, 0.0);
        let x = times.at(passage.time_s);
        let pen = Pen::new("#14202B", 1.5);
        canvas.line((x, frame.top + height - 14.0), (x, frame.top + height), pen);
        let words = format!("{} {}", index + 1, passage.target);
        // Names that would lie upon each other are left out.
        if x - last > 7.0 * words.chars().count() as f64 + 6.0 {
            canvas.text(x, frame.top + height - 19.0, Ink::SMALL.middle(), &words);
            last = x;
        }
    }
    canvas.text(
        frame.left - 10.0,
        frame.top + height - 2.0,
        Ink::SMALL.end(),
        "slews",
    );
}

/// One panel under the strip.
pub(super) fn draw(canvas: &mut Canvas, frame: Frame, panel: &Panel, plan: &WrittenPlan) {
    let times = time_scale(frame, plan);
    let (least, most) = panel.range();
    let values = Scale {
        least,
        most,
        from: frame.top + frame.height,
        to: frame.top,
    };
    grid(canvas, frame, (times, values));
    for passage in &plan.passages {
        let x = times.at(passage.time_s);
        let pen = Pen::new(LINE, 1.0).dashed();
        canvas.line((x, frame.top), (x, frame.top + frame.height), pen);
        let stay = Frame {
            left: x,
            width: times.at(passage.departure_s) - x,
            ..frame
        };
        if stay.width > 0.5 {
            canvas.rectangle(stay, "#FDF1DC", 0.0);
        }
    }
    for (limit, colour) in panel.lines() {
        if (least..=most).contains(&limit) {
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

fn grid(canvas: &mut Canvas, frame: Frame, (times, values): (Scale, Scale)) {
    let (ticks, digits) = values.ticks(5.0);
    for tick in ticks {
        let y = values.at(tick);
        let pen = Pen::new(FAINT, 1.0);
        canvas.line((frame.left, y), (frame.left + frame.width, y), pen);
        let words = minus(&format!("{tick:.digits$}"));
        canvas.text(frame.left - 8.0, y + 4.0, Ink::SMALL.end(), &words);
    }
    let (ticks, digits) = times.ticks(12.0);
    let bottom = frame.top + frame.height;
    canvas.text(
        frame.left - 24.0,
        bottom + 16.0,
        Ink::SMALL.end(),
        "time, s",
    );
    for tick in ticks {
        let x = times.at(tick);
        canvas.line((x, bottom), (x, bottom + 4.0), Pen::new(LINE, 1.0));
        let words = format!("{tick:.digits$}");
        canvas.text(x, bottom + 16.0, Ink::SMALL.middle(), &words);
    }
    canvas.line(
        (frame.left, bottom),
        (frame.left + frame.width, bottom),
        Pen::new(LINE, 1.0),
    );
}

fn legend(canvas: &mut Canvas, frame: Frame, panel: &Panel) {
    let baseline = frame.top - 8.0;
    let title = format!("{}, {}", panel.title, panel.unit);
    canvas.text(frame.left, baseline, Ink::HEADING, &title);
    let mut right = frame.left + frame.width;
    if let Some(words) = panel.limit_words() {
        canvas.text(right, baseline, Ink::SMALL.end().coloured(ALARM), &words);
        right -= 7.0 * words.chars().count() as f64 + 14.0;
    }
    let names = panel.names.iter().zip(SERIES.iter().cycle());
    for (name, colour) in names.collect::<Vec<_>>().into_iter().rev() {
        canvas.text(right, baseline, Ink::SMALL.end(), name);
        right -= 6.5 * name.chars().count() as f64 + 6.0;
        canvas.line(
            (right - 16.0, baseline - 4.0),
            (right, baseline - 4.0),
            Pen::new(colour, 2.5),
        );
        right -= 30.0;
    }
}

impl Panel {
    fn largest(&self) -> f64 {
        let values = self.curves.iter().flatten();
        values.map(|(_, value)| value.abs()).fold(0.0, f64::max)
    }

    /// Whether a limit is near enough to be drawn.
    fn is_shown(&self, limit: f64) -> bool {
        limit.is_finite() && limit.abs() <= FAR * self.largest()
    }

    /// Least and largest value of the axis.
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

    /// What the limit lines are, or where they would be.
    fn limit_words(&self) -> Option<String> {
        let (low, high) = *self.limits.first()?;
        if !self.has_one_limit() {
            return (!self.lines().is_empty()).then(|| "limits dashed".to_owned());
        }
        if !high.is_finite() {
            return Some("no limit".to_owned());
        }
        let figure = |value: f64| {
            format!("{value:.3}")
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        };
        let words = if (low + high).abs() < 1e-12 * high {
            format!("limit \u{b1}{}", figure(high))
        } else {
            minus(&format!("limits {} and {}", figure(low), figure(high)))
        };
        let beyond = if self.is_shown(high) { "" } else { ", beyond" };
        Some(words + beyond)
    }
}
