//! At which times to sample, so that what a reader puts between the samples is close enough.

use super::ExportError;
use slewplan_solver::checker::PropagatedMotion;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::State;

/// Times closer than this, s, are one: formats write nanoseconds, and times must be seen to grow.
pub(super) const CLOSEST_S: f64 = 1e-6;

/// Turn between two samples at most, rad: linear interpolation of quaternions needs it small, and
/// no motion can hide between samples so close.
const WIDEST: f64 = 0.3;
/// Where in a gap the interpolation is compared with the motion.
const PROBES: [f64; 3] = [0.25, 0.5, 0.75];

/// Where to sample between switches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Spacing {
    /// At multiples of a time, s.
    Step(f64),
    /// Evenly between switches, so that attitudes interpolated in any of the usual ways are within
    /// this angle, rad, and linear body rates within the same, rad/s.
    Tolerance(f64),
}

impl Spacing {
    /// A step, s, that can be meant.
    pub(crate) fn checked_step(step_s: f64) -> Result<f64, &'static str> {
        Some(step_s)
            .filter(|step| (1e-3..=1e6).contains(step))
            .ok_or("expected a number of seconds from 0.001 to 1e6")
    }

    /// A tolerance that can be meant: rad, and rad/s.
    pub(crate) fn checked_tolerance(tolerance: f64) -> Result<f64, &'static str> {
        Some(tolerance)
            .filter(|tolerance| (1e-9..=1.0).contains(tolerance))
            .ok_or("expected a number from 1e-9 to 1")
    }
}

/// How to sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sampling {
    pub(super) spacing: Spacing,
    /// Most samples.
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
/// measurement gives the number; every part is then looked at, and their number grows until all
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

/// Largest error of interpolation over equal parts of a gap; `None` when a part turns too far for
/// it to be told.
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
        // By the rates too: a full turn looks like none.
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

/// Angle and rate by which interpolation at a share of a gap misses the truth, the larger number.
///
/// Readers go three ways between two samples: components of the quaternion, the great arc, or
/// components of the modified Rodrigues parameters (Basilisk does, and Orekit without rates). The
/// last costs most: it errs on steady turns too.
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

/// Modified Rodrigues parameters of an attitude: of the two sets the one that is continuous with
/// the shorter of a neighbour.
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
