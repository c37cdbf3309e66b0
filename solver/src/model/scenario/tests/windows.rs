//! Windows, values and the latest end.

use super::*;
use crate::model::spec::WindowSpec;

fn seconds(from: f64, to: f64) -> WindowSpec {
    WindowSpec {
        from_s: Some(from),
        to_s: Some(to),
        ..WindowSpec::default()
    }
}

fn dates(from: &str, to: &str) -> WindowSpec {
    WindowSpec {
        from: Some(from.to_owned()),
        to: Some(to.to_owned()),
        ..WindowSpec::default()
    }
}

#[test]
fn windows_are_sorted_and_dates_count_from_the_epoch() {
    let mut spec = valid();
    spec.epoch = Some("2026-01-31T12:00:00Z".to_owned());
    spec.targets[0].windows = Some(vec![
        seconds(200.0, 300.0),
        dates("2026-01-31T12:00:10Z", "2026-01-31T12:01:00.5"),
    ]);
    let read = Scenario::try_new(&spec).unwrap();
    assert!(read.warnings.is_empty());
    let windows = read.scenario.targets()[0].windows.clone().unwrap();
    let ends: Vec<_> = windows
        .iter()
        .map(|window| [window.from, window.to])
        .collect();
    assert_eq!(ends, [[10.0, 60.5], [200.0, 300.0]]);
    assert!(read.scenario.has_clock());
    assert!(!Scenario::try_new(&valid()).unwrap().scenario.has_clock());
}

#[test]
fn windows_that_are_wrong_are_refused_where_they_stand() {
    let first =
        |windows: Vec<WindowSpec>| move |s: &mut ScenarioSpec| s.targets[0].windows = Some(windows);
    let refused = |change: &dyn Fn(&mut ScenarioSpec)| {
        let mut spec = valid();
        change(&mut spec);
        let problems = Scenario::try_new(&spec).unwrap_err();
        let found = problems.iter().map(|p| (p.code, p.pointer.clone()));
        found.collect::<Vec<_>>()
    };
    let at = |code, place: &str| vec![(code, format!("/targets/0/windows/{place}"))];
    let backward = refused(&|s| first(vec![seconds(5.0, 4.0)])(s));
    assert_eq!(backward, at(Code::EmptyRange, "0"));
    let overlapping = refused(&|s| first(vec![seconds(5.0, 9.0), seconds(1.0, 6.0)])(s));
    assert_eq!(overlapping, at(Code::WindowsOverlap, "1"));
    let infinite = refused(&|s| first(vec![seconds(f64::NAN, 9.0)])(s));
    assert_eq!(infinite, at(Code::NotFinite, "0/from_s"));
    let far = refused(&|s| first(vec![seconds(0.0, 1e300)])(s));
    assert_eq!(far, at(Code::OutOfRange, "0/to_s"));
    let undated = dates("2026-01-31T12:00:10Z", "2026-01-31T12:01:00Z");
    let undated = refused(&|s| first(vec![undated.clone()])(s));
    assert_eq!(
        undated,
        [
            (Code::EpochRequired, "/targets/0/windows/0/from".to_owned()),
            (Code::EpochRequired, "/targets/0/windows/0/to".to_owned()),
        ]
    );
    let twice = WindowSpec {
        from: Some("2026-01-31T12:00:10Z".to_owned()),
        ..seconds(1.0, 2.0)
    };
    let twice = refused(&|s| first(vec![twice.clone()])(s));
    assert_eq!(twice, at(Code::ConflictingFields, "0"));
    let open = refused(&|s| first(vec![WindowSpec::default()])(s));
    assert_eq!(open[0].0, Code::MissingField);
}

#[test]
fn values_and_the_latest_end_are_moderate_numbers_above_zero() {
    for wrong in [0.0, -1.0, 1e308] {
        let mut spec = valid();
        spec.targets[0].value = Some(wrong);
        spec.latest_end_s = Some(wrong);
        let problems = Scenario::try_new(&spec).unwrap_err();
        let found: Vec<_> = problems
            .iter()
            .map(|p| (p.code, p.pointer.as_str()))
            .collect();
        assert_eq!(
            found,
            [
                (Code::OutOfRange, "/latest_end_s"),
                (Code::OutOfRange, "/targets/0/value"),
            ]
        );
    }
    let mut spec = valid();
    spec.targets[0].value = Some(f64::NAN);
    let problems = Scenario::try_new(&spec).unwrap_err();
    assert_eq!(problems[0].code, Code::NotFinite);
}

#[test]
fn windows_in_which_no_visit_fits_are_warned_of() {
    let mut spec = valid();
    spec.latest_end_s = Some(100.0);
    spec.targets[0].dwell_s = 5.0;
    spec.targets[0].windows = Some(vec![
        seconds(-9.0, 4.0),
        seconds(10.0, 20.0),
        seconds(30.0, 34.0),
        seconds(96.0, 200.0),
    ]);
    let warnings = Scenario::try_new(&spec).unwrap().warnings;
    let found: Vec<_> = warnings
        .iter()
        .map(|w| (w.code, w.pointer.as_str()))
        .collect();
    let places = ["0", "2", "3"].map(|i| format!("/targets/0/windows/{i}"));
    assert_eq!(
        found,
        places
            .each_ref()
            .map(|place| (Code::WindowUnusable, place.as_str()))
    );
}

#[test]
fn positions_count_the_targets_that_are_visited() {
    let mut spec = valid();
    let count = spec.targets.len();
    spec.targets[0].position = Some(count);
    spec.targets[0].after.clear();
    let later = spec.targets[0].id.clone();
    spec.targets[1].after = vec![later];
    assert_eq!(
        Scenario::try_new(&spec).unwrap_err()[0].code,
        Code::OrderInfeasible
    );
    // Left out, the second target need not come after the last one.
    spec.targets[1].value = Some(1.0);
    assert!(Scenario::try_new(&spec).is_ok());
}
