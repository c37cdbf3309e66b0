//! The labels of exports: epoch and reference frame.

use crate::model::epoch;
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::ScenarioSpec;
use jiff::civil::DateTime;

/// The epoch, if there is one that is not refused.
pub(super) fn read_epoch(spec: &ScenarioSpec, findings: &mut Findings) -> Option<DateTime> {
    let text = spec.epoch.as_ref()?;
    let read = epoch::parse(text);
    if read.is_none() {
        let short: String = text.chars().take(40).collect();
        findings.refuse(
            "/epoch",
            Code::InvalidEpoch,
            format!("{short:?} is no calendar date with a time"),
            "write YYYY-MM-DDThh:mm:ss, with a fraction or Z at its end if you like, such as \
             2026-01-31T12:00:00.5Z; time zones and leap seconds are not known here",
        );
    }
    read
}

/// Warns of a frame in which the angular momentum would not be constant.
pub(super) fn check_frame(spec: &ScenarioSpec, findings: &mut Findings) {
    if let Some(frame) = spec.reference_frame.filter(|frame| frame.turns()) {
        findings.warn(
            "/reference_frame",
            Code::RotatingFrame,
            format!(
                "{} turns, but attitudes and rates are taken to be those in inertial axes",
                frame.name()
            ),
            "name the inertial frame in which the attitudes are given, such as EME2000 or GCRF",
        );
    }
}
