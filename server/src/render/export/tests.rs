//! Every format for one small flight: a turn about z, a rest, another turn.

mod messages;

use super::phases::{SegmentKind, phases};
use super::sampling::Sampling;
use super::trajectory::SampledFlight;
use super::{ExportError, ExportOptions, Format, Spacing, write};
use crate::documents;
use slewplan_solver::checker::PropagatedMotion;
use slewplan_solver::model::plan::{Control, Flight, Passage};
use slewplan_solver::model::scenario::Scenario;

const EFFECTIVE_Z: f64 = 6.0 - 0.002;
const TORQUE: f64 = 0.02;

/// A scenario with further members.
fn scenario(labels: &str) -> Scenario {
    let text = format!(
        r#"{{{labels}
        "spacecraft": {{"inertia_kg_m2": [[4, 0, 0], [0, 5, 0], [0, 0, 6]], "wheels": [
            {{"axis": [1, 0, 0], "inertia_kg_m2": 0.002, "max_torque_nm": 0.02}},
            {{"axis": [0, 1, 0], "inertia_kg_m2": 0.002, "max_torque_nm": 0.02}},
            {{"axis": [0, 0, 1], "inertia_kg_m2": 0.002, "max_torque_nm": 0.02}}]}},
        "start": {{"attitude": {{"roll_pitch_yaw_deg": [0, 0, 0]}}}},
        "targets": [{{"id": "a<1>", "attitude": {{"roll_pitch_yaw_deg": [0, 0, 5]}}, "dwell_s": 5}},
            {{"id": "b", "attitude": {{"roll_pitch_yaw_deg": [0, 0, 10]}}}}]}}"#
    );
    documents::scenario::read(text.as_bytes(), None)
        .unwrap()
        .scenario
}

fn labelled() -> Scenario {
    scenario(r#""name": "é & co", "epoch": "2026-01-31T23:59:50Z", "time_system": "UTC","#)
}

/// Acceleration and deceleration for five seconds each, five seconds of rest, and the same turn again.
fn flight() -> Flight {
    let control = |start_s: f64, torque: f64| Control {
        start_s,
        duration_s: 5.0,
        wheel_torque_nm: vec![0.0, 0.0, torque],
    };
    let passage = |target: &str, time_s: f64, departure_s: f64| Passage {
        target: target.to_owned(),
        time_s,
        departure_s,
    };
    // The torque on the body is the opposite of the motor's torque on the wheel.
    let turns = [
        (0.0, -TORQUE),
        (5.0, TORQUE),
        (10.0, 0.0),
        (15.0, -TORQUE),
        (20.0, TORQUE),
    ];
    Flight {
        total_time_s: 25.0,
        passages: vec![passage("a<1>", 10.0, 15.0), passage("b", 25.0, 25.0)],
        controls: turns.map(|(start, torque)| control(start, torque)).into(),
    }
}

/// Angle about z, rad, and its rate, rad/s.
fn closed_form(time_s: f64) -> (f64, f64) {
    let acceleration = TORQUE / EFFECTIVE_Z;
    let turn = |t: f64| {
        if t < 5.0 {
            (0.5 * acceleration * t * t, acceleration * t)
        } else {
            let left = 10.0 - t;
            (
                acceleration * (25.0 - 0.5 * left * left),
                acceleration * left,
            )
        }
    };
    let first = turn(time_s.min(10.0));
    let second = turn((time_s - 15.0).max(0.0));
    (first.0 + second.0, first.1 + second.1)
}

fn options() -> ExportOptions {
    ExportOptions {
        created_us: 1_767_225_600_000_000,
        ..ExportOptions::new(10_000)
    }
}

fn stepped(step_s: f64) -> ExportOptions {
    ExportOptions {
        spacing: Some(Spacing::Step(step_s)),
        ..options()
    }
}

fn written(format: Format, options: &ExportOptions) -> String {
    write(format, &labelled(), &flight(), options).unwrap()
}

fn with_trajectory(spacing: Spacing, look: impl Fn(&SampledFlight<'_>)) {
    let (scenario, flight) = (labelled(), flight());
    let motion = PropagatedMotion::of(&scenario, &flight).unwrap();
    let sampling = Sampling {
        spacing,
        most: 10_000,
    };
    look(&SampledFlight::of(&scenario, &flight, &motion, sampling).unwrap());
}

/// The flight with three seconds of rest before the visit and two after it.
fn waiting_flight() -> Flight {
    let mut flight = flight();
    flight.total_time_s = 30.0;
    flight.controls[2].duration_s = 10.0;
    flight.controls[3].start_s = 20.0;
    flight.controls[4].start_s = 25.0;
    (flight.passages[0].time_s, flight.passages[0].departure_s) = (13.0, 18.0);
    (flight.passages[1].time_s, flight.passages[1].departure_s) = (30.0, 30.0);
    flight
}

#[test]
fn waits_are_phases_where_there_is_a_clock() {
    let flight = waiting_flight();
    let (start, a, b) = ("start", "a<1>", "b");
    let with_clock = scenario(r#""latest_end_s": 100,"#);
    assert_eq!(
        phases(&with_clock, &flight),
        [
            (SegmentKind::Slew(start, a), 0.0, 10.0),
            (SegmentKind::Wait(a), 10.0, 13.0),
            (SegmentKind::Rest(a), 13.0, 18.0),
            (SegmentKind::Wait(a), 18.0, 20.0),
            (SegmentKind::Slew(a, b), 20.0, 30.0)
        ]
    );
    let without = phases(&labelled(), &flight);
    assert_eq!(without[0], (SegmentKind::Slew(start, a), 0.0, 13.0));
    let options = ExportOptions::new(10_000);
    let table = write(Format::Csv, &with_clock, &flight, &options).unwrap();
    let cells = |line: &str| {
        line.rsplit(',')
            .take(2)
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let mut found: Vec<_> = table.lines().map(cells).collect();
    found.dedup();
    let expected = [
        ["target", "phase"],
        [a, "slew"],
        [a, "wait"],
        [a, "visit"],
        [a, "wait"],
        [b, "slew"],
    ];
    assert_eq!(found, expected);
    let plain = write(Format::Csv, &labelled(), &flight, &options).unwrap();
    assert!(!plain.contains("phase"));
    let schedule = write(Format::OpenMct, &with_clock, &flight, &options).unwrap();
    assert_eq!(schedule.matches(r#""type": "Waits""#).count(), 2);
    let message = write(Format::AemKvn, &with_clock, &flight, &options).unwrap();
    assert_eq!(message.matches("Waiting at rest at a<1>").count(), 2);
}

#[test]
fn slews_and_rests_are_segments_with_the_switches_among_their_samples() {
    for spacing in [Spacing::Step(0.7), Spacing::Tolerance(1e-4)] {
        with_trajectory(spacing, |trajectory| {
            let kinds: Vec<_> = trajectory.segments.iter().map(|s| s.kind).collect();
            let (start, a, b) = ("start", "a<1>", "b");
            assert_eq!(
                kinds,
                [
                    SegmentKind::Slew(start, a),
                    SegmentKind::Rest(a),
                    SegmentKind::Slew(a, b)
                ]
            );
            let times = |index: usize| {
                let samples = trajectory.segments[index].samples.iter();
                samples
                    .map(|sample| sample.state.time_s)
                    .collect::<Vec<_>>()
            };
            for (index, exact) in [
                (0, [0.0, 5.0, 10.0]),
                (1, [10.0, 10.0, 15.0]),
                (2, [15.0, 20.0, 25.0]),
            ] {
                let times = times(index);
                assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
                assert!(exact.iter().all(|time| times.contains(time)), "{times:?}");
                assert_eq!((times.first(), times.last()), (exact.first(), exact.last()));
            }
            let torques: Vec<_> = trajectory.samples().map(|s| s.torque[2]).collect();
            assert!(torques.contains(&0.0) && torques.contains(&TORQUE));
        });
    }
}

#[test]
fn samples_keep_the_tolerance_of_interpolation() {
    for tolerance in [1e-3, 1e-5, 1e-7] {
        with_trajectory(Spacing::Tolerance(tolerance), |trajectory| {
            let (mut worst, mut count) = (0.0_f64, 0);
            for segment in &trajectory.segments {
                for pair in segment.samples.windows(2) {
                    let angle = |index: usize| {
                        let [_, _, z, w] = pair[index].state.attitude.xyzw();
                        2.0 * z.atan2(w)
                    };
                    let (begin, end) = (pair[0].state.time_s, pair[1].state.time_s);
                    assert!((angle(0) - closed_form(begin).0).abs() < 1e-13);
                    assert!((pair[0].state.body_rate_rad_s.z - closed_form(begin).1).abs() < 1e-15);
                    for share in [0.1, 0.37, 0.5, 0.8] {
                        let found = angle(0) + (angle(1) - angle(0)) * share;
                        let truth = closed_form(begin + (end - begin) * share).0;
                        worst = worst.max((found - truth).abs());
                    }
                    count += 1;
                }
            }
            assert!(worst <= tolerance, "{worst:e} for {tolerance:e}");
            // An arc of acceleration c needs a gap of sqrt(8 tolerance / c).
            let needed = 20.0 / (8.0 * tolerance * EFFECTIVE_Z / TORQUE).sqrt();
            assert!(
                f64::from(count) < 1.3 * needed + 5.0,
                "{count} for {needed}"
            );
        });
    }
}

#[test]
fn csv_has_samples_at_multiples_of_the_step() {
    let table = written(Format::Csv, &stepped(2.0));
    let times: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').next().unwrap().parse().unwrap())
        .collect();
    let expected = [0, 2, 4, 5, 6, 8, 10, 12, 14, 15, 16, 18, 20, 22, 24, 25];
    assert_eq!(times, expected.map(f64::from));
    let columns: Vec<usize> = table.lines().map(|row| row.split(',').count()).collect();
    assert_eq!(columns, [14; 17]);
    let head = table.lines().next().unwrap();
    assert!(head.starts_with("time_s,q_x,q_y,q_z,q_w,body_rate_x_rad_s"));
    assert!(
        head.ends_with("wheel_2_speed_rad_s,wheel_0_torque_nm,wheel_1_torque_nm,wheel_2_torque_nm")
    );
    // A boundary has the torque of the interval that begins there, the last row that of the last
    // interval.
    let torque = |row: usize| {
        table
            .lines()
            .nth(row + 1)
            .unwrap()
            .rsplit(',')
            .next()
            .unwrap()
    };
    assert_eq!(
        [torque(2), torque(3), torque(6), torque(15)],
        ["-0.02", "0.02", "0.0", "0.02"]
    );
}

#[test]
fn waypoints_have_time_attitude_rate_and_acceleration() {
    let text = written(Format::Basilisk, &stepped(5.0));
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 6);
    let (angle, rate) = closed_form(5.0);
    let peak = &rows[1];
    let expected = [
        5.0,
        0.0,
        0.0,
        (0.5 * angle).sin(),
        (0.5 * angle).cos(),
        0.0,
        0.0,
        rate,
    ];
    for (found, expected) in peak.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-14, "{peak:?}");
    }
    // After the switch the turn decelerates.
    assert!((peak[10] + TORQUE / EFFECTIVE_Z).abs() < 1e-14);
}

#[test]
fn an_stk_file_has_the_number_of_points_and_rates_in_degrees() {
    let text = written(Format::Stk, &stepped(5.0));
    let lines: Vec<&str> = text.lines().collect();
    let head = [
        "stk.v.8.0",
        "BEGIN Attitude",
        "NumberOfAttitudePoints 6",
        "ScenarioEpoch 31 Jan 2026 23:59:50.000000000",
        "BlockingFactor 20",
        "InterpolationOrder 1",
        "CentralBody Earth",
        "CoordinateAxes J2000",
        "AttitudeTimeQuatAngVels",
    ];
    assert_eq!(lines[..9], head);
    assert_eq!((lines.len(), lines[15]), (16, "END Attitude"));
    let row: Vec<f64> = lines[10]
        .split(' ')
        .map(|cell| cell.parse().unwrap())
        .collect();
    assert!((row[7] - closed_form(5.0).1.to_degrees()).abs() < 1e-13);
    let alone = ExportOptions {
        rates: false,
        ..stepped(5.0)
    };
    let text = written(Format::Stk, &alone);
    assert_eq!(text.lines().nth(8), Some("AttitudeTimeQuaternions"));
    assert_eq!(
        text.lines().nth(9).map(|row| row.split(' ').count()),
        Some(5)
    );
}

#[test]
fn wheel_commands_are_numbered_and_in_revolutions_per_minute() {
    let text = written(Format::WheelRpm, &stepped(10.0));
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|row| row.split('\t').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    // The last command is due after the end and has the speed at the end.
    assert_eq!(
        rows.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [0.0, 1.0, 2.0, 3.0]
    );
    // Halfway through the second turn the wheel has lost the momentum of the body.
    let speed = -closed_form(20.0).1 * 6.0 / 0.002;
    assert!(
        (rows[2][3] - speed * 30.0 / std::f64::consts::PI).abs() < 1e-5,
        "{rows:?}"
    );
    let one = ExportOptions {
        wheel: Some(2),
        ..stepped(10.0)
    };
    let alone = written(Format::WheelRpm, &one);
    assert_eq!(
        alone.lines().nth(2),
        Some(format!("2\t{:.6}", rows[2][3]).as_str())
    );
    assert_eq!(written(Format::WheelRpm, &options()).lines().count(), 251);
}

#[test]
fn a_schedule_has_slews_and_targets_in_milliseconds() {
    let plan: serde_json::Value =
        serde_json::from_str(&written(Format::OpenMct, &options())).unwrap();
    let begin = 1_769_903_990_000_i64; // date -u -d 2026-01-31T23:59:50 +%s000
    let slew = &plan["Slews"][1];
    assert_eq!(slew["name"], "a<1> \u{2192} b");
    assert_eq!(
        (&slew["start"], &slew["end"]),
        (&(begin + 15_000).into(), &(begin + 25_000).into())
    );
    let target = &plan["Targets"][0];
    assert_eq!(
        (&target["start"], &target["end"]),
        (&(begin + 10_000).into(), &(begin + 15_000).into())
    );
    for group in ["Slews", "Targets"] {
        assert_eq!(plan[group].as_array().map(Vec::len), Some(2));
        assert_eq!(plan[group][0]["type"], group);
    }
}

#[test]
fn options_that_a_format_does_not_have_are_refused() {
    let wheel = ExportOptions {
        wheel: Some(0),
        ..options()
    };
    let beyond = ExportOptions {
        wheel: Some(3),
        ..options()
    };
    let bare = ExportOptions {
        rates: false,
        ..options()
    };
    let named = ExportOptions {
        object_id: Some("2026-001A".into()),
        ..options()
    };
    let tolerance = ExportOptions {
        spacing: Some(Spacing::Tolerance(1e-3)),
        ..options()
    };
    let few = ExportOptions {
        most_samples: 20,
        ..stepped(1.0)
    };
    let tight = ExportOptions {
        most_samples: 20,
        ..options()
    };
    let cases = [
        (Format::Csv, wheel),
        (Format::WheelRpm, beyond),
        (Format::Basilisk, bare),
        (Format::Stk, named),
        (Format::OpenMct, stepped(1.0)),
        (Format::WheelRpm, tolerance),
        (Format::Csv, few.clone()),
        (Format::AemXml, tight),
        (Format::WheelRpm, few),
    ];
    for (format, options) in cases {
        let refused = write(format, &labelled(), &flight(), &options);
        assert!(
            matches!(refused, Err(ExportError::Choice(_))),
            "{format:?} {options:?}"
        );
    }
}

#[test]
fn labels_that_a_format_cannot_represent_are_refused_with_their_pointer() {
    let cases = [
        (
            Format::AemKvn,
            r#""epoch": "9999-12-31T23:59:59.5","#,
            "/epoch",
        ),
        (Format::Stk, r#""time_system": "TAI","#, "/time_system"),
        (Format::OpenMct, r#""time_system": "TAI","#, "/time_system"),
        (
            Format::Stk,
            r#""reference_frame": "LVLH","#,
            "/reference_frame",
        ),
    ];
    for (format, labels, place) in cases {
        let refused = write(format, &scenario(labels), &flight(), &options());
        let Err(ExportError::Label { pointer, .. }) = refused else {
            panic!("{format:?}: {refused:?}");
        };
        assert_eq!(pointer, place);
    }
}

#[test]
fn a_flight_with_a_gap_is_refused() {
    let mut broken = flight();
    broken.controls.remove(1);
    let refused = write(Format::Csv, &labelled(), &broken, &options());
    assert!(matches!(refused, Err(ExportError::NotFlown(_))));
}
