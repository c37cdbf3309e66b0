//! The minimum principle along solutions.

use super::craft::{OLRAC_AXIS, biros, biros_end, lro, lro_drives, lro_end, olrac, turn};
use crate::manoeuvre::evidence::{self, Evidence};
use crate::manoeuvre::{Command, FinalWheels, Manoeuvre, ManoeuvreSpec, Measure, Objective, solve};
use crate::stop::StopSignal;

fn evidence_for(spec: &ManoeuvreSpec) -> Evidence {
    let manoeuvre = Manoeuvre::try_new(spec).expect("valid").manoeuvre;
    let stop = StopSignal::new();
    let outcome = solve(&manoeuvre, &stop);
    assert!(
        outcome.solved,
        "{} {:?}",
        outcome.status, outcome.flown.failures
    );
    let evidence = evidence::of(&manoeuvre, &outcome, &stop).expect("a polished solution");
    println!(
        "{:?} {:?} {:.4} s: H {:.3e} scale {:.4} averages {:.2e} pointwise {:.2e} gap {:.2e} defect {:.2e} complementarity {:.2e} switching {:.4}",
        spec.objective,
        spec.command,
        outcome.time_s,
        evidence.hamiltonian,
        evidence.scale,
        evidence.average_spread,
        evidence.pointwise_spread,
        evidence.principle_gap,
        evidence.costate_defect,
        evidence.complementarity,
        evidence.switching_agreement,
    );
    evidence
}

fn fastest(intervals: usize) -> [ManoeuvreSpec; 3] {
    let (spacecraft, _, start) = biros(false);
    let command = Command::Free { intervals };
    [
        ManoeuvreSpec {
            spacecraft,
            start,
            end: biros_end(),
            command,
            ..ManoeuvreSpec::default()
        },
        ManoeuvreSpec {
            spacecraft: olrac(3),
            end: turn(OLRAC_AXIS, 1.25),
            command,
            ..ManoeuvreSpec::default()
        },
        ManoeuvreSpec {
            spacecraft: lro(),
            end: lro_end(),
            final_wheels: FinalWheels::Given,
            command,
            ..ManoeuvreSpec::default()
        },
    ]
}

#[test]
fn the_hamiltonian_of_minimum_time_is_constant() {
    for spec in fastest(60) {
        let evidence = evidence_for(&spec);
        assert!(evidence.hamiltonian.abs() <= 1e-3);
        assert!((evidence.scale - 1.0).abs() <= 1e-2);
        assert!(evidence.average_spread <= 1e-3);
        assert!(evidence.pointwise_spread <= 1e-2);
        assert!(evidence.complementarity <= 1e-5);
        assert!(evidence.switching_agreement >= 0.97);
    }
}

#[test]
fn the_hamiltonian_of_a_given_time_is_what_a_second_more_adds() {
    let at = |duration_s: f64| ManoeuvreSpec {
        spacecraft: lro(),
        drives: lro_drives(),
        end: lro_end(),
        final_wheels: FinalWheels::Given,
        objective: Objective::Energy {
            duration_s,
            measure: Measure::Proxy,
        },
        command: Command::Uniform { intervals: 80 },
        ..ManoeuvreSpec::default()
    };
    let evidence = evidence_for(&at(910.0));
    let energy = |duration: f64| {
        let manoeuvre = Manoeuvre::try_new(&at(duration)).expect("valid").manoeuvre;
        solve(&manoeuvre, &StopSignal::new()).objective
    };
    let added = energy(912.0) - energy(908.0);
    assert!(
        (evidence.hamiltonian * 4.0 / added - 1.0).abs() < 0.02,
        "{} {added}",
        evidence.hamiltonian
    );
    assert!(evidence.principle_gap < 1e-2);
}
