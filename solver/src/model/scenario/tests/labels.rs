//! Epoch, time system and reference frame.

use super::*;

#[test]
fn epochs_that_are_no_dates_with_a_time_are_refused() {
    expect_faults(&[
        (
            |s| s.epoch = Some("soon".to_owned()),
            Code::InvalidEpoch,
            "/epoch",
        ),
        (
            |s| s.epoch = Some("2026-05-05 12:00".to_owned()),
            Code::InvalidEpoch,
            "/epoch",
        ),
        (
            |s| s.epoch = Some("2026-02-29T12:00:00Z".to_owned()),
            Code::InvalidEpoch,
            "/epoch",
        ),
    ]);
    let mut spec = valid();
    spec.epoch = Some("x".repeat(1000));
    let problems = Scenario::try_new(&spec).unwrap_err();
    assert!(problems[0].message.len() < 100, "{}", problems[0]);
    assert!(problems[0].hint.contains("2026-01-31T12:00:00.5Z"));
}

#[test]
fn a_frame_that_turns_is_a_warning() {
    for frame in ReferenceFrame::ALL {
        let mut spec = valid();
        spec.reference_frame = Some(*frame);
        let warnings = Scenario::try_new(&spec).unwrap().warnings;
        let codes: Vec<Code> = warnings.iter().map(|warning| warning.code).collect();
        let expected = if frame.turns() {
            vec![Code::RotatingFrame]
        } else {
            Vec::new()
        };
        assert_eq!(codes, expected, "{}", frame.name());
    }
    let turning = |name: &str| name.parse::<ReferenceFrame>().unwrap().turns();
    let inertial = [
        "EME2000",
        "GCRF",
        "ICRF",
        "TEME",
        "TOD",
        "ALIGN_EARTH",
        "CIRS",
    ];
    assert!(!inertial.into_iter().any(turning));
    let fixed = [
        "ITRF", "ITRF2014", "GTOD", "WGS84", "MOON_ME", "LVLH", "NTW",
    ];
    assert!(fixed.into_iter().all(turning));
}
