//! The picture of a flight in closed loop over time: errors, rates, speeds, commands, active limits.

use super::canvas::{Canvas, PlotArea};
use super::panel::Panel;
use super::timeline;
use super::written_flight::{Off, WrittenFlight, WrittenSample};
use super::{HEAD, MARGIN, WIDTH};
use slewplan_solver::model::scenario::Scenario;

/// Errors beyond this, rad or rad/s, are drawn as this value: the flight has failed.
const LOST: f64 = 1e3;

/// The picture of a flight; the scenario adds limits and cones.
///
/// # Errors
///
/// A message, when there is nothing to draw, or the scenario has another number of wheels.
pub(crate) fn draw(written: &WrittenFlight, scenario: Option<&Scenario>) -> Result<String, String> {
    let flight = &written.flight;
    let record = flight.record()?;
    let wheels = record.torques.len();
    let expected = scenario.map_or(wheels, |it| it.spacecraft().wheels().len());
    if wheels != expected {
        return Err(format!("it has {expected} wheels, the flight {wheels}"));
    }
    let errors = |of: fn(&Off) -> f64, factor: f64| {
        let values = flight.samples.iter().map(move |s| of(&s.error).min(LOST));
        let times = record.states.iter().map(|state| state.time_s);
        let curve: Vec<_> = times.zip(values.map(|value| value * factor)).collect();
        vec![curve]
    };
    let attitude = Unit::of(flight.peak.attitude_rad);
    let rate = Unit::of(flight.peak.rate_rad_s);
    let mut panels = vec![
        Panel::unlimited(
            "Attitude error",
            attitude.angle,
            errors(|off| off.attitude_rad, attitude.factor),
        ),
        Panel::unlimited(
            "Rate error",
            rate.rate,
            errors(|off| off.rate_rad_s, rate.factor),
        ),
    ];
    let mut motion = timeline::panels(&record, scenario);
    let spans: Vec<(f64, f64)> = flight.spans().collect();
    let met = |of: fn(&WrittenSample) -> &[bool]| {
        let samples = flight.samples.iter().zip(&spans);
        let met = samples.filter(|(sample, _)| of(sample).contains(&true));
        joined(met.map(|(_, span)| *span))
    };
    if let [_, speeds, torques, ..] = &mut motion[..] {
        speeds.alarms = met(|sample| &sample.speed_limited);
        torques.alarms = met(|sample| &sample.torque_limited);
    }
    panels.extend(motion);
    let name = written.name.as_deref().unwrap_or("Flight");
    let summary = summary(written);
    let frame = PlotArea {
        left: MARGIN + 60.0,
        top: HEAD + 26.0,
        width: WIDTH - 2.0 * MARGIN - 60.0,
        height: timeline::height(&panels),
    };
    let height = frame.top + frame.height;
    let mut canvas = Canvas::new(WIDTH, height, &format!("{name}: {summary}"));
    super::head(&mut canvas, name, &summary);
    timeline::stack(&mut canvas, frame, &panels, &record);
    Ok(canvas.finish())
}

/// Spans in order of time, adjacent ones merged.
fn joined(spans: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (begin, end) in spans {
        match joined.last_mut() {
            // Adjacent spans have exactly equal ends.
            Some(last) if begin <= last.1 => last.1 = end,
            _ => joined.push((begin, end)),
        }
    }
    joined
}

/// The title of the picture: the flight in a line.
fn summary(written: &WrittenFlight) -> String {
    let flight = &written.flight;
    let told = |name: &str, off: &Off| {
        let unit = Unit::of(off.attitude_rad);
        let value = off.attitude_rad.min(LOST) * unit.factor;
        format!("{name} {value:.3} {} off", unit.angle)
    };
    let mut parts = vec![format!(
        "simulated in closed loop, {:.2} s",
        flight.flight_time_s
    )];
    if flight.flight_time_s > flight.total_time_s {
        parts.push(format!("plan {:.2} s", flight.total_time_s));
    }
    parts.push(told("end", &flight.end));
    parts.push(told("peak", &flight.peak));
    let within = if flight.within_tolerance { "" } else { "not " };
    parts.push(format!("{within}within the tolerance"));
    if flight.samples.iter().any(meets_a_limit) {
        parts.push("red: a wheel at its limit".to_owned());
    }
    parts.join("  \u{b7}  ")
}

fn meets_a_limit(sample: &WrittenSample) -> bool {
    sample.torque_limited.contains(&true) || sample.speed_limited.contains(&true)
}

/// A unit in which a small angle or rate is at least one.
struct Unit {
    angle: &'static str,
    rate: &'static str,
    factor: f64,
}

impl Unit {
    fn of(radians: f64) -> Self {
        let degrees = 1.0_f64.to_degrees();
        let (angle, rate, parts) = if radians * degrees >= 0.01 {
            ("deg", "deg/s", 1.0)
        } else if radians * degrees * 3.6e3 >= 0.01 {
            ("arcsec", "arcsec/s", 3.6e3)
        } else {
            ("milliarcsec", "milliarcsec/s", 3.6e6)
        };
        Self {
            angle,
            rate,
            factor: degrees * parts,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adjacent_spans_are_merged() {
        let spans = [(0.0, 1.0), (1.0, 2.0), (3.0, 4.0)];
        assert_eq!(joined(spans.into_iter()), [(0.0, 2.0), (3.0, 4.0)]);
    }

    #[test]
    fn small_errors_are_in_small_units() {
        let units = [0.01, 1e-6, 1e-9].map(|error| Unit::of(error).angle);
        assert_eq!(units, ["deg", "arcsec", "milliarcsec"]);
        assert!((Unit::of(1e-6).factor * 1e-6 - 0.206_265).abs() < 1e-6);
    }
}
