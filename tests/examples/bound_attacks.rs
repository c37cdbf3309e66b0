//! Attacks on the proved bounds: motions and solved legs, none of which may be below its bound. Prints how
//! close they come; fails if one is below.
//!
//! ```text
//! bound_attacks motions COUNT                extremals of random polytopes of rates beside least times
//! bound_attacks CLASS COUNT                  legs between random attitudes, some from each of many spacecraft
//! bound_attacks CLASS COUNT confirmed        the same beside bounds that are proved with outward rounding
//! ```
//!
//! Classes are those of [`Class`]; `all` stands for every class.

use nalgebra::Vector3;
use slewplan_solver::bounds::polytope::RatePolytope;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{AttitudeEquivalence, AttitudeSpec, ScenarioSpec, TargetSpec};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{ProofEffort, Shard, leg_table, strongest_bounds};
use slewplan_solver::wheels::envelope::momentum_problems;
use slewplan_tests::extremals::{extremal, vertices};
use slewplan_tests::general::{loaded_slew, slew};
use slewplan_tests::motions::half_spaces;
use slewplan_tests::pointed_target;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{on_threads, scenario_of};
use std::process::ExitCode;

/// Targets of each spacecraft.
const TARGETS: usize = 5;
/// Extremals of each polytope.
const EXTREMALS: usize = 40;
/// Relative error of motions that are followed in closed form.
const FOLLOWED: f64 = 1e-9;
/// Relative error of the durations of programs that are not flown.
const CONVERGED: f64 = 1e-6;

/// What is special about the legs of a class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    /// Three to six wheels on any axes.
    Arrays,
    /// The same with limits of the rate's components.
    RateLimits,
    /// The same with a limit of the rate's norm.
    NormLimit,
    /// Torques of several sizes, so that ramps take several times.
    UnequalRamps,
    /// Torques that are larger in one direction.
    AsymmetricTorques,
    /// Wheels without a limit of their speed, and limits of the rate.
    NoSpeedLimit,
    /// Up to a quarter of the wheels' speeds stored.
    Momentum,
    /// Up to nine tenths stored.
    LoadedWheels,
    /// Quaternions that have to arrive with the given sign.
    SignedQuaternions,
    /// Targets with a free roll.
    FreeRoll,
    /// Targets that stop z alone.
    ZeroAboutZ,
}

const CLASSES: [(&str, Class); 11] = [
    ("arrays", Class::Arrays),
    ("rate-limits", Class::RateLimits),
    ("norm-limit", Class::NormLimit),
    ("unequal-ramps", Class::UnequalRamps),
    ("asymmetric-torques", Class::AsymmetricTorques),
    ("no-speed-limit", Class::NoSpeedLimit),
    ("momentum", Class::Momentum),
    ("loaded-wheels", Class::LoadedWheels),
    ("signed-quaternions", Class::SignedQuaternions),
    ("free-roll", Class::FreeRoll),
    ("zero-about-z", Class::ZeroAboutZ),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (name, count, effort) = match words[..] {
        [name, count] => (name, count, ProofEffort::Once),
        [name, count, "confirmed"] => (name, count, ProofEffort::Confirmed),
        _ => panic!("motions, all or a class, and a count"),
    };
    let count: usize = count.parse().expect("a whole number");
    let mut below = 0;
    if name == "motions" {
        below += motions(count);
    }
    for (of, class) in CLASSES {
        if name == of || name == "all" {
            below += legs(of, class, count, effort);
        }
    }
    println!("below their bounds: {below}");
    ExitCode::from(u8::from(below > 0))
}

/// How many extremals of random polytopes are faster than the bound on their turn.
fn motions(count: usize) -> usize {
    let mut random = Generator::new(31);
    let (mut tried, mut tight, mut below, mut closest) = (0, 0, 0, f64::INFINITY);
    for number in 0.. {
        if tried >= count {
            break;
        }
        let half_spaces = half_spaces(number, &mut random);
        let Some(limited) = RatePolytope::within(&half_spaces) else {
            continue;
        };
        let vertices = vertices(&half_spaces);
        let slowest = half_spaces.iter().map(Vector3::norm).fold(0.0, f64::max);
        for _ in 0..EXTREMALS {
            let duration = random.between(0.02, 2.0) * slowest;
            let costate = Vector3::from(random.direction());
            let turn = extremal(&vertices, costate, duration);
            let turn = Attitude::from_xyzw(turn.coords.into()).expect("a unit quaternion");
            let ratio = duration / limited.least_time(&turn, 1e-4).lower_s;
            tried += 1;
            tight += usize::from(ratio < 1.0 + 1e-3);
            below += usize::from(ratio < 1.0 - FOLLOWED);
            closest = closest.min(ratio);
        }
    }
    println!(
        "{tried} extremals, {tight} within 1e-3 of their bound; duration over bound {closest:.9} at least"
    );
    below
}

/// How many solved legs are faster than their strongest bound.
fn legs(name: &str, class: Class, count: usize, effort: ProofEffort) -> usize {
    let mut random = Generator::new(32);
    let (kind, error) = match class {
        Class::ZeroAboutZ => (LegKind::LowerBound, CONVERGED),
        _ => (LegKind::RestToRest, 0.0),
    };
    let (mut below, mut shares) = (0, Vec::new());
    for number in 0.. {
        if shares.len() >= count {
            break;
        }
        let Some(spec) = spacecraft_with_targets(class, number, &mut random) else {
            continue;
        };
        let scenario = scenario_of(&spec);
        let all = Shard { index: 0, of: 1 };
        let (rows, _) = on_threads(2, |run| leg_table(&scenario, kind, all, run));
        let names: Vec<_> = rows
            .iter()
            .map(|row| (row.from.clone(), row.to.clone()))
            .collect();
        let bounds = on_threads(2, |run| strongest_bounds(&scenario, &names, effort, run));
        for (row, bound) in rows.iter().zip(bounds.legs) {
            let (Some(duration_s), Some(bound)) = (row.duration_s, bound) else {
                continue;
            };
            let share = bound.bound_s / duration_s;
            if share > 1.0 + error {
                below += 1;
                println!("{name} {number}, {} to {}: {share:.9}", row.from, row.to);
            }
            shares.push(share);
        }
    }
    shares.sort_by(f64::total_cmp);
    if let [least, .., most] = shares[..] {
        let median = shares[shares.len() / 2];
        println!(
            "{name}: {} legs, bound over duration {least:.4} at least, median {median:.4}, {most:.9} at most",
            shares.len()
        );
    }
    below
}

/// A spacecraft of a class with targets in random attitudes; `None` where its wheels cannot hold its momentum.
fn spacecraft_with_targets(
    class: Class,
    number: u64,
    random: &mut Generator,
) -> Option<ScenarioSpec> {
    let mut spec = match class {
        Class::RateLimits => slew(40, 8 * number + 4),
        Class::Momentum => slew(40, 8 * number + 6),
        Class::LoadedWheels => loaded_slew(40, number),
        _ => slew(40, 8 * number),
    };
    let craft = &mut spec.spacecraft;
    let rates = craft.wheels.iter().zip(0..).map(|(wheel, n)| {
        let speed = wheel.max_speed_rad_s.expect("every wheel has one");
        wheel.inertia_kg_m2 * speed / craft.inertia_kg_m2[n % 3][n % 3]
    });
    let rate = rates.fold(f64::INFINITY, f64::min);
    match class {
        Class::NormLimit => {
            craft.max_body_rate_norm_rad_s = Some(random.between(0.2, 1.5) * rate);
        }
        Class::UnequalRamps => {
            for wheel in &mut craft.wheels {
                wheel.max_torque_nm *= random.logarithmic(0.2, 1.0);
            }
        }
        Class::AsymmetricTorques => {
            for wheel in &mut craft.wheels {
                wheel.min_torque_nm = Some(-wheel.max_torque_nm * random.between(0.3, 1.0));
            }
        }
        Class::NoSpeedLimit => {
            for wheel in &mut craft.wheels {
                wheel.max_speed_rad_s = None;
            }
            craft.max_body_rate_rad_s = [(); 3].map(|()| Some(random.between(0.3, 1.0) * rate));
        }
        Class::SignedQuaternions => {
            spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
        }
        _ => {}
    }
    spec.targets = (0..TARGETS)
        .map(|target| {
            let id = format!("t{target}");
            if class == Class::FreeRoll {
                let ra_dec_deg = [random.between(0.0, 360.0), random.between(-90.0, 90.0)];
                return pointed_target(&id, random.direction(), ra_dec_deg, None);
            }
            TargetSpec {
                id,
                attitude: AttitudeSpec::Quaternion(random.quaternion()),
                zero_rate_axes: (class == Class::ZeroAboutZ).then_some([false, false, true]),
                ..TargetSpec::default()
            }
        })
        .collect();
    let scenario = Scenario::try_new(&spec).ok()?.scenario;
    momentum_problems(&scenario).is_empty().then_some(spec)
}
