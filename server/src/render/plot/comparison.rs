//! The picture of a comparison of wheels and gyroscopes: slew times, advantage angles, devices, masses.

use super::axes::{self, Key};
use super::canvas::{Canvas, PlotArea, SERIES};
use super::chart::{self, Chart, Curve, Stroke, significant};
use super::written_comparison::{Fit, Size, WrittenComparison};
use super::{HEAD, MARGIN, WIDTH};

/// Maximum number of sizes whose slews are drawn: one row of diagrams.
const COLUMNS: usize = 3;
const CHART: f64 = 330.0;
const BETWEEN: f64 = 36.0;
/// Colours of wheels and of gyroscopes in diagrams that do not distinguish controls.
const WHEELS: &str = SERIES[2];
const GYROSCOPES: &str = SERIES[1];

/// Controls with their names and colours.
const CONTROLS: [(&str, &str, &str); 4] = [
    ("rw_eigenaxis", "wheels, eigenaxis", SERIES[5]),
    (
        "rw_pseudo_optimal",
        "wheels, pseudo-inverse optimal",
        SERIES[0],
    ),
    ("rw_optimal", "wheels, optimal", WHEELS),
    ("cmg", "gyroscopes", GYROSCOPES),
];

/// The picture of a comparison.
///
/// # Errors
///
/// A message, when it has nothing to draw.
pub(crate) fn draw(study: &WrittenComparison) -> Result<String, String> {
    if study.sizes.is_empty() || study.angles_rad.is_empty() {
        return Err("the comparison has no slews".to_owned());
    }
    let sizes = study.sizes.iter().take(COLUMNS);
    let mut charts: Vec<Chart> = sizes.map(|size| slew_times(study, size)).collect();
    let upper = charts.len();
    charts.extend([
        advantage_angles(study),
        torque_over_momentum(study),
        torque_over_mass(study),
        momentum_over_mass(study),
    ]);
    let lower = charts.len() - upper;
    let words = "Pyramids of four wheels and of four control moment gyroscopes turn the same \
        spacecraft; dots in the diagrams below: published angles, devices on the market";
    let title = "Wheels against gyroscopes";
    let top = HEAD + 44.0;
    let row = CHART + 16.0;
    let height = top + 2.0 * row;
    let mut canvas = Canvas::new(WIDTH, height, &format!("{title}. {words}"));
    super::head(&mut canvas, title, words);
    let keys = CONTROLS.map(|(_, name, colour)| Key {
        name: name.to_owned(),
        colour,
    });
    let inside = WIDTH - 2.0 * MARGIN;
    axes::legend_rows(&mut canvas, (MARGIN, HEAD + 18.0), inside, &keys);
    for (index, chart) in charts.iter().enumerate() {
        let (row_index, column, columns) = if index < upper {
            (0.0, index, upper)
        } else {
            (1.0, index - upper, lower)
        };
        let columns = columns as f64;
        let width = (inside - (columns - 1.0) * BETWEEN) / columns;
        let place = PlotArea {
            left: MARGIN + column as f64 * (width + BETWEEN),
            top: top + row_index * row,
            width,
            height: CHART,
        };
        chart::draw(&mut canvas, place, chart);
    }
    Ok(canvas.finish())
}

fn colour(control: &str) -> &'static str {
    let known = CONTROLS.iter().find(|(name, _, _)| *name == control);
    known.map_or(SERIES[6], |(_, _, colour)| colour)
}

fn curve(points: Vec<(f64, f64)>, colour: &'static str, stroke: Stroke) -> Curve {
    Curve {
        points,
        colour,
        stroke,
    }
}

fn slew_times(study: &WrittenComparison, size: &Size) -> Chart {
    let curves = size.controls.iter().map(|slews| {
        let angles = study.angles_rad.iter().map(|angle| angle.to_degrees());
        let points = angles.zip(slews.durations_s.iter().copied());
        curve(points.collect(), colour(&slews.control), Stroke::Line)
    });
    Chart {
        title: format!(
            "Slew time, s; devices of {} N m s",
            significant(size.momentum_nms)
        ),
        across: "angle, degrees".to_owned(),
        logarithms: false,
        curves: curves.collect(),
        marks: Vec::new(),
        levels: Vec::new(),
    }
}

/// The diagram ends at a half turn, the largest angle of a slew.
fn advantage_angles(study: &WrittenComparison) -> Chart {
    let advantage = &study.advantage;
    let half_turn = |angle: &f64| *angle <= std::f64::consts::PI;
    let curves = advantage.curves.iter().map(|of| {
        let angles = advantage.momenta_nms.iter().zip(&of.angles_rad);
        let angles = angles.filter_map(|(h, angle)| Some((*h, angle.filter(half_turn)?)));
        let points = angles.map(|(h, angle)| (h, angle.to_degrees())).collect();
        curve(points, colour(&of.control), Stroke::Line)
    });
    let published = advantage.published.iter().map(|of| {
        let point = (of.momentum_nms, of.angle_rad.to_degrees());
        curve(vec![point], colour(&of.control), Stroke::Dots)
    });
    Chart {
        title: "Advantage angle, degrees".to_owned(),
        across: "momentum of a device, N m s".to_owned(),
        logarithms: true,
        curves: curves.chain(published).collect(),
        marks: Vec::new(),
        levels: Vec::new(),
    }
}

fn torque_over_momentum(study: &WrittenComparison) -> Chart {
    let of_fit = |(fit, colour): (&Fit, &'static str)| {
        let devices = fit.devices.iter();
        let mut points: Vec<_> = devices.map(|d| (d.momentum_nms, d.torque_nm)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let law = points.iter().map(|(h, _)| (*h, fit.used.at(*h))).collect();
        [
            curve(law, colour, Stroke::Line),
            curve(points, colour, Stroke::Dots),
        ]
    };
    let catalogue = &study.market;
    Chart {
        title: "Torque of a device, N m".to_owned(),
        across: "its momentum, N m s".to_owned(),
        logarithms: true,
        curves: [
            (&catalogue.wheel, WHEELS),
            (&catalogue.gyroscope, GYROSCOPES),
        ]
        .into_iter()
        .flat_map(of_fit)
        .collect(),
        marks: Vec::new(),
        levels: Vec::new(),
    }
}

fn torque_over_mass(study: &WrittenComparison) -> Chart {
    let points = study.mass.points.iter();
    let wheels = points
        .clone()
        .map(|p| (p.device_mass_kg, p.wheel_torque_nm));
    let gyroscopes = points.map(|p| (p.device_mass_kg, p.gyroscope_torque_nm));
    over_mass(
        "Torque of four, N m",
        [wheels.collect(), gyroscopes.collect()],
        study.mass.crossover_kg,
    )
}

fn momentum_over_mass(study: &WrittenComparison) -> Chart {
    let points = study.mass.points.iter();
    let wheels = points
        .clone()
        .map(|p| (p.device_mass_kg, p.wheel_momentum_nms));
    let gyroscopes = points.map(|p| (p.device_mass_kg, p.gyroscope_momentum_nms));
    over_mass(
        "Momentum of four, N m s",
        [wheels.collect(), gyroscopes.collect()],
        None,
    )
}

fn over_mass(
    title: &str,
    [wheels, gyroscopes]: [Vec<(f64, f64)>; 2],
    crossover: Option<f64>,
) -> Chart {
    Chart {
        title: title.to_owned(),
        across: "mass of a device, kg".to_owned(),
        logarithms: true,
        curves: vec![
            curve(wheels, WHEELS, Stroke::Line),
            curve(gyroscopes, GYROSCOPES, Stroke::Line),
        ],
        marks: crossover.into_iter().collect(),
        levels: Vec::new(),
    }
}
