//! Choice of the sample times, such that interpolation between samples keeps a tolerance.

use super::ExportError;
use slewplan_solver::checker::PropagatedMotion;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::State;

/// Minimum distance of two times, s: formats write nanoseconds, and written times must increase.
pub(super) const CLOSEST_S: f64 = 1e-6;

/// Maximum rotation between two samples, rad: small enough for linear interpolation of quaternions,
/// and for the error to be measured at few points.
const WIDEST: f64 = 0.3;
/// Points of a gap, as shares, at which the interpolation is compared with the motion.
const PROBES: [f64; 3] = [0.25, 0.5, 0.75];

/// Spacing of samples between switches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Spacing {
    /// At multiples of a time, s.
    Step(f64),
    /// Evenly between switches, such that attitudes interpolated in any of the usual ways err by at
    /// most this angle, rad, and linearly interpolated body rates by at most the same number,
    /// rad/s.
    Tolerance(f64),
}

impl Spacing {
    /// A valid step, s.
    pub(crate) fn checked_step(step_s: f64) -> Result<f64, &'static str> {
        Some(step_s)
            .filter(|step| (1e-3..=1e6).contains(step))
            .ok_or("expected a number of seconds from 0.001 to 1e6")
    }

    /// A valid tolerance, rad and rad/s.
    pub(crate) fn checked_tolerance(tolerance: f64) -> Result<f64, &'static str> {
        Some(tolerance)
            .filter(|tolerance| (1e-9..=1.0).contains(tolerance))
            .ok_or("expected a number from 1e-9 to 1")
    }
}

/// Settings of sampling.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sampling {
    pub(super) spacing: Spacing,
    /// Maximum number of samples.
    pub(super) most: usize,
}

/// Times from the first to the last knot, strictly increasing, all knots among them.
pub(super) fn times(
    motion: &PropagatedMotion,
    knots: &[f64],
    Sampling { spacing, most }: Sampling,
) -> Result<Vec<f64>, ExportError> {
    let mut times = Vec::new();
    for pair in knots.windows(2) {
        let (begin, end) = (pair[0], pair[1]);
        times.push(begin);
        match spacing {
            Spacing::Step(step) => multiples(&mut times, (begin, end), step, most)?,
            Spacing::Tolerance(tolerance) => {
                let parts = parts(motion, (begin, end), tolerance, most)?;
                let mut part = 1.0;
                while part < parts {
                    times.push(begin + (end - begin) * (part / parts));
                    part += 1.0;
                }
            }
        }
        if times.len() >= most {
            return Err(too_many(most));
        }
    }
    times.extend(knots.last());
    Ok(times)
}

fn too_many(most: usize) -> ExportError {
    ExportError::Choice(format!(
        "more than {most} samples would be needed; choose a longer step or a larger tolerance"
    ))
}

/// Adds the multiples of a step inside a gap.
fn multiples(
    times: &mut Vec<f64>,
    (begin, end): (f64, f64),
    step: f64,
    most: usize,
) -> Result<(), ExportError> {
    let mut number = (begin / step).floor() + 1.0;
    while number * step < end - CLOSEST_S {
        if times.len() >= most {
            return Err(too_many(most));
        }
        if number * step > begin + CLOSEST_S {
            times.push(number * step);
        }
        number += 1.0;
    }
    Ok(())
}

/// Number of equal parts of a gap without switches that keeps a tolerance.
///
/// The error of linear interpolation falls with the square of the length or faster, so that one
/// measurement predicts the number; then every part is measured, and their number grows until all
/// of them keep the tolerance.
fn parts(
    motion: &PropagatedMotion,
    (begin, end): (f64, f64),
    tolerance: f64,
    most: usize,
) -> Result<f64, ExportError> {
    let mut parts = 1.0_f64;
    loop {
        let growth = match worst(motion, (begin, end), parts)? {
            Some(error) if error <= tolerance => return Ok(parts),
            Some(error) => (error / tolerance).sqrt() * 1.02,
            None => 2.0,
        };
        parts = (parts * growth).ceil();
        if end - begin < parts * CLOSEST_S {
            return Ok(((end - begin) / CLOSEST_S).floor().max(1.0));
        }
        if parts > most as f64 {
            return Err(too_many(most));
        }
    }
}

/// Largest error of interpolation over equal parts of a gap; `None` when a part rotates too far for
/// the error to be measured.
fn worst(
    motion: &PropagatedMotion,
    (begin, end): (f64, f64),
    parts: f64,
) -> Result<Option<f64>, ExportError> {
    let state = |share: f64| {
        let time = begin + (end - begin) * share;
        motion.state(time).ok_or(ExportError::NotFinite)
    };
    let mut worst = 0.0_f64;
    let mut before = state(0.0)?;
    let mut part = 0.0;
    while part < parts {
        let after = state((part + 1.0) / parts)?;
        // From the rates too, because a full turn leaves the attitude unchanged.
        let rate = before
            .body_rate_rad_s
            .norm()
            .max(after.body_rate_rad_s.norm());
        let turn = before.attitude.angle_to(&after.attitude);
        if turn.max(rate * (end - begin) / parts) > WIDEST {
            return Ok(None);
        }
        for probe in PROBES {
            let truth = state((part + probe) / parts)?;
            worst = worst.max(error((&before, &after), probe, &truth));
        }
        before = after;
        part += 1.0;
    }
    Ok(Some(worst))
}

/// The larger of the errors of attitude, rad, and of rate, rad/s, of interpolation at a share of a
/// gap.
///
/// Readers interpolate in three ways: components of the quaternion, the great arc, or components of
/// the modified Rodrigues parameters (Basilisk, and Orekit without rates). The last has the largest
/// errors, which are not zero on turns at constant rate either.
fn error((before, after): (&State, &State), share: f64, truth: &State) -> f64 {
    let (begin, end) = (
        &before.attitude,
        after.attitude.nearest_sign(&before.attitude),
    );
    let found = [
        Attitude::from_xyzw(blend(begin.xyzw(), end.xyzw(), share)),
        Some(begin.retract(begin.signed_turn_to(&end) * share)),
        from_rodrigues(blend(
            rodrigues(begin, begin),
            rodrigues(&end, begin),
            share,
        )),
    ];
    let angle = |found: &Option<Attitude>| {
        let miss = found.as_ref().map(|found| found.angle_to(&truth.attitude));
        miss.unwrap_or(f64::MAX)
    };
    let rate = before
        .body_rate_rad_s
        .lerp(&after.body_rate_rad_s, share)
        .metric_distance(&truth.body_rate_rad_s);
    found.iter().map(angle).fold(rate, f64::max)
}

fn blend<const N: usize>(a: [f64; N], b: [f64; N], share: f64) -> [f64; N] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share)
}

/// Modified Rodrigues parameters of an attitude: of the two sets the one continuous with the
/// shorter set of a neighbour.
fn rodrigues(attitude: &Attitude, neighbour: &Attitude) -> [f64; 3] {
    let short = |q: [f64; 4]| if q[3] < 0.0 { q.map(|c| -c) } else { q };
    let near = Attitude::from_xyzw(short(neighbour.xyzw()));
    let [x, y, z, w] = near
        .map_or(*attitude, |near| attitude.nearest_sign(&near))
        .xyzw();
    [x, y, z].map(|c| c / (1.0 + w))
}

fn from_rodrigues([x, y, z]: [f64; 3]) -> Option<Attitude> {
    let square = x * x + y * y + z * z;
    Attitude::from_xyzw([2.0 * x, 2.0 * y, 2.0 * z, 1.0 - square])
}
