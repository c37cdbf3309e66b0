//! Plans and other answers as pictures: plain SVG, which needs no scripts and no embedded fonts.
//!
//! A plan is drawn as a sphere, its legs and timelines; a slew as timelines, or with a sweep as a
//! trade curve; studies of wheels as diagrams, a flight in closed loop as timelines.

use slewplan_solver::model::scenario::Scenario;

mod axes;
mod canvas;
mod chart;
mod comparison;
mod document;
mod envelopes;
mod flight;
mod legs;
mod panel;
mod scale;
mod schedule;
mod slews;
mod sphere;
#[cfg(test)]
mod tests;
mod timeline;
mod view;
mod written;
mod written_comparison;
mod written_flight;
mod written_slews;

use canvas::{Canvas, Ink, PlotArea};
pub(crate) use comparison::draw as comparison;
pub(crate) use document::DrawableDocument;
pub(crate) use envelopes::{WrittenEnvelopes, svg as envelopes};
pub(crate) use flight::draw as flight;
pub(crate) use slews::{Marks, single as slew, trade};
pub(crate) use view::DrawnBoresight;
pub(crate) use written::WrittenPlan;
pub(crate) use written_comparison::WrittenComparison;
pub(crate) use written_flight::WrittenFlight;
pub(crate) use written_slews::WrittenSlews;

const WIDTH: f64 = 1200.0;
const MARGIN: f64 = 36.0;
const HEAD: f64 = 84.0;
const UPPER: f64 = 400.0;
const STRIP: f64 = 34.0;
/// What the title says of a motion with a boresight on the wrong side of a cone.
const VIOLATED: &str = "keep-out violated where marked red";
const BELOW_STRIP: f64 = 33.0;

/// The picture of a plan. The scenario adds limits and cones, which a plan does not have.
///
/// # Errors
///
/// A message, when the scenario has another number of wheels.
pub(crate) fn plan(
    plan: &WrittenPlan,
    scenario: Option<&Scenario>,
    view: &DrawnBoresight,
) -> Result<String, String> {
    let wheels = plan.wheels();
    let expected = scenario.map_or(wheels, |scenario| scenario.spacecraft().wheels().len());
    if wheels != expected {
        return Err(format!("it has {expected} wheels, the plan {wheels}"));
    }
    let lower = HEAD + UPPER + 46.0;
    let record = plan.record();
    let mut panels = timeline::panels(&record, scenario);
    for panel in &mut panels {
        panel.alarms = plan.intrusions();
    }
    let dated = scenario.is_some_and(|it| it.epoch().is_some());
    let clock = if dated { schedule::CLOCK_ROW } else { 0.0 };
    let upper = lower + STRIP + clock + timeline::height(&panels) + 24.0;
    let height = upper + schedule::height(plan);
    let name = scenario.and_then(Scenario::name).unwrap_or("Plan");
    let mut canvas = Canvas::new(WIDTH, height, &described(name, plan));
    head(&mut canvas, name, &summary(plan));
    let globe = PlotArea {
        left: MARGIN,
        top: HEAD,
        width: 430.0,
        height: UPPER,
    };
    sphere::draw(&mut canvas, globe, plan, (scenario, view));
    let beside = globe.left + globe.width + 40.0;
    let bars = PlotArea {
        left: beside,
        top: HEAD,
        width: WIDTH - MARGIN - beside,
        height: UPPER,
    };
    legs::draw(&mut canvas, bars, plan);
    let times = PlotArea {
        left: MARGIN + 60.0,
        top: lower,
        width: WIDTH - 2.0 * MARGIN - 60.0,
        height: STRIP,
    };
    timeline::strip(&mut canvas, times, plan, scenario);
    let at = |top: f64| PlotArea { top, ..times };
    if let Some(scenario) = scenario {
        schedule::clock(&mut canvas, at(lower + STRIP), plan.total_time_s, scenario);
    }
    let below = at(lower + STRIP + clock + BELOW_STRIP);
    timeline::stack(&mut canvas, below, &panels, &record);
    schedule::left_out(&mut canvas, at(upper), plan);
    Ok(canvas.finish())
}

fn head(canvas: &mut Canvas, name: &str, summary: &str) {
    canvas.text(MARGIN, 44.0, Ink::TITLE, name);
    canvas.text(MARGIN, 68.0, Ink::QUIET, summary);
}

/// The title of the picture: the plan in a line.
fn summary(plan: &WrittenPlan) -> String {
    let mut parts: Vec<String> = plan.value_words().into_iter().collect();
    parts.extend([format!("{:.2} s", plan.total_time_s), plan.status.clone()]);
    // Of a schedule with open value no end may be known at all.
    if plan.relative_gap < 1.0 {
        parts.push(format!("lower bound {:.2} s", plan.lower_bound_s));
        parts.push(format!("gap {:.2} %", 100.0 * plan.relative_gap));
    }
    if let Some(verification) = &plan.verification {
        let passed = if verification.passed { "" } else { "not " };
        parts.push(format!("{passed}verified"));
    }
    if !plan.intrusions().is_empty() {
        parts.push(VIOLATED.to_owned());
    }
    parts.join("  \u{b7}  ")
}

/// The alternative text of the picture.
fn described(name: &str, plan: &WrittenPlan) -> String {
    let order: Vec<&str> = plan.passages.iter().map(|p| p.target.as_str()).collect();
    format!("{name}: {}; order {}", summary(plan), order.join(" "))
}
