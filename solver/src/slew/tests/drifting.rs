//! Slews while speed laws change the momentum of wheels: the costate of time and the Hamiltonian.

use super::craft::{biros, biros_end, lro_drives, solved};
use crate::model::drive::SpeedLawSpec;
use crate::run::stop::StopSignal;
use crate::slew::evidence::{self, Evidence};
use crate::slew::{EnergyMeasure, Objective, Slew, SlewSpec, TorqueCommand};
use nalgebra::Vector3;

/// Speeds of the wheels under a speed law, rad/s: at the start, and of the law.
const SPEEDS: [f64; 2] = [-200.0, 400.0];
/// Rate of the speed law, 1/s: most of the change of speed happens during the slew.
const RATE: f64 = 0.1;

/// A slew whose speed laws are ahead by a time, s, with the same momenta of the commanded wheels and of
/// the whole spacecraft.
fn ahead(by: f64, objective: Objective, command: TorqueCommand) -> SlewSpec {
    let (spacecraft, mut drives, mut start) = biros(true);
    for drive in &mut drives[..3] {
        drive.motor.clone_from(&lro_drives()[0].motor);
    }
    for drive in &mut drives[3..] {
        drive.speed_law = Some(SpeedLawSpec {
            rate_per_s: RATE,
            speed_rad_s: SPEEDS[1],
        });
    }
    let held = SPEEDS[1] + (SPEEDS[0] - SPEEDS[1]) * (-RATE * by).exp();
    let spins = spacecraft.wheels[3..].iter();
    let spins = spins.map(|wheel| Vector3::from(wheel.axis) * wheel.inertia_kg_m2);
    let taken = spins.sum::<Vector3<f64>>() * (held - SPEEDS[0]);
    let choice = SlewSpec {
        spacecraft: spacecraft.clone(),
        drives,
        start: start.clone(),
        end: biros_end(),
        objective,
        command,
        ..SlewSpec::default()
    };
    let slew = Slew::try_new(&choice).expect("valid").slew;
    // The body has the opposite of the momentum that the wheels under a speed law have taken up.
    let rate = -(slew.vehicle().dynamics.inertia_inverse * taken);
    let mut speeds = vec![held; 7];
    for (speed, wheel) in speeds.iter_mut().zip(&spacecraft.wheels[..3]) {
        *speed = -Vector3::from(wheel.axis).dot(&rate);
    }
    start.body_rate_rad_s = Some(rate.into());
    start.wheel_speed_rad_s = Some(speeds);
    SlewSpec { start, ..choice }
}

fn evidence_for(spec: &SlewSpec) -> Evidence {
    let slew = Slew::try_new(spec).expect("valid").slew;
    let outcome = solved(spec);
    let found = evidence::of(&slew, &outcome, &StopSignal::new()).expect("a polished solution");
    println!(
        "H {:.3e} scale {:.4} averages {:.2e} pointwise {:.2e} alone {:.2e} gap {:.2e} defect {:.2e}",
        found.hamiltonian,
        found.scale,
        found.average_spread,
        found.pointwise_spread,
        found.variation,
        found.principle_gap,
        found.costate_defect,
    );
    found
}

/// Derivative of the objective by an advance of the speed law, per s, by central differences.
fn difference(objective: Objective, command: TorqueCommand) -> f64 {
    let by = 0.05;
    let value = |by: f64| solved(&ahead(by, objective, command)).objective;
    (value(by) - value(-by)) / (2.0 * by)
}

#[test]
fn the_hamiltonian_of_drifting_wheels_is_constant_only_with_the_costate_of_time() {
    let command = TorqueCommand::Free { intervals: 40 };
    let found = evidence_for(&ahead(0.0, Objective::MinimumTime, command));
    assert!(found.hamiltonian.abs() <= 2e-3);
    assert!(found.average_spread <= 1e-2 && found.pointwise_spread <= 1e-2);
    // Without the costate of time it is not constant.
    assert!(found.variation > 5e-2 && found.variation > 10.0 * found.pointwise_spread);
    assert!(found.costate_defect <= 1e-2);
    assert!(found.complementarity <= 1e-5);
    assert!(found.switching_agreement >= 0.97);
}

#[test]
fn the_costate_of_time_is_the_derivative_of_the_duration_by_an_advance_of_the_law() {
    let command = TorqueCommand::Uniform { intervals: 60 };
    let found = evidence_for(&ahead(0.0, Objective::MinimumTime, command));
    let changed = difference(Objective::MinimumTime, command);
    let [costate, _] = found.intervals[0].time_costate;
    println!("{costate} {changed}");
    assert!(changed.abs() > 2e-2 && (costate / changed - 1.0).abs() < 1e-2);
}

#[test]
fn the_costate_of_time_is_the_derivative_of_the_energy_by_an_advance_of_the_law() {
    // The times of all nodes are given, and the Hamiltonian is not zero.
    let command = TorqueCommand::Uniform { intervals: 60 };
    let objective = |duration_s: f64| Objective::Energy {
        duration_s,
        measure: EnergyMeasure::Proxy,
    };
    let found = evidence_for(&ahead(0.0, objective(14.0), command));
    let changed = difference(objective(14.0), command);
    let [costate, _] = found.intervals[0].time_costate;
    println!("{costate} {changed}");
    assert!((costate / changed - 1.0).abs() < 1e-2);
    let energy = |duration: f64| solved(&ahead(0.0, objective(duration), command)).objective;
    let added = (energy(14.1) - energy(13.9)) / 0.2;
    println!("{} {added}", found.hamiltonian);
    assert!((found.hamiltonian / added - 1.0).abs() < 2e-2);
    assert!(found.variation > 3.0 * found.pointwise_spread);
}
