//! Combinations of objectives, commands and drives that no source has, all of them flown.

use super::craft::{
    OLRAC_AXIS, biros, biros_end, lro, lro_drives, lro_end, olrac, pyramid, pyramid_end, solved,
    turn,
};
use crate::model::drive::{DriveSpec, MotorSpec, SpeedLawSpec};
use crate::model::spec::StateSpec;
use crate::run::stop::StopSignal;
use crate::slew::{
    Command, FinalWheels, Hold, Measure, Objective, Slew, SlewSpec, Sweep, solve, trade_curve,
};

fn thrifty(command: Command, measure: Measure) -> SlewSpec {
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
fn every_command_comes_to_about_the_same_energy() {
    let hold = |hold| Command::Sampled {
        period_s: 10.0,
        hold,
    };
    for measure in [Measure::Proxy, Measure::Bill] {
        let energies = [
            Command::Free { intervals: 60 },
            Command::Uniform { intervals: 90 },
            Command::Smooth { intervals: 60 },
            hold(Hold::Constant),
            hold(Hold::Linear),
        ]
        .map(|command| solved(&thrifty(command, measure)).objective);
        let least = energies.iter().copied().fold(f64::INFINITY, f64::min);
        for energy in energies {
            assert!(energy < 1.05 * least, "{measure:?} {energies:?}");
        }
    }
}

#[test]
fn losses_of_the_supply_are_billed() {
    let mut spec = thrifty(Command::Uniform { intervals: 60 }, Measure::Bill);
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
        measure: Measure::Bill,
    };
    let fast = solved(&spec);
    assert!(
        fast.time_s <= 900.0 + 0.5 && fast.flown.energies.bill_j <= real,
        "{}",
        fast.time_s
    );
}

#[test]
fn a_wheel_that_returns_to_its_speed_is_carried_along() {
    let (spacecraft, mut drives, mut start) = biros(true);
    for drive in &mut drives[3..] {
        // A thousandfold the published rate, from another speed: a fifth of a wheel's momentum moves.
        drive.speed_law = Some(SpeedLawSpec {
            rate_per_s: 0.05,
            speed_rad_s: -100.0,
        });
    }
    start.body_rate_rad_s = Some([0.01, -0.02, 0.015]);
    let commands = [
        Command::Free { intervals: 24 },
        Command::Smooth { intervals: 30 },
        Command::Sampled {
            period_s: 0.5,
            hold: Hold::Linear,
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
        let end = outcome.flown.states.last().expect("an end");
        let held = -100.0 - 100.0 * (-0.05 * outcome.time_s).exp();
        assert!((end.wheel_speed_rad_s[4] - held).abs() < 1e-9);
        assert!(outcome.flown.attitude_error_rad < 1e-7);
    }
}

#[test]
fn friction_costs_time_where_it_is_made_up_for() {
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
            command: Command::Free { intervals: 40 },
            ..SlewSpec::default()
        });
        assert!(outcome.flown.torque_excess < 1e-6);
        outcome.time_s
    };
    let (ideal, made_up, left) = (time(None), time(Some(true)), time(Some(false)));
    assert!((left - ideal).abs() < 1e-4, "{left} {ideal}");
    // Speeding up takes more of the motor, and slowing down less.
    assert!(
        made_up > ideal * 1.0001 && made_up < ideal * 1.05,
        "{made_up} {ideal}"
    );
}

#[test]
fn a_pinned_null_space_returns_and_costs_time() {
    let spec = |final_wheels| SlewSpec {
        spacecraft: pyramid(),
        start: StateSpec {
            // Along the null space: no momentum in sum.
            wheel_speed_rad_s: Some(vec![157.0, -157.0, 157.0, -157.0]),
            ..StateSpec::default()
        },
        end: pyramid_end(),
        final_wheels,
        command: Command::Free { intervals: 40 },
        ..SlewSpec::default()
    };
    let free = solved(&spec(FinalWheels::Free));
    let pinned = solved(&spec(FinalWheels::NullSpaceOfStart));
    let end = pinned.flown.states.last().expect("an end");
    for (speed, start) in end
        .wheel_speed_rad_s
        .iter()
        .zip([157.0, -157.0, 157.0, -157.0])
    {
        assert!((speed - start).abs() < 1e-5, "{speed}");
    }
    // Published for half of the maximum: 41.19 s.
    assert!(
        pinned.time_s <= 41.2 && free.time_s < pinned.time_s - 0.5,
        "{} {}",
        free.time_s,
        pinned.time_s
    );
}

#[test]
fn a_failed_wheel_is_done_without() {
    let time = |failed: Option<usize>| {
        let mut spacecraft = olrac(5);
        if let Some(failed) = failed {
            spacecraft.wheels[failed].enabled = false;
        }
        let outcome = solved(&SlewSpec {
            spacecraft,
            end: turn(OLRAC_AXIS, 1.25),
            command: Command::Free { intervals: 32 },
            ..SlewSpec::default()
        });
        let idle = failed.map_or(0.0, |i| {
            let torques = outcome
                .flown
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
fn a_trade_curve_falls_and_begins_where_it_is_asked_to() {
    let spec = thrifty(Command::Uniform { intervals: 60 }, Measure::Proxy);
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
    // From its neighbour, a point takes one start, and gets where its own starts lead.
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
fn all_problems_are_told_at_once() {
    let mut spec = thrifty(Command::Free { intervals: 1 }, Measure::Bill);
    spec.spacecraft.inertia_kg_m2[0][0] = -1.0;
    spec.drives[2].motor = None;
    spec.objective = Objective::Energy {
        duration_s: f64::NAN,
        measure: Measure::Bill,
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
fn what_cannot_be_done_is_told_and_a_stop_is_obeyed() {
    let mut spec = thrifty(Command::Uniform { intervals: 40 }, Measure::Proxy);
    spec.objective = Objective::Energy {
        duration_s: 600.0,
        measure: Measure::Proxy,
    };
    let slew = Slew::try_new(&spec).expect("valid").slew;
    let outcome = solve(&slew, &StopSignal::new());
    assert!(!outcome.solved, "faster than the fastest");
    let stopped = StopSignal::new();
    stopped.cancel();
    assert_eq!(solve(&slew, &stopped).status, "cancelled");
}
