//! The measurements as drawings: time to a proof, and gaps of what is stopped, against the number of
//! targets.

use plotters::prelude::*;
use std::collections::BTreeMap;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

const SIZE: (u32, u32) = (760, 460);
const COLOURS: [RGBColor; 4] = [
    RGBColor(31, 119, 180),
    RGBColor(255, 127, 14),
    RGBColor(44, 160, 44),
    RGBColor(214, 39, 40),
];

/// Points of each curve, by its name.
type Curves = BTreeMap<String, Vec<(f64, f64)>>;

/// Draws `exact.svg` and `anytime.svg` into a directory from measurements on standard input.
pub(crate) fn draw(directory: &str) {
    let mut text = String::new();
    std::io::stdin()
        .read_to_string(&mut text)
        .expect("measurements on standard input");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let exact = curves(&rows, "exact", |row| {
        (row[11] == "optimal").then(|| (name(row), number(row[6])))
    });
    let anytime = curves(&rows, "anytime", |row| {
        (!row[10].is_empty()).then(|| {
            let curve = format!("{}, {} s", name(row), row[5]);
            (curve, 100.0 * number(row[10]))
        })
    });
    let directory = Path::new(directory);
    let title = "Time until the order is proved optimal, s (median of those proved)";
    chart(&directory.join("exact.svg"), title, &exact, 3.0..21.0);
    let title = "Gap between tour and bound when stopped, %";
    chart(&directory.join("anytime.svg"), title, &anytime, 20.0..210.0);
}

/// The medians over seeds, by curve and number of targets.
fn curves(
    rows: &[Vec<&str>],
    mode: &str,
    value: impl Fn(&[&str]) -> Option<(String, f64)>,
) -> Curves {
    let mut samples: BTreeMap<(String, usize), Vec<f64>> = BTreeMap::new();
    for row in rows.iter().filter(|row| row[0] == mode) {
        if let Some((curve, value)) = value(row) {
            let targets = row[3].parse().expect("a number of targets");
            samples.entry((curve, targets)).or_default().push(value);
        }
    }
    let mut curves = Curves::new();
    for ((curve, targets), mut values) in samples {
        values.sort_by(f64::total_cmp);
        let median = values[values.len() / 2];
        curves
            .entry(curve)
            .or_default()
            .push((targets as f64, median));
    }
    curves
}

fn name(row: &[&str]) -> String {
    let rates = if row[2] == "AllZero" {
        "all axes"
    } else {
        "z only"
    };
    format!("{}, {rates}", row[1].to_lowercase())
}

fn number(text: &str) -> f64 {
    text.parse().expect("a number")
}

/// One drawing with a logarithmic vertical axis.
fn chart(path: &Path, title: &str, curves: &Curves, targets: Range<f64>) {
    let values = || curves.values().flatten().map(|point| point.1.max(1e-3));
    let low = values().fold(f64::INFINITY, f64::min) / 2.0;
    let high = values().fold(0.0, f64::max) * 2.0;
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE).expect("a drawing");
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 17))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d(targets, (low..high).log_scale())
        .expect("a drawing");
    chart
        .configure_mesh()
        .x_desc("targets")
        .light_line_style(WHITE)
        .draw()
        .expect("a drawing");
    for (i, (name, points)) in curves.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let points = || points.iter().map(|&(x, y)| (x, y.max(1e-3)));
        chart
            .draw_series(LineSeries::new(points(), colour.stroke_width(2)))
            .expect("a drawing")
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour));
        chart
            .draw_series(points().map(|point| Circle::new(point, 3, colour.filled())))
            .expect("a drawing");
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .border_style(BLACK.mix(0.3))
        .background_style(WHITE.mix(0.8))
        .draw()
        .expect("a drawing");
    root.present().expect("the drawing is written");
}
