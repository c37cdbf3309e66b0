//! A good schedule, and one thing wrong with it at a time.

use super::super::{ScheduleClaims, verify, verify_with_claims};
use super::build::{HALF, TORQUE, angle, control, passage, scenario, target, valid};
use crate::model::plan::{Flight, Wait};
use crate::model::spec::{ScenarioSpec, WindowSpec};

/// Times of the schedule, s: the slew to "a" ends, the visit of "a" begins and ends, its second wait ends,
/// the slew to "b" ends.
const REACHED: f64 = 2.0 * HALF;
const ARRIVAL: f64 = REACHED + 5.0;
const DEPARTURE: f64 = ARRIVAL + 10.0;
const LEFT: f64 = DEPARTURE + 3.0;
const END: f64 = LEFT + 2.0 * HALF;

/// "a" is required and "b" and "c" are worth something; "c" is left out.
fn spec() -> ScenarioSpec {
    let mut spec = scenario(vec![
        target("a", angle(HALF)),
        target("b", 2.0 * angle(HALF)),
        target("c", 0.1),
    ]);
    let window = |from_s, to_s| WindowSpec {
        from_s: Some(from_s),
        to_s: Some(to_s),
        ..WindowSpec::default()
    };
    spec.targets[0].dwell_s = DEPARTURE - ARRIVAL;
    spec.targets[0].windows = Some(vec![window(500.0, 600.0), window(ARRIVAL, DEPARTURE)]);
    spec.targets[1].windows = Some(vec![window(END, END + 1.0)]);
    spec.targets[1].value = Some(2.0);
    spec.targets[2].value = Some(0.5);
    spec.latest_end_s = Some(END);
    spec
}

fn flight() -> Flight {
    Flight {
        total_time_s: END,
        passages: vec![passage("a", ARRIVAL, DEPARTURE), passage("b", END, END)],
        controls: vec![
            control(0.0, HALF, -TORQUE),
            control(HALF, HALF, TORQUE),
            control(REACHED, LEFT - REACHED, 0.0),
            control(LEFT, HALF, -TORQUE),
            control(LEFT + HALF, HALF, TORQUE),
        ],
    }
}

fn wait(target: &str, from_s: f64, to_s: f64) -> Wait {
    Wait {
        target: target.to_owned(),
        from_s,
        to_s,
    }
}

fn claims() -> ScheduleClaims {
    ScheduleClaims {
        value: Some(2.0),
        skipped: Some(vec!["c".to_owned()]),
        waits: vec![wait("a", REACHED, ARRIVAL), wait("a", DEPARTURE, LEFT)],
    }
}

fn failures(spec: &ScenarioSpec, flight: &Flight, claims: &ScheduleClaims) -> Vec<String> {
    let verification = verify_with_claims(&valid(spec), flight, claims).verification;
    assert_eq!(verification.passed, verification.failures.is_empty());
    verification.failures
}

/// Asserts that the only failures are these many, the first of which contains the words.
fn expect(found: &[String], count: usize, words: &str) {
    assert_eq!(found.len(), count, "{found:#?}");
    assert!(found[0].contains(words), "no \"{words}\" in {found:#?}");
}

fn damaged_claims(damage: impl FnOnce(&mut ScheduleClaims)) -> Vec<String> {
    let mut claims = claims();
    damage(&mut claims);
    failures(&spec(), &flight(), &claims)
}

fn damaged_spec(damage: impl FnOnce(&mut ScenarioSpec)) -> Vec<String> {
    let mut spec = spec();
    damage(&mut spec);
    failures(&spec, &flight(), &claims())
}

#[test]
fn the_schedule_passes_with_and_without_claims() {
    assert_eq!(failures(&spec(), &flight(), &claims()), [""; 0]);
    let report = verify(&valid(&spec()), &flight());
    assert!(
        report.verification.passed && report.value == Some(2.0),
        "{report:?}"
    );
    let report = verify_with_claims(&valid(&spec()), &flight(), &claims());
    let has_state = |time: f64| report.states.iter().any(|s| (s.time_s - time).abs() < 1e-9);
    assert!(
        [REACHED, ARRIVAL, DEPARTURE, LEFT]
            .into_iter()
            .all(has_state)
    );
}

#[test]
fn a_visit_outside_its_windows_is_refused() {
    let narrowed = |from: f64, to: f64| {
        damaged_spec(|spec| {
            let window = &mut spec.targets[0].windows.as_mut().unwrap()[1];
            (window.from_s, window.to_s) = (Some(from), Some(to));
        })
    };
    let words = "target 'a' is visited from 25 s to 35 s, outside its windows";
    expect(&narrowed(ARRIVAL + 1e-3, DEPARTURE), 1, words);
    // The arrival alone inside is not enough.
    expect(&narrowed(ARRIVAL, DEPARTURE - 1e-3), 1, words);
    assert_eq!(narrowed(ARRIVAL + 1e-9, DEPARTURE), [""; 0]);
    let none = damaged_spec(|spec| spec.targets[0].windows = Some(Vec::new()));
    expect(&none, 1, "outside its windows: it has none");
}

#[test]
fn a_flight_that_ends_too_late_is_refused() {
    let late = damaged_spec(|spec| spec.latest_end_s = Some(END - 1e-3));
    expect(&late, 1, "after the latest end at");
}

#[test]
fn required_targets_are_visited() {
    let missing = damaged_spec(|spec| spec.targets[2].value = None);
    expect(&missing, 1, "target 'c' is not visited");
}

#[test]
fn values_are_summed_up() {
    let other = damaged_claims(|claims| claims.value = Some(2.5));
    expect(&other, 1, "claims a value of 2.5, its visits are worth 2");
    expect(&damaged_claims(|it| it.value = Some(f64::NAN)), 1, "claims");
    assert_eq!(damaged_claims(|it| it.value = Some(2.0 + 1e-12)), [""; 0]);
}

#[test]
fn targets_left_out_are_those_that_are_not_visited() {
    let both = damaged_claims(|it| it.skipped = Some(vec!["b".to_owned(), "c".to_owned()]));
    expect(&both, 1, "target 'b' is left out and visited");
    let untold = damaged_claims(|it| it.skipped = Some(Vec::new()));
    expect(&untold, 1, "target 'c' is neither visited nor left out");
    let unknown = damaged_claims(|it| it.skipped = Some(vec!["c".to_owned(), "d".to_owned()]));
    expect(&unknown, 1, "'d' is left out, but is no target");
}

#[test]
fn waits_are_rests_beside_the_visits_that_they_name() {
    let moved = |from: f64, to: f64| damaged_claims(|it| it.waits[0] = wait("a", from, to));
    expect(
        &moved(REACHED - 1.0, ARRIVAL),
        1,
        "a wheel is driven at 19 s",
    );
    expect(&moved(REACHED, ARRIVAL - 1.0), 1, "is not beside a visit");
    expect(
        &moved(REACHED, ARRIVAL + 1.0),
        1,
        "overlaps the visit of 'a'",
    );
    expect(&moved(ARRIVAL, REACHED), 1, "is no span of time");
    expect(&moved(f64::NAN, ARRIVAL), 1, "is no span of time");
    let elsewhere = damaged_claims(|it| it.waits[1].target = "b".to_owned());
    expect(&elsewhere, 1, "is not beside a visit");
    let at_start = damaged_claims(|it| it.waits[0].target = "start".to_owned());
    expect(&at_start, 1, "does not begin with the flight");
}

#[test]
fn a_wait_while_the_body_coasts_is_refused() {
    let mut flight = flight();
    // The wheel gives its torque for a moment only, and the body turns slowly afterwards.
    flight.controls[2].duration_s -= 1.0;
    flight
        .controls
        .insert(3, control(LEFT - 1.0, 1.0, -TORQUE * 1e-3));
    let mut claims = claims();
    claims.waits[1].to_s = LEFT - 1.0;
    claims.waits.push(wait("b", LEFT, LEFT + 1e-3));
    let found = failures(&spec(), &flight, &claims);
    assert!(
        found.iter().any(|it| it.contains("the wait at 'b'")),
        "{found:#?}"
    );
    // Without torque all along, but turning: from a start that turns.
    let mut spec = scenario(vec![target("a", 1e-3)]);
    spec.start.body_rate_rad_s = Some([1e-4, 0.0, 0.0]);
    spec.targets[0].zero_rate_axes = Some([false; 3]);
    let coasting = Flight {
        total_time_s: 10.0,
        passages: vec![passage("a", 10.0, 10.0)],
        controls: vec![control(0.0, 10.0, 0.0)],
    };
    assert_eq!(
        failures(&spec, &coasting, &ScheduleClaims::default()),
        [""; 0]
    );
    let claims = ScheduleClaims {
        waits: vec![wait("start", 0.0, 5.0)],
        ..ScheduleClaims::default()
    };
    let found = failures(&spec, &coasting, &claims);
    expect(&found, 1, "is no rest: the body turns at 0.0001 rad/s");
}

#[test]
fn a_flight_that_cannot_be_propagated_is_told_its_times_too() {
    let mut flight = flight();
    flight.controls[0].start_s = f64::NAN;
    let mut spec = spec();
    spec.latest_end_s = Some(1.0);
    let found = failures(&spec, &flight, &claims());
    assert!(
        found.iter().any(|it| it.contains("not finite")),
        "{found:?}"
    );
    assert!(
        found.iter().any(|it| it.contains("latest end")),
        "{found:?}"
    );
}
