//! The slews of the energy thesis: the proxy, the bill, and durations at a given energy.

use super::craft::{lro, lro_drives, lro_end, solved};
use crate::slew::{EnergyMeasure, FinalWheels, Objective, SlewOutcome, SlewSpec, TorqueCommand};

/// Duration and bill of the slew about the eigenaxis.
const EIGENAXIS_S: f64 = 910.1;
const EIGENAXIS_J: f64 = 28.12;

fn lro_slew(objective: Objective, command: TorqueCommand) -> SlewOutcome {
    solved(&SlewSpec {
        spacecraft: lro(),
        drives: lro_drives(),
        end: lro_end(),
        final_wheels: FinalWheels::Given,
        objective,
        command,
        ..SlewSpec::default()
    })
}

#[test]
fn the_optimum_of_the_proxy_and_its_bill_are_as_published() {
    let objective = Objective::Energy {
        duration_s: EIGENAXIS_S,
        measure: EnergyMeasure::Proxy,
    };
    let outcome = lro_slew(objective, TorqueCommand::Uniform { intervals: 80 });
    assert!(outcome.objective <= 6.65, "{}", outcome.objective);
    let bill = outcome.propagated.energies.bill_j;
    assert!((bill - 17.5).abs() < 0.2, "{bill}");
}

#[test]
fn the_optimum_of_the_proxy_has_the_eigenaxis_bill_at_870_seconds() {
    let objective = Objective::MinimumTimeAtEnergy {
        energy_j: EIGENAXIS_J,
        measure: EnergyMeasure::Proxy,
    };
    let outcome = lro_slew(objective, TorqueCommand::Uniform { intervals: 80 });
    assert!(
        (869.0..=870.0).contains(&outcome.time_s),
        "{}",
        outcome.time_s
    );
}

#[test]
fn minimising_the_bill_itself_lowers_it_below_that_of_the_proxy() {
    let objective = Objective::Energy {
        duration_s: EIGENAXIS_S,
        measure: EnergyMeasure::Bill,
    };
    let outcome = lro_slew(objective, TorqueCommand::Uniform { intervals: 120 });
    assert!(outcome.objective <= 13.2, "{}", outcome.objective);
}

#[test]
fn minimum_time_at_the_eigenaxis_bill_is_a_minute_shorter() {
    let objective = Objective::MinimumTimeAtEnergy {
        energy_j: EIGENAXIS_J,
        measure: EnergyMeasure::Bill,
    };
    let outcome = lro_slew(objective, TorqueCommand::Uniform { intervals: 120 });
    assert!(outcome.time_s <= 849.0, "{}", outcome.time_s);
    assert!(outcome.propagated.energies.bill_j <= EIGENAXIS_J);
}

#[test]
fn minimum_time_is_a_quarter_shorter_than_the_eigenaxis() {
    let outcome = lro_slew(
        Objective::MinimumTime,
        TorqueCommand::Free { intervals: 32 },
    );
    assert!(outcome.time_s <= 682.0, "{}", outcome.time_s);
}

#[test]
fn a_limit_on_energy_that_is_not_active_gives_the_fastest_slew() {
    let command = TorqueCommand::Uniform { intervals: 40 };
    let fastest = lro_slew(Objective::MinimumTime, command);
    for (measure, plenty) in [(EnergyMeasure::Proxy, 2.0), (EnergyMeasure::Bill, 1e3)] {
        let energy_j = plenty * fastest.propagated.energies.bill_j;
        let objective = Objective::MinimumTimeAtEnergy { energy_j, measure };
        let outcome = lro_slew(objective, command);
        let excess = outcome.time_s / fastest.time_s - 1.0;
        assert!(excess.abs() < 1e-6, "{measure:?}: {excess}");
    }
}
