//! Ending a solve on the caller's request.

use super::status::NlpStatus;
use crate::run::stop::StopReason;
use std::ops::ControlFlow;

/// A chain, and the caller's function that says when its solve is to end.
pub(super) struct Interruptible<'a, C> {
    pub(super) chain: &'a C,
    pub(super) stop: &'a dyn Fn() -> Option<StopReason>,
}

impl<C> Interruptible<'_, C> {
    /// Breaks when the caller wants the solve to end.
    pub(super) fn check(&self) -> ControlFlow<NlpStatus> {
        match (self.stop)() {
            Some(reason) => ControlFlow::Break(NlpStatus::Interrupted(reason)),
            None => ControlFlow::Continue(()),
        }
    }
}
