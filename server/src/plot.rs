//! A plan as a picture: sphere, legs, timelines. Plain SVG, so that it needs no browser and no
//! fonts and stays sharp in print.

use slewplan_solver::scenario::Scenario;

mod canvas;
mod legs;
mod scale;
mod sphere;
#[cfg(test)]
mod tests;
mod timeline;
mod view;
mod written;

use canvas::{Canvas, Frame, Ink};
pub(crate) use view::Boresight;
pub(crate) use written::WrittenPlan;

const WIDTH: f64 = 1200.0;
const MARGIN: f64 = 36.0;
const HEAD: f64 = 84.0;
const UPPER: f64 = 400.0;
const STRIP: f64 = 34.0;
const PANEL: f64 = 150.0;
const GAP: f64 = 44.0;

/// The picture of a plan. The scenario adds what the plan does not tell: limits and keep-out cones.
///
/// # Errors
///
/// A sentence, when the scenario has another number of wheels.
pub(crate) fn svg(
    plan: &WrittenPlan,
    scenario: Option<&Scenario>,
    view: &Boresight,
) -> Result<String, String> {
    let wheels = plan.wheels();
    let expected = scenario.map_or(wheels, |scenario| scenario.spacecraft().wheels().len());
    if wheels != expected {
        return Err(format!("it has {expected} wheels, the plan {wheels}"));
    }
    let lower = HEAD + UPPER + 46.0;
    let panels = timeline::panels(plan, scenario);
    let height = lower + STRIP + panels.len() as f64 * (PANEL + GAP) + 24.0;
    let name = scenario.and_then(Scenario::name).unwrap_or("Plan");
    let mut canvas = Canvas::new(WIDTH, height, &described(name, plan));
    head(&mut canvas, name, plan);
    let globe = Frame {
        left: MARGIN,
        top: HEAD,
        width: 430.0,
        height: UPPER,
    };
    sphere::draw(&mut canvas, globe, plan, (scenario, view));
    let beside = globe.left + globe.width + 40.0;
    let bars = Frame {
        left: beside,
        top: HEAD,
        width: WIDTH - MARGIN - beside,
        height: UPPER,
    };
    legs::draw(&mut canvas, bars, plan);
    let times = Frame {
        left: MARGIN + 60.0,
        top: lower,
        width: WIDTH - 2.0 * MARGIN - 60.0,
        height: height - lower,
    };
    timeline::strip(&mut canvas, times, plan, STRIP);
    let mut top = lower + STRIP + GAP * 0.75;
    for panel in &panels {
        let frame = Frame {
            top,
            height: PANEL,
            ..times
        };
        timeline::draw(&mut canvas, frame, panel, plan);
        top += PANEL + GAP;
    }
    Ok(canvas.finish())
}

fn head(canvas: &mut Canvas, name: &str, plan: &WrittenPlan) {
    canvas.text(MARGIN, 44.0, Ink::TITLE, name);
    canvas.text(MARGIN, 68.0, Ink::QUIET, &summary(plan));
}

/// The plan in a line.
fn summary(plan: &WrittenPlan) -> String {
    let mut parts = vec![
        format!("{:.2} s", plan.total_time_s),
        plan.status.clone(),
        format!("lower bound {:.2} s", plan.lower_bound_s),
        format!("gap {:.2} %", 100.0 * plan.relative_gap),
    ];
    if let Some(verification) = &plan.verification {
        let passed = if verification.passed { "" } else { "not " };
        parts.push(format!("{passed}verified"));
    }
    parts.join("  \u{b7}  ")
}

/// The same for those who cannot see the picture.
fn described(name: &str, plan: &WrittenPlan) -> String {
    let order: Vec<&str> = plan.passages.iter().map(|p| p.target.as_str()).collect();
    format!("{name}: {}; order {}", summary(plan), order.join(" "))
}
