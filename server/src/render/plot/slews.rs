//! Pictures of slews: one over time, several as a trade curve of time and cost.

use super::axes::{self, Key};
use super::canvas::{Canvas, PlotArea, SERIES};
use super::chart::{self, Chart, Curve, Stroke};
use super::timeline;
use super::written_slews::{Swept, WrittenSlew, WrittenSlews};
use super::{HEAD, MARGIN, VIOLATED, WIDTH};
use slewplan_solver::model::scenario::Scenario;
use std::fmt::Write;

const CHART: f64 = 400.0;
const BETWEEN: f64 = 40.0;

/// Values to mark in a trade curve.
#[derive(Debug, Default)]
pub(crate) struct Marks {
    /// Values of the swept quantity.
    pub(crate) swept: Vec<f64>,
    /// Values of the cost: energy, J, or effort, (N m)² s.
    pub(crate) cost: Vec<f64>,
}

/// A function of a slew that is drawn.
type SlewQuantity = fn(&WrittenSlew) -> Option<f64>;

/// The picture of a single slew over time; the scenario of its request adds limits and cones.
///
/// # Errors
///
/// A message, when there is nothing to draw, or the scenario has another number of wheels.
pub(crate) fn single(answer: &WrittenSlews, scenario: Option<&Scenario>) -> Result<String, String> {
    let [slew] = &answer.slews[..] else {
        return Err(format!("there are {} slews to draw", answer.slews.len()));
    };
    let record = slew.record()?;
    let wheels = record.torques.len();
    let expected = scenario.map_or(wheels, |it| it.spacecraft().wheels().len());
    if wheels != expected {
        return Err(format!("it has {expected} wheels, the slew {wheels}"));
    }
    let mut panels = timeline::panels(&record, scenario);
    for panel in &mut panels {
        panel.alarms = slew.intrusions();
    }
    let frame = PlotArea {
        left: MARGIN + 60.0,
        top: HEAD + 26.0,
        width: WIDTH - 2.0 * MARGIN - 60.0,
        height: timeline::height(&panels),
    };
    let (name, summary) = (title(answer), summary(slew));
    let height = frame.top + frame.height;
    let mut canvas = Canvas::new(WIDTH, height, &format!("{name}: {summary}"));
    super::head(&mut canvas, name, &summary);
    timeline::stack(&mut canvas, frame, &panels, &record);
    Ok(canvas.finish())
}

/// The trade curves of time and cost, one for every answer.
///
/// # Errors
///
/// A message, when the answers do not fit into one diagram or have nothing to draw.
pub(crate) fn trade(answers: &[WrittenSlews], marks: &Marks) -> Result<String, String> {
    let swept = common_sweep(answers)?;
    let unsolved = all(answers).filter(|slew| !slew.solved).count();
    let solved = all(answers).count() - unsolved;
    if solved == 0 {
        return Err("none of the slews is solved".to_owned());
    }
    let charts = charts(answers, swept, marks);
    let keys: Vec<Key> = answers
        .iter()
        .zip(SERIES.iter().cycle())
        .map(|(answer, colour)| Key {
            name: title(answer).to_owned(),
            colour,
        })
        .collect();
    let names: Vec<&str> = keys.iter().map(|key| key.name.as_str()).collect();
    let mut words = format!("{} slews over {}", solved, across(swept));
    if all(answers).any(|slew| slew.energy_bill_j.is_some()) && swept != Swept::EnergiesJ {
        words += "; energy: solid the bill, nothing fed back, dashed the integral of the power";
    }
    if unsolved > 0 {
        // Writing to a String cannot fail.
        let _ = write!(words, "; {unsolved} not solved, left out");
    }
    let described = format!("Trade curve of {}: {words}", names.join(", "));
    // The legend may need several rows; a discarded canvas measures its height.
    let place = (MARGIN, HEAD + 18.0);
    let inside = WIDTH - 2.0 * MARGIN;
    let last = axes::legend_rows(&mut Canvas::new(0.0, 0.0, ""), place, inside, &keys);
    let top = last + 26.0;
    let mut canvas = Canvas::new(WIDTH, top + CHART, &described);
    super::head(&mut canvas, "Trade curve", &words);
    axes::legend_rows(&mut canvas, place, inside, &keys);
    let count = charts.len() as f64;
    let width = (inside - (count - 1.0) * BETWEEN) / count;
    for (index, chart) in charts.iter().enumerate() {
        let place = PlotArea {
            left: MARGIN + index as f64 * (width + BETWEEN),
            top,
            width,
            height: CHART,
        };
        chart::draw(&mut canvas, place, chart);
    }
    Ok(canvas.finish())
}

/// The swept quantity of all answers.
fn common_sweep(answers: &[WrittenSlews]) -> Result<Swept, String> {
    let mut sweeps = answers.iter().map(|answer| answer.sweep);
    let first = sweeps.next().flatten();
    let swept = first.ok_or("an answer without a sweep has no trade curve; draw it alone")?;
    if sweeps.all(|other| other == first) {
        Ok(swept)
    } else {
        Err("the answers are swept over different quantities".to_owned())
    }
}

fn all(answers: &[WrittenSlews]) -> impl Iterator<Item = &WrittenSlew> {
    answers.iter().flat_map(|answer| &answer.slews)
}

/// The diagrams: duration and cost, each unless it is the swept quantity.
fn charts(answers: &[WrittenSlews], swept: Swept, marks: &Marks) -> Vec<Chart> {
    let chart = |title: &str, quantities: &[(SlewQuantity, Stroke)], levels: &[f64]| Chart {
        title: title.to_owned(),
        across: across(swept).to_owned(),
        logarithms: true,
        curves: curves(answers, quantities),
        marks: marks.swept.clone(),
        levels: levels.to_vec(),
    };
    let mut charts = Vec::new();
    if swept != Swept::DurationsS {
        let time: SlewQuantity = |slew| Some(slew.time_s);
        charts.push(chart("Duration, s", &[(time, Stroke::Dotted)], &[]));
    }
    let has_motors = all(answers).any(|slew| slew.energy_bill_j.is_some());
    if swept != Swept::EnergiesJ && has_motors {
        let energies: [(SlewQuantity, Stroke); 2] = [
            (|slew| slew.energy_bill_j, Stroke::Dotted),
            (|slew| slew.energy_proxy_j, Stroke::Dashes),
        ];
        charts.push(chart("Energy, J", &energies, &marks.cost));
    } else {
        let effort: SlewQuantity = |slew| Some(slew.effort_nm2_s);
        let title = "Effort, integral of the squared torques, (N m)\u{b2} s";
        charts.push(chart(title, &[(effort, Stroke::Dotted)], &marks.cost));
    }
    charts
}

fn curves(answers: &[WrittenSlews], quantities: &[(SlewQuantity, Stroke)]) -> Vec<Curve> {
    let coloured = answers.iter().zip(SERIES.iter().cycle());
    let of_answer = |(answer, colour): (&WrittenSlews, &&'static str)| {
        let colour = *colour;
        let curve = |(quantity, stroke): &(SlewQuantity, Stroke)| {
            let solved = answer.slews.iter().filter(|slew| slew.solved);
            let mut points: Vec<_> = solved
                .filter_map(|slew| Some((slew.swept?, quantity(slew)?)))
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            Curve {
                points,
                colour,
                stroke: *stroke,
            }
        };
        quantities.iter().map(curve).collect::<Vec<_>>()
    };
    coloured.flat_map(of_answer).collect()
}

fn across(swept: Swept) -> &'static str {
    match swept {
        Swept::Weights => "weight of the effort, s per (N m)\u{b2} s",
        Swept::DurationsS => "duration, s",
        Swept::EnergiesJ => "energy, J",
    }
}

fn title(answer: &WrittenSlews) -> &str {
    answer.name.as_deref().unwrap_or("Slew")
}

/// The title of the picture: a slew in a line.
fn summary(slew: &WrittenSlew) -> String {
    let mut parts = vec![
        format!("{:.2} s", slew.time_s),
        format!("effort {:.4} (N m)\u{b2} s", slew.effort_nm2_s),
    ];
    if let Some(bill) = slew.energy_bill_j {
        parts.push(format!("energy bill {bill:.2} J"));
    }
    if let Some(proxy) = slew.energy_proxy_j {
        parts.push(format!("proxy {proxy:.2} J"));
    }
    if !slew.solved {
        parts.push("not solved".to_owned());
    }
    if !slew.intrusions().is_empty() {
        parts.push(VIOLATED.to_owned());
    }
    parts.join("  \u{b7}  ")
}
