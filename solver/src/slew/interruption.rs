//! Why a stop signal interrupts a program.

use crate::nlp::Interruption;
use crate::run::stop::{StopReason, StopSignal};

/// The reason for which a solve has to end, if it has to.
pub(super) fn interruption(stop: &StopSignal) -> Option<Interruption> {
    stop.reason().map(|reason| match reason {
        StopReason::TimeLimit => Interruption::TimeLimit,
        StopReason::Requested | StopReason::Cancelled => Interruption::Cancelled,
    })
}
