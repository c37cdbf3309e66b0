//! The slews of BIROS: torques held on the samples of a clock.

use super::craft::{biros, biros_end, diagonal, solved, turn};
use crate::model::spec::SpacecraftSpec;
use crate::slew::{Objective, SampleHold, SlewOutcome, SlewSpec, TorqueCommand};

fn biros_slew(pyramid: bool, command: TorqueCommand) -> SlewOutcome {
    let (spacecraft, drives, start) = biros(pyramid);
    solved(&SlewSpec {
        spacecraft,
        drives,
        start,
        end: biros_end(),
        objective: Objective::MinimumTime,
        command,
        ..SlewSpec::default()
    })
}

const TWO_HERTZ: TorqueCommand = TorqueCommand::Sampled {
    period_s: 0.5,
    hold: SampleHold::Constant,
};

#[test]
fn the_slew_takes_nineteen_samples_with_and_without_the_small_wheels() {
    for pyramid in [false, true] {
        let outcome = biros_slew(pyramid, TWO_HERTZ);
        let continuous = outcome.continuous_time_s.expect("a continuous minimum");
        assert!(continuous <= 9.30, "{continuous}");
        assert_eq!(outcome.propagated.pieces.len(), 19);
        assert!((outcome.time_s - 9.5).abs() < 1e-9);
        assert!(outcome.propagated.attitude_error_rad <= 1e-7);
        assert!(outcome.propagated.rate_error_rad_s <= 1e-5);
    }
}

#[test]
fn torques_under_linear_hold_are_continuous() {
    let command = TorqueCommand::Sampled {
        period_s: 0.5,
        hold: SampleHold::Linear,
    };
    let outcome = biros_slew(true, command);
    assert!(outcome.time_s >= 9.5 - 1e-9);
    for pair in outcome.propagated.pieces.windows(2) {
        let steps = pair[0].torque_end_nm.iter().zip(&pair[1].torque_begin_nm);
        assert!(steps.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-8);
    }
}

#[test]
fn continuous_torques_take_at_most_five_per_cent_longer_than_jumping_ones() {
    let free = biros_slew(false, TorqueCommand::Free { intervals: 24 }).time_s;
    let smooth = biros_slew(false, TorqueCommand::Smooth { intervals: 40 }).time_s;
    assert!(free < smooth && smooth < 1.05 * free, "{free} {smooth}");
}

#[test]
fn a_sampled_turn_by_thirty_degrees_about_one_axis_takes_ten_seconds() {
    let (spacecraft, drives, start) = biros(false);
    let outcome = solved(&SlewSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: diagonal([10.0, 10.0, 10.0]),
            wheels: spacecraft.wheels,
            ..SpacecraftSpec::default()
        },
        drives,
        start,
        end: turn([0.0, 0.0, 1.0], 30_f64.to_radians()),
        objective: Objective::MinimumTime,
        command: TWO_HERTZ,
        ..SlewSpec::default()
    });
    assert!((outcome.time_s - 10.0).abs() < 1e-9, "{}", outcome.time_s);
}
