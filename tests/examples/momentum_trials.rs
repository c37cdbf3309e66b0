//! Random trials of the second proof of bounds with stored momentum: the bounds on single slews, true ones and ones
//! that are too large. Prints what was found; fails if anything was not as it has to be.
//!
//! The full size (1,000 bounds, 200 that are too large) is divided by the argument.

use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{
    LegCertificate, PlanCertificate, Shard, Verdict, leg_table, verify_certificate,
};
use slewplan_tests::general::{loaded_slew, slew};
use slewplan_tests::solving::{on_threads, scenario_of};
use std::process::ExitCode;
use std::time::Instant;

/// Seed of the slews.
const SEED: u64 = 29;
/// By how much a bound is too large, or a spacecraft faster than the one it is true of.
const TOO_LARGE: f64 = 1.001;
const FASTER: f64 = 1.01;

fn main() -> ExitCode {
    let divisor = std::env::args()
        .nth(1)
        .map_or(1, |text| text.parse().expect("a whole number"));
    let faults = confirmed(1000_u64.div_ceil(divisor)) + refused(200_u64.div_ceil(divisor));
    println!("faults: {faults}");
    ExitCode::from(u8::from(faults > 0))
}

/// Every second one with wheels near their limits, every second one with limits of the body rate.
fn spec(number: u64) -> ScenarioSpec {
    let half = number / 2;
    if number.is_multiple_of(2) {
        loaded_slew(SEED, half)
    } else {
        slew(SEED, 8 * (half / 2) + 6 + half % 2)
    }
}

/// The bound on the slew of a scenario, s.
fn bound(spec: &ScenarioSpec) -> f64 {
    let whole = Shard { index: 0, of: 1 };
    let scenario = scenario_of(spec);
    let (rows, _) = on_threads(1, |run| {
        leg_table(&scenario, LegKind::Certified, whole, run)
    });
    let row = rows.iter().find(|row| row.from == "start");
    let bound = row.and_then(|row| row.certified_lower_bound_s);
    bound.expect("wheels have limits of speed")
}

/// The verdict on a bound on the slew of a scenario, s.
fn verdict(spec: &ScenarioSpec, bound: f64) -> Verdict {
    let leg = LegCertificate {
        from: "start".to_owned(),
        to: spec.targets[0].id.clone(),
        lower_bound_s: Some(bound),
        duration_s: None,
    };
    let certificate = PlanCertificate {
        legs: vec![leg],
        ..PlanCertificate::default()
    };
    let scenario = scenario_of(spec);
    let checked = on_threads(1, |run| verify_certificate(&scenario, &certificate, run));
    checked.legs[0].clone()
}

/// How many true bounds are not confirmed.
fn confirmed(count: u64) -> usize {
    let (mut faults, mut times) = (0, Vec::new());
    for number in 0..count {
        let spec = spec(number);
        let bound = bound(&spec);
        let started = Instant::now();
        let verdict = verdict(&spec, bound);
        times.push(started.elapsed().as_secs_f64());
        if verdict != Verdict::Confirmed {
            println!("{number} is not confirmed: {verdict:?}");
            faults += 1;
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{count} bounds: {faults} not confirmed; each proved twice in {:.3} s in the median, {:.2} s at most",
        times[times.len() / 2],
        times[times.len() - 1]
    );
    faults
}

/// How many bounds that are too large are confirmed.
fn refused(count: u64) -> usize {
    let mut faults = 0;
    for number in 0..count {
        let mut spec = spec(number);
        let mut claimed = bound(&spec);
        if number % 4 < 2 {
            claimed *= TOO_LARGE;
        } else {
            for wheel in &mut spec.spacecraft.wheels {
                wheel.max_torque_nm *= FASTER;
                wheel.min_torque_nm = wheel.min_torque_nm.map(|torque| torque * FASTER);
                wheel.max_speed_rad_s = wheel.max_speed_rad_s.map(|speed| speed * FASTER);
            }
            let limits = &mut spec.spacecraft.max_body_rate_rad_s;
            *limits = limits.map(|limit| limit.map(|rate| rate * FASTER));
            let norm = &mut spec.spacecraft.max_body_rate_norm_rad_s;
            *norm = norm.map(|rate| rate * FASTER);
        }
        if !matches!(verdict(&spec, claimed), Verdict::Rejected(_)) {
            println!("{number} is not rejected");
            faults += 1;
        }
    }
    println!("{count} bounds that are too large: {faults} not rejected");
    faults
}
