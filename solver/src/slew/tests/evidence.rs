//! Conditions of the minimum principle along solutions.

use super::craft::{
    OLRAC_AXIS, biros, biros_end, lro, lro_drives, lro_end, olrac, pyramid, pyramid_end, turn,
};
use crate::run::stop::StopSignal;
use crate::slew::evidence::{self, Evidence};
use crate::slew::{
    EnergyMeasure, FinalWheels, Objective, Slew, SlewSpec, TorqueCommand, WheelAllocation, solve,
};

fn evidence_for(spec: &SlewSpec) -> Evidence {
    let slew = Slew::try_new(spec).expect("valid").slew;
    let stop = StopSignal::new();
    let outcome = solve(&slew, &stop);
    assert!(
        outcome.solved,
        "{} {:?}",
        outcome.status, outcome.propagated.failures
    );
    let evidence = evidence::of(&slew, &outcome, &stop).expect("a polished solution");
    println!(
        "{:?} {:?} {:.4} s: H {:.3e} scale {:.4} averages {:.2e} pointwise {:.2e} alone {:.2e} gap {:.2e} defect {:.2e} complementarity {:.2e} switching {:.4}",
        spec.objective,
        spec.command,
        outcome.time_s,
        evidence.hamiltonian,
        evidence.scale,
        evidence.average_spread,
        evidence.pointwise_spread,
        evidence.variation,
        evidence.principle_gap,
        evidence.costate_defect,
        evidence.complementarity,
        evidence.switching_agreement,
    );
    evidence
}

fn fastest(intervals: usize) -> [SlewSpec; 3] {
    let (spacecraft, _, start) = biros(false);
    let command = TorqueCommand::Free { intervals };
    [
        SlewSpec {
            spacecraft,
            start,
            end: biros_end(),
            command,
            ..SlewSpec::default()
        },
        SlewSpec {
            spacecraft: olrac(3),
            end: turn(OLRAC_AXIS, 1.25),
            command,
            ..SlewSpec::default()
        },
        SlewSpec {
            spacecraft: lro(),
            end: lro_end(),
            final_wheels: FinalWheels::Given,
            command,
            ..SlewSpec::default()
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
fn the_hamiltonian_at_a_given_duration_is_the_derivative_of_the_energy_by_it() {
    let at = |duration_s: f64| SlewSpec {
        spacecraft: lro(),
        drives: lro_drives(),
        end: lro_end(),
        final_wheels: FinalWheels::Given,
        objective: Objective::Energy {
            duration_s,
            measure: EnergyMeasure::Proxy,
        },
        command: TorqueCommand::Uniform { intervals: 80 },
        ..SlewSpec::default()
    };
    let evidence = evidence_for(&at(910.0));
    let energy = |duration: f64| {
        let slew = Slew::try_new(&at(duration)).expect("valid").slew;
        solve(&slew, &StopSignal::new()).objective
    };
    let added = energy(912.0) - energy(908.0);
    assert!(
        (evidence.hamiltonian * 4.0 / added - 1.0).abs() < 0.02,
        "{} {added}",
        evidence.hamiltonian
    );
    assert!(evidence.principle_gap < 1e-2);
}

/// The pyramid's published slew with torques allocated by the pseudo-inverse.
fn shared_out(command: TorqueCommand) -> SlewSpec {
    SlewSpec {
        spacecraft: pyramid(),
        end: pyramid_end(),
        final_wheels: FinalWheels::NullSpaceOfStart,
        command,
        allocation: WheelAllocation::PseudoInverse,
        ..SlewSpec::default()
    }
}

#[test]
fn torques_of_the_pseudo_inverse_keep_the_minimum_principle_in_three_controls() {
    let evidence = evidence_for(&shared_out(TorqueCommand::Free { intervals: 60 }));
    assert!(evidence.hamiltonian.abs() <= 1e-5);
    assert!((evidence.scale - 1.0).abs() <= 1e-5);
    assert!(evidence.pointwise_spread <= 1e-5);
    assert!(evidence.principle_gap <= 1e-5);
    assert!(evidence.costate_defect <= 1e-5);
    assert!(evidence.complementarity <= 1e-5);
    assert!(evidence.switching_agreement >= 0.9999);
    let mut intervals = evidence.intervals.iter();
    assert!(intervals.all(|one| one.switching[0].len() == 3 && one.momentum_costate[0].len() == 3));
}

#[test]
fn with_effort_and_without_active_limits_the_switching_function_vanishes() {
    // Away from limits the Hamiltonian is stationary in the torque on all wheels together.
    let evidence = evidence_for(&SlewSpec {
        spacecraft: olrac(5),
        end: turn(OLRAC_AXIS, 1.25),
        objective: Objective::TimeAndEffort { weight: 1e3 },
        command: TorqueCommand::Uniform { intervals: 40 },
        allocation: WheelAllocation::PseudoInverse,
        ..SlewSpec::default()
    });
    let costates = evidence
        .intervals
        .iter()
        .flat_map(|one| &one.momentum_costate[0]);
    let size = costates.fold(0.0_f64, |size, r| size.max(r.abs()));
    // Torque is constant on an interval: the switching function vanishes in its middle.
    let middles = evidence.intervals.iter().flat_map(|one| {
        let [begin, end] = &one.switching;
        begin.iter().zip(end).map(|(a, b)| 0.5 * (a + b).abs())
    });
    let flat = middles.fold(0.0, f64::max);
    assert!(flat < 1e-2 * size, "{flat} of {size}");
    assert!(evidence.principle_gap <= 1e-2);
}
