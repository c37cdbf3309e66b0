//! The trace of a boresight on the unit sphere of the reference frame, seen from outside.

use super::canvas::{ALARM, Canvas, FAINT, Ink, LINE, Pen, PlotArea, SERIES};
use super::view::DrawnBoresight;
use super::written::{WrittenPassage, WrittenPlan, WrittenState};
use nalgebra::Vector3;
use slewplan_solver::model::attitude::upward;
use slewplan_solver::model::cone::{Cone, ForbiddenCone};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::ReferenceFrame;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Space for the text below the sphere.
const RIM: f64 = 22.0;
/// Number of points of a circle on the sphere.
const CIRCLE: u32 = 96;
/// Length of the mean direction below which a trace has no preferred side.
const ASTRAY: f64 = 0.3;
/// Maximum and default elevation of the viewer, rad.
const STEEPEST: f64 = 1.2;
const USUAL: f64 = 0.45;

/// Orthographic view from a direction, the reference z axis upwards.
struct SphereView {
    towards: Vector3<f64>,
    right: Vector3<f64>,
    up: Vector3<f64>,
    centre: (f64, f64),
    radius: f64,
}

impl SphereView {
    fn new(azimuth: f64, elevation: f64, frame: PlotArea) -> Self {
        let (sine, cosine) = azimuth.sin_cos();
        let (rise, flat) = elevation.sin_cos();
        Self {
            towards: Vector3::new(flat * cosine, flat * sine, rise),
            right: Vector3::new(-sine, cosine, 0.0),
            up: Vector3::new(-rise * cosine, -rise * sine, flat),
            centre: (
                frame.left + 0.5 * frame.width,
                frame.top + 0.5 * (frame.height - RIM),
            ),
            radius: 0.5 * (frame.height - RIM).min(frame.width) - 2.0,
        }
    }

    fn at(&self, direction: &Vector3<f64>) -> (f64, f64) {
        (
            self.centre.0 + self.radius * self.right.dot(direction),
            self.centre.1 - self.radius * self.up.dot(direction),
        )
    }

    fn is_near(&self, direction: &Vector3<f64>) -> bool {
        self.towards.dot(direction) >= 0.0
    }

    /// The point of a direction, on the rim when it is behind.
    fn at_or_rim(&self, direction: &Vector3<f64>) -> (f64, f64) {
        let behind = self.towards.dot(direction).min(0.0);
        let flat = direction - self.towards * behind;
        let length = if behind < 0.0 {
            flat.norm().max(1e-9)
        } else {
            1.0
        };
        self.at(&(flat / length))
    }

    /// A line on the sphere: the part behind first and faint.
    fn trace(&self, canvas: &mut Canvas, directions: &[Vector3<f64>], near: Pen, far: Option<Pen>) {
        for (wanted, pen) in [(false, far), (true, Some(near))] {
            let Some(pen) = pen else { continue };
            let mut run = Vec::new();
            for direction in directions {
                if self.is_near(direction) == wanted {
                    run.push(self.at(direction));
                } else {
                    canvas.path(&run, pen);
                    run.clear();
                }
            }
            canvas.path(&run, pen);
        }
    }
}

/// Draws the sphere with trace, targets and the cones of the boresight.
pub(super) fn draw(
    canvas: &mut Canvas,
    frame: PlotArea,
    plan: &WrittenPlan,
    (scenario, boresight): (Option<&Scenario>, &DrawnBoresight),
) {
    let points = |state: &WrittenState| state.attitude().to_reference(boresight.axis);
    let trace: Vec<Vector3<f64>> = plan.trajectory.states.iter().map(points).collect();
    let view = looking_at(&trace, frame);
    let rim = Pen::new(LINE, 1.2);
    canvas.circle(view.centre, view.radius, "#F7F9FB", rim);
    graticule(canvas, &view);
    let cones = scenario.map_or(&[][..], Scenario::cones);
    let cones = cones.iter().filter(|cone| cone.boresight == boresight.name);
    let mut forbidden = 0;
    for cone in cones {
        cap(canvas, &view, cone);
        forbidden += 1;
    }
    let near = Pen::new(SERIES[0], 2.2);
    view.trace(canvas, &trace, near, Some(near.dashed().faded(0.35)));
    axes(canvas, &view);
    let ups = roll_ticks(plan, scenario, boresight);
    targets(canvas, &view, (plan, &trace, &ups));
    let frame_name = scenario.and_then(Scenario::reference_frame);
    let of = frame_name.map_or("the reference frame", ReferenceFrame::name);
    let cones = match forbidden {
        0 => "",
        _ => "; red: excluded by cones",
    };
    let ticks = if ups.iter().any(Option::is_some) {
        "; ticks: roll, up is 0"
    } else {
        ""
    };
    let captions = [
        format!("Where {} points in {of}", boresight.name),
        format!("dashed: far side{cones}{ticks}"),
    ];
    let mut below = frame.top + frame.height + 4.0;
    for caption in captions {
        canvas.text(view.centre.0, below, Ink::SMALL.middle(), &caption);
        below += 14.0;
    }
}

/// A view of the side with most of a trace.
fn looking_at(trace: &[Vector3<f64>], frame: PlotArea) -> SphereView {
    let sum: Vector3<f64> = trace.iter().sum();
    let mean = sum / (trace.len() as f64).max(1.0);
    if mean.norm() > ASTRAY {
        // Slightly elevated, so that circles of latitude are visible.
        let azimuth = mean.y.atan2(mean.x) + 0.25;
        let elevation = (mean.z / mean.norm()).asin() * 0.8;
        SphereView::new(azimuth, elevation.clamp(-STEEPEST, STEEPEST), frame)
    } else {
        let first = trace.first().map_or(0.0, |d| d.y.atan2(d.x));
        SphereView::new(first + 0.6, USUAL, frame)
    }
}

fn graticule(canvas: &mut Canvas, view: &SphereView) {
    let pen = Pen::new(FAINT, 1.0);
    let point = |azimuth: f64, elevation: f64| {
        let (sine, cosine) = azimuth.sin_cos();
        let (rise, flat) = elevation.sin_cos();
        Vector3::new(flat * cosine, flat * sine, rise)
    };
    let share = |index: u32| f64::from(index) / f64::from(CIRCLE);
    for step in 0..12 {
        let azimuth = f64::from(step) * PI / 6.0;
        let meridian = |index| point(azimuth, (share(index) - 0.5) * PI);
        let line: Vec<_> = (0..=CIRCLE).map(meridian).collect();
        view.trace(canvas, &line, pen, None);
    }
    for step in -2..=2 {
        let elevation = f64::from(step) * PI / 6.0;
        let parallel = |index| point(share(index) * TAU, elevation);
        let line: Vec<_> = (0..=CIRCLE).map(parallel).collect();
        let pen = if step == 0 { Pen::new(LINE, 1.0) } else { pen };
        view.trace(canvas, &line, pen, None);
    }
}

fn axes(canvas: &mut Canvas, view: &SphereView) {
    for (axis, name) in [
        (Vector3::x(), "x"),
        (Vector3::y(), "y"),
        (Vector3::z(), "z"),
    ] {
        for (direction, sign) in [(axis, "+"), (-axis, "\u{2212}")] {
            if view.is_near(&direction) {
                let (x, y) = view.at(&direction);
                canvas.circle((x, y), 2.0, "#5A6772", Pen::new("#5A6772", 0.0));
                let words = format!("{sign}{name}");
                canvas.text(x + 5.0, y - 5.0, Ink::SMALL, &words);
            }
        }
    }
}

/// The part of the sphere excluded by a cone.
fn cap(canvas: &mut Canvas, view: &SphereView, cone: &Cone) {
    let ForbiddenCone {
        direction,
        half_angle,
        ..
    } = cone.forbidden();
    let (rise, flat) = half_angle.sin_cos();
    // Any two directions perpendicular to the axis.
    let helper = if direction.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::x()
    };
    let across = direction.cross(&helper).normalize();
    let other = direction.cross(&across);
    let edge: Vec<Vector3<f64>> = (0..=CIRCLE)
        .map(|index| {
            let (sine, cosine) = (TAU * f64::from(index) / f64::from(CIRCLE)).sin_cos();
            direction * flat + (across * cosine + other * sine) * rise
        })
        .collect();
    let pen = Pen::new(ALARM, 1.2);
    // A cone wider than a hemisphere leaves only its outside allowed; then only the edge is drawn.
    if edge.iter().any(|point| view.is_near(point)) && half_angle < FRAC_PI_2 {
        let outline: Vec<_> = edge.iter().map(|point| view.at_or_rim(point)).collect();
        canvas.area(&outline, ALARM, Pen::new("none", 0.0).faded(0.16));
    }
    view.trace(canvas, &edge, pen, Some(pen.dashed().faded(0.3)));
}

/// Where the body's up points, of a passage that points the boresight.
type Tick = Option<Vector3<f64>>;

/// At the passages that point the boresight, the direction in the reference frame of the body axis that
/// points to north at roll 0.
fn roll_ticks(
    plan: &WrittenPlan,
    scenario: Option<&Scenario>,
    boresight: &DrawnBoresight,
) -> Vec<Tick> {
    let is_drawn = |passage: &WrittenPassage| {
        let targets = scenario.map_or(&[][..], Scenario::targets);
        let target = targets.iter().find(|target| target.id == passage.target);
        let pointing = target.and_then(|target| target.pointing.as_ref());
        // Without a scenario it is not known which axis is pointed.
        passage.roll_deg.is_some()
            && pointing
                .is_some_and(|pointing| pointing.roll.axis.dot(&boresight.axis) > 1.0 - 1e-12)
    };
    let up = upward(boresight.axis);
    let ups = plan.passages.iter().map(|passage| {
        let state = plan
            .state_from(passage.time_s)
            .filter(|_| is_drawn(passage))?;
        Some(state.attitude().to_reference(up))
    });
    ups.collect()
}

/// Targets numbered in visiting order, with ticks.
fn targets(
    canvas: &mut Canvas,
    view: &SphereView,
    (plan, trace, ups): (&WrittenPlan, &[Vector3<f64>], &[Tick]),
) {
    let radius = if plan.passages.len() > 30 { 6.5 } else { 9.0 };
    let places = plan
        .passages
        .iter()
        .map(|passage| trace.get(plan.index_from(passage.time_s)).copied());
    let mut marks: Vec<(usize, Vector3<f64>)> = places
        .enumerate()
        .filter_map(|(index, place)| Some((index + 1, place?)))
        .collect();
    // The nearest are drawn last, on top.
    marks.sort_by(|a, b| view.towards.dot(&a.1).total_cmp(&view.towards.dot(&b.1)));
    for (number, direction) in marks {
        let (x, y) = view.at(&direction);
        let pen = Pen::new("#FFFFFF", 1.5);
        let fill = if view.is_near(&direction) {
            "#14202B"
        } else {
            "#9AA5AF"
        };
        if let Some(Some(up)) = ups.get(number - 1) {
            let (right, rise) = (view.right.dot(up), view.up.dot(up));
            let tip = (x + 2.0 * radius * right, y - 2.0 * radius * rise);
            canvas.path(&[(x, y), tip], Pen::new(fill, 2.5));
        }
        canvas.circle((x, y), radius, fill, pen);
        canvas.text(x, y + 3.8, Ink::ON_COLOUR, &number.to_string());
    }
}
