//! Plans a tour through three targets and tests it with the independent checker.

use slewplan_solver::checker::verify;
use slewplan_solver::model::plan::Outcome;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec, WheelSpec};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::progress::Silent;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::{Run, solve};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut spec = ScenarioSpec::default();
    spec.spacecraft.inertia_kg_m2 = [[6.63, 0.0, 0.0], [0.0, 8.90, 0.0], [0.0, 0.0, 9.63]];
    for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        spec.spacecraft.wheels.push(WheelSpec {
            axis,
            normalize_axis: true,
            inertia_kg_m2: 0.000_169,
            max_torque_nm: 0.0101,
            min_torque_nm: None,
            max_speed_rad_s: Some(710.0),
            enabled: true,
        });
    }
    for (id, angles) in [("a", [15, 0, 10]), ("b", [25, 0, 50]), ("c", [15, 0, 130])] {
        spec.targets.push(TargetSpec {
            id: id.into(),
            attitude: AttitudeSpec::RollPitchYawDeg(angles.map(f64::from)),
            // Only the z component of the body rate has to vanish.
            zero_rate_axes: Some([false, false, true]),
            ..TargetSpec::default()
        });
    }
    let validated = Scenario::try_new(&spec).map_err(|problems| format!("{problems:?}"))?;

    let (pool, stop) = (SolverPool::new(None)?, StopSignal::new());
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &Silent,
        legs: &NoStore,
        segments: &NoStore,
    };
    let Outcome::Planned(plan) = solve(&validated.scenario, run) else {
        return Err("no plan was found".into());
    };
    for visit in &plan.flight.passages {
        println!("{:7.2} s  {}", visit.time_s, visit.target);
    }
    println!("No plan takes less than {:.2} s.", plan.lower_bound_s);
    let report = verify(&validated.scenario, &plan.flight);
    assert!(report.verification.passed, "{report:?}");
    Ok(())
}
