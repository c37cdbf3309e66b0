//! Combinations of objectives, commands and drives that no source has; all solutions are propagated.

use super::craft::{
    OLRAC_AXIS, biros, biros_end, lro, lro_drives, lro_end, olrac, pyramid, pyramid_end, solved,
    turn,
};
use crate::model::drive::{DriveSpec, MotorSpec, SpeedLawSpec};
use crate::model::spec::StateSpec;
use crate::run::stop::StopSignal;
use crate::slew::{
    EnergyMeasure, FinalWheels, Objective, SampleHold, Slew, SlewSpec, Sweep, TorqueCommand, solve,
    trade_curve,
};

fn minimum_energy(command: TorqueCommand, measure: EnergyMeasure) -> SlewSpec {
    SlewSpec {
        spacecraft: lro(),
        drives: lro_drives(),
        end: lro_end(),
        final_wheels: FinalWheels::Given,
        objective: Objective::Energy {
            duration_s: 900.0,
            measure,
        },
        command,
        ..SlewSpec::default()
    }
}

#[test]
fn energies_under_all_commands_are_within_five_per_cent() {
    let hold = |hold| TorqueCommand::Sampled {
        period_s: 10.0,
        hold,
    };
    for measure in [EnergyMeasure::Proxy, EnergyMeasure::Bill] {
        let energies = [
            TorqueCommand::Free { intervals: 60 },
            TorqueCommand::Uniform { intervals: 90 },
            TorqueCommand::Smooth { intervals: 60 },
            hold(SampleHold::Constant),
            hold(SampleHold::Linear),
        ]
        .map(|command| solved(&minimum_energy(command, measure)).objective);
        let least = energies.iter().copied().fold(f64::INFINITY, f64::min);
        for energy in energies {
            assert!(energy < 1.05 * least, "{measure:?} {energies:?}");
        }
    }
}

#[test]
fn a_slew_that_ends_as_it_begins_takes_no_time_and_no_energy() {
    let sampled = TorqueCommand::Sampled {
        period_s: 10.0,
        hold: SampleHold::Constant,
    };
    let commands = [
        TorqueCommand::default(),
        TorqueCommand::Uniform { intervals: 10 },
        TorqueCommand::Smooth { intervals: 10 },
        sampled,
    ];
    for command in commands {
        let mut spec = SlewSpec {
            end: StateSpec::default(),
            final_wheels: FinalWheels::Free,
            objective: Objective::MinimumTime,
            ..minimum_energy(command, EnergyMeasure::Proxy)
        };
        let still = solved(&spec);
        let most = if command == sampled { 20.0 } else { 0.0 };
        assert!(still.time_s <= most && still.effort < 1e-12, "{still:?}");
        spec.objective = minimum_energy(command, EnergyMeasure::Proxy).objective;
        let still = solved(&spec);
        assert!((still.time_s - 900.0).abs() < 1e-6 && still.objective.abs() < 1e-9);
    }
}

#[test]
fn the_bill_includes_efficiency_and_quiescent_power() {
    let mut spec = minimum_energy(
        TorqueCommand::Uniform { intervals: 60 },
        EnergyMeasure::Bill,
    );
    let ideal = solved(&spec).objective;
    for drive in &mut spec.drives {
        drive.motor = Some(MotorSpec {
            resistance_ohm: 0.343,
            torque_constant_nm_a: 0.0705,
            efficiency: Some(0.8),
            quiescent_power_w: Some(0.01),
        });
    }
    let real = solved(&spec).objective;
    assert!(
        (real / (ideal / 0.8 + 4.0 * 0.01 * 900.0) - 1.0).abs() < 1e-3,
        "{ideal} {real}"
    );
    spec.objective = Objective::MinimumTimeAtEnergy {
        energy_j: real,
        measure: EnergyMeasure::Bill,
    };
    let fast = solved(&spec);
    assert!(
        fast.time_s <= 900.0 + 0.5 && fast.propagated.energies.bill_j <= real,
        "{}",
        fast.time_s
    );
}

#[test]
fn slews_arrive_while_a_speed_law_moves_wheels() {
    let (spacecraft, mut drives, mut start) = biros(true);
    for drive in &mut drives[3..] {
        // 500 times the published rate, towards another speed: a fifth of a wheel's momentum changes.
        drive.speed_law = Some(SpeedLawSpec {
            rate_per_s: 0.05,
            speed_rad_s: -100.0,
        });
    }
    start.body_rate_rad_s = Some([0.01, -0.02, 0.015]);
    let commands = [
        TorqueCommand::Free { intervals: 24 },
        TorqueCommand::Smooth { intervals: 30 },
        TorqueCommand::Sampled {
            period_s: 0.5,
            hold: SampleHold::Linear,
        },
    ];
    for command in commands {
        let outcome = solved(&SlewSpec {
            spacecraft: spacecraft.clone(),
            drives: drives.clone(),
            start: start.clone(),
            end: biros_end(),
            command,
            ..SlewSpec::default()
        });
        let end = outcome.propagated.states.last().expect("an end");
        let held = -100.0 - 100.0 * (-0.05 * outcome.time_s).exp();
        assert!((end.wheel_speed_rad_s[4] - held).abs() < 1e-9);
        assert!(outcome.propagated.attitude_error_rad < 1e-7);
    }
}

#[test]
fn friction_costs_time_where_the_motors_compensate_it() {
    let time = |compensated: Option<bool>| {
        let (spacecraft, _, start) = biros(false);
        let drive = DriveSpec {
            viscous_friction_nms: Some(2e-4),
            coulomb_friction_nm: Some(5e-3),
            friction_compensated: compensated,
            ..DriveSpec::default()
        };
        let drives = compensated.map_or(Vec::new(), |_| vec![drive; 3]);
        let outcome = solved(&SlewSpec {
            spacecraft,
            drives,
            start,
            end: biros_end(),
            command: TorqueCommand::Free { intervals: 40 },
            ..SlewSpec::default()
        });
        assert!(outcome.propagated.torque_excess < 1e-6);
        outcome.time_s
    };
    let (ideal, made_up, left) = (time(None), time(Some(true)), time(Some(false)));
    assert!((left - ideal).abs() < 1e-4, "{left} {ideal}");
    // The motor's torque is larger when the wheel speeds up, and smaller when it slows down.
    assert!(
        made_up > ideal * 1.0001 && made_up < ideal * 1.05,
        "{made_up} {ideal}"
    );
}

#[test]
fn keeping_the_null_space_momentum_of_the_start_costs_time() {
    let spec = |final_wheels| SlewSpec {
        spacecraft: pyramid(),
        start: StateSpec {
            // In the null space: the momenta sum to zero.
            wheel_speed_rad_s: Some(vec![157.0, -157.0, 157.0, -157.0]),
            ..StateSpec::default()
        },
        end: pyramid_end(),
        final_wheels,
        command: TorqueCommand::Free { intervals: 40 },
        ..SlewSpec::default()
    };
    let free = solved(&spec(FinalWheels::Free));
    let pinned = solved(&spec(FinalWheels::NullSpaceOfStart));
    let end = pinned.propagated.states.last().expect("an end");
    for (speed, start) in end
        .wheel_speed_rad_s
        .iter()
        .zip([157.0, -157.0, 157.0, -157.0])
    {
        assert!((speed - start).abs() < 1e-5, "{speed}");
    }
    // Published for half of the greatest null-space momentum: 41.19 s.
    assert!(
        pinned.time_s <= 41.2 && free.time_s < pinned.time_s - 0.5,
        "{} {}",
        free.time_s,
        pinned.time_s
    );
}

#[test]
fn a_disabled_wheel_gets_no_torque_and_the_slew_takes_longer() {
    let time = |failed: Option<usize>| {
        let mut spacecraft = olrac(5);
        if let Some(failed) = failed {
            spacecraft.wheels[failed].enabled = false;
        }
        let outcome = solved(&SlewSpec {
            spacecraft,
            end: turn(OLRAC_AXIS, 1.25),
            command: TorqueCommand::Free { intervals: 32 },
            ..SlewSpec::default()
        });
        let idle = failed.map_or(0.0, |i| {
            let torques = outcome
                .propagated
                .pieces
                .iter()
                .map(|p| p.torque_begin_nm[i].abs());
            torques.fold(0.0, f64::max)
        });
        assert!(idle == 0.0);
        outcome.time_s
    };
    assert!(time(Some(2)) > time(None) + 1.0);
}

#[test]
fn a_trade_curve_falls_and_each_point_starts_from_the_one_before() {
    let spec = minimum_energy(
        TorqueCommand::Uniform { intervals: 60 },
        EnergyMeasure::Proxy,
    );
    let slew = Slew::try_new(&spec).expect("valid").slew;
    let sweep = Sweep::Durations(vec![800.0, 850.0, 900.0, 1000.0, 1200.0]);
    let curve = trade_curve(&slew, &sweep, &StopSignal::new()).expect("a valid sweep");
    assert_eq!(curve.len(), 5);
    assert!(curve.iter().all(|outcome| outcome.solved));
    assert!(
        curve
            .windows(2)
            .all(|pair| pair[1].objective < pair[0].objective)
    );
    // From its neighbour a point takes one guess, and has the optimum that it has by itself.
    assert_eq!(curve[2].starts, 1);
    let alone = solved(&spec).objective;
    assert!((curve[2].objective / alone - 1.0).abs() < 1e-4);

    let wrong = trade_curve(
        &slew,
        &Sweep::Weights(vec![1.0, f64::NAN]),
        &StopSignal::new(),
    );
    let problems = wrong.expect_err("no weights to sweep");
    assert_eq!(problems.len(), 2, "{problems:?}");
}

#[test]
fn all_problems_of_a_description_are_found_at_once() {
    let mut spec = minimum_energy(TorqueCommand::Free { intervals: 1 }, EnergyMeasure::Bill);
    spec.spacecraft.inertia_kg_m2[0][0] = -1.0;
    spec.drives[2].motor = None;
    spec.objective = Objective::Energy {
        duration_s: f64::NAN,
        measure: EnergyMeasure::Bill,
    };
    spec.end.wheel_speed_rad_s = None;
    spec.options.torque_authority = 2.0;
    let problems = Slew::try_new(&spec).expect_err("nothing is right");
    let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
    for wanted in [
        "/spacecraft/inertia_kg_m2",
        "/options/torque_authority",
        "/objective/duration_s",
        "/command/intervals",
        "/drives/2/motor",
        "/end/wheel_speed_rad_s",
    ] {
        assert!(pointers.contains(&wanted), "{wanted} in {pointers:?}");
    }
}

#[test]
fn an_impossible_duration_is_not_solved_and_a_stop_is_reported() {
    let mut spec = minimum_energy(
        TorqueCommand::Uniform { intervals: 40 },
        EnergyMeasure::Proxy,
    );
    spec.objective = Objective::Energy {
        duration_s: 600.0,
        measure: EnergyMeasure::Proxy,
    };
    let slew = Slew::try_new(&spec).expect("valid").slew;
    let outcome = solve(&slew, &StopSignal::new());
    assert!(!outcome.solved, "faster than the fastest");
    let stopped = StopSignal::new();
    stopped.cancel();
    assert_eq!(solve(&slew, &stopped).status, "cancelled");
}
