//! Schedules in a pass: windows and values for the published spacecraft, and what the planner makes of
//! them.
//!
//! ```sh
//! cargo run --release -p slewplan-tests --example clock -- [rest|four|roll|free] TARGETS PASS_S SEED LIMIT_S
//! ```
//!
//! At rest, also with a fourth wheel or with a free roll about the camera's axis; or with free rates.
//! Each target has a window of 60 to 120 s somewhere in the pass and a value of 1 to 9.

use nalgebra::{UnitQuaternion, Vector3};
use slewplan_solver::model::plan::{Outcome, Plan};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{AttitudeSpec, BoresightChoice, PointingSpec, WheelSpec};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::progress::{Observer, Progress};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::{Run, solve};
use slewplan_tests::schedules::{Pass, RateConditions, pass};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, default: u32| -> u32 {
        let given = arguments.get(at).and_then(|text| text.parse().ok());
        given.unwrap_or(default)
    };
    let rates = match arguments.first().map(String::as_str) {
        Some("rest" | "four" | "roll") => RateConditions::AllZero,
        _ => RateConditions::ZeroAboutZ,
    };
    let mut spec = pass(Pass {
        rates,
        targets: number(1, 12).try_into()?,
        duration_s: number(2, 600).into(),
        seed: number(3, 1).into(),
    });
    match arguments.first().map(String::as_str) {
        Some("four") => spec.spacecraft.wheels.push(WheelSpec {
            axis: [1.0, 1.0, 1.0],
            ..spec.spacecraft.wheels[0].clone()
        }),
        Some("roll") => {
            for target in &mut spec.targets {
                target.pointing = Some(pointing_of(&target.attitude)?);
            }
        }
        _ => {}
    }
    spec.options.time_limit_s = Some(number(4, 120).into());
    let scenario = Scenario::try_new(&spec)
        .map_err(|problems| format!("{problems:?}"))?
        .scenario;
    let (pool, stop) = (SolverPool::new(None)?, StopSignal::new());
    let observer = Telling(Instant::now());
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &observer,
        legs: &NoStore,
        segments: &NoStore,
    };
    match solve(&scenario, run) {
        Outcome::Planned(plan) => print(&plan),
        Outcome::Infeasible(problems) | Outcome::Failed(problems) => {
            for problem in problems {
                println!("{problem}");
            }
        }
        Outcome::StoppedEmpty => println!("stopped before a first plan"),
    }
    Ok(())
}

/// The direction of the camera, z, in an attitude of roll, pitch and yaw, with a free roll about it.
fn pointing_of(attitude: &AttitudeSpec) -> Result<PointingSpec, Box<dyn std::error::Error>> {
    let AttitudeSpec::RollPitchYawDeg(degrees) = attitude else {
        return Err("the targets of a strip have roll, pitch and yaw".into());
    };
    let [roll, pitch, yaw] = degrees.map(f64::to_radians);
    let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    let direction = turn * Vector3::z();
    Ok(PointingSpec {
        boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
        direction: Some([direction.x, direction.y, direction.z].into()),
        ..PointingSpec::default()
    })
}

/// Prints every plan that is better than those before.
struct Telling(Instant);

impl Observer for Telling {
    fn progress(&self, _: Progress) {}

    fn incumbent(&self, plan: &Plan) {
        let value = plan
            .schedule
            .as_ref()
            .map_or((0.0, 0.0), |s| (s.value, s.value_bound));
        println!(
            "{:8.2} s: value {} of at most {}, {:.3} s",
            self.0.elapsed().as_secs_f64(),
            value.0,
            value.1,
            plan.total_time_s,
        );
    }
}

fn print(plan: &Plan) {
    for visit in &plan.flight.passages {
        println!("{:9.3} s  {}", visit.time_s, visit.target);
    }
    let statistics = &plan.statistics;
    println!(
        "{:?} after {:.2} s: {:.3} s, at least {:.3} s; {} nodes, {} legs, {:?}",
        plan.optimality,
        statistics.wall_time_s,
        plan.total_time_s,
        plan.lower_bound_s,
        statistics.nodes_explored,
        statistics.legs_solved,
        statistics.nlp_solves_by_kind,
    );
    if let Some(schedule) = &plan.schedule {
        println!(
            "value {} of at most {}",
            schedule.value, schedule.value_bound
        );
        for wait in &schedule.waits {
            println!(
                "waits in {} from {:.3} s to {:.3} s",
                wait.target, wait.from_s, wait.to_s
            );
        }
        for skipped in &schedule.skipped {
            println!(
                "skips {}: {} {:?}",
                skipped.target, skipped.reason, skipped.inclusion
            );
        }
    }
}
