//! Timelines: a strip of slews and rests, and quantities over the same time axis.

use super::canvas::{Canvas, Ink, Pen, PlotArea, WARM};
use super::panel::{self, Panel};
use super::schedule;
use super::written::{Record, WrittenPlan, WrittenState};
use slewplan_solver::model::cone::Cone;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spacecraft::Spacecraft;

/// Greatest number of cones whose clearance is drawn: more names than these would overlap.
const MAX_CONES_DRAWN: usize = 4;
/// Height of the windows behind the phases, which are lower.
const WINDOW_HEIGHT: f64 = 18.0;

/// Panels of body rates, wheel speeds and wheel torques, in this order; a scenario adds the limits, and
/// a panel of the clearance of its cones where it has any.
pub(super) fn panels(record: &Record<'_>, scenario: Option<&Scenario>) -> Vec<Panel> {
    let mut panels = of_motion(record, scenario.map(Scenario::spacecraft));
    panels.extend(scenario.and_then(|it| clearances(record, it.cones())));
    panels
}

/// Panels of body rates, wheel speeds and wheel torques.
fn of_motion(record: &Record<'_>, craft: Option<&Spacecraft>) -> Vec<Panel> {
    let states = record.states;
    let wheels = record.torques.len();
    let names = |word: &str| (0..wheels).map(|i| format!("{word} {i}")).collect();
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
        let points = record.torques[wheel].iter();
        points.map(|(time, torque)| (*time, torque * 1e3))
    };
    let rate_limits = |craft: &Spacecraft| {
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
            alarms: Vec::new(),
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
            alarms: Vec::new(),
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
            alarms: Vec::new(),
        },
    ]
}

/// The clearance of the cones that the motion comes closest to, if there are any.
fn clearances(record: &Record<'_>, cones: &[Cone]) -> Option<Panel> {
    let curve = |cone: &Cone| {
        let clearance = |s: &WrittenState| (s.time_s, cone.clearance(&s.attitude()).to_degrees());
        let curve: Vec<(f64, f64)> = record.states.iter().map(clearance).collect();
        let least = curve.iter().map(|(_, angle)| *angle).reduce(f64::min);
        let name = format!("{} {}", cone.boresight, cone.pointer());
        (least.unwrap_or(f64::INFINITY), name, curve)
    };
    let mut nearest: Vec<_> = cones.iter().map(curve).collect();
    nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
    nearest.truncate(MAX_CONES_DRAWN);
    let (names, curves): (Vec<_>, Vec<_>) = nearest
        .into_iter()
        .map(|(_, name, curve)| (name, curve))
        .unzip();
    (!names.is_empty()).then(|| Panel {
        title: "Clearance of cones",
        unit: "deg",
        limits: vec![(0.0, f64::INFINITY); names.len()],
        names,
        curves,
        alarms: Vec::new(),
    })
}

/// Draws panels one below the other, beginning at a height.
pub(super) fn stack(canvas: &mut Canvas, frame: PlotArea, panels: &[Panel], record: &Record<'_>) {
    let passages = record.passages.iter();
    let stays: Vec<_> = passages.map(|it| (it.time_s, it.departure_s)).collect();
    let times = frame.times(record.total_time_s);
    for (index, panel) in panels.iter().enumerate() {
        let frame = PlotArea {
            top: frame.top + index as f64 * (panel::HEIGHT + panel::GAP),
            height: panel::HEIGHT,
            ..frame
        };
        panel::draw(canvas, frame, panel, (times, &stays));
    }
}

/// Height of a number of panels one below the other.
pub(super) fn height(panels: &[Panel]) -> f64 {
    panels.len() as f64 * (panel::HEIGHT + panel::GAP)
}

/// Slews, waits and rests, with the targets numbered in visiting order; a scenario adds the windows.
pub(super) fn strip(
    canvas: &mut Canvas,
    frame: PlotArea,
    plan: &WrittenPlan,
    scenario: Option<&Scenario>,
) {
    let height = frame.height;
    if let Some(scenario) = scenario {
        let behind = PlotArea {
            top: frame.top + height - WINDOW_HEIGHT,
            height: WINDOW_HEIGHT,
            ..frame
        };
        schedule::windows(canvas, behind, plan, scenario);
    }
    let times = frame.times(plan.total_time_s);
    let bar = |begin: f64, end: f64| PlotArea {
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
    let row = PlotArea {
        top: frame.top + height - 12.0,
        height: 12.0,
        ..frame
    };
    schedule::waits(canvas, row, plan);
    let mut last = f64::NEG_INFINITY;
    for (index, passage) in plan.passages.iter().enumerate() {
        canvas.rectangle(bar(passage.time_s, passage.departure_s), WARM, 0.0);
        let x = times.at(passage.time_s);
        let pen = Pen::new("#14202B", 1.5);
        canvas.line((x, frame.top + height - 14.0), (x, frame.top + height), pen);
        let words = format!("{} {}", index + 1, passage.target);
        // Names that would overlap are left out.
        let half = 3.5 * words.chars().count() as f64;
        if x - half > last + 6.0 {
            canvas.text(x, frame.top + height - 19.0, Ink::SMALL.middle(), &words);
            last = x + half;
        }
    }
    canvas.text(
        frame.left - 10.0,
        frame.top + height - 2.0,
        Ink::SMALL.end(),
        "slews",
    );
}
