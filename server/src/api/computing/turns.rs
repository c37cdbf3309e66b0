//! Turns: a limit on concurrent work of one kind.

use super::super::error::{ApiError, ErrorCode};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// The permission to do work; passes to the next request when it is dropped.
pub(in crate::api) type WorkTurn = OwnedSemaphorePermit;

/// The turns of one kind of work.
pub(in crate::api) struct Turns {
    free: Arc<Semaphore>,
    longest_wait: Duration,
    refusal: &'static str,
}

impl Turns {
    /// Turns for `at_once` pieces of work; requests that have waited too long are refused with a
    /// detail.
    pub(super) fn new(at_once: usize, longest_wait: Duration, refusal: &'static str) -> Self {
        Self {
            free: Arc::new(Semaphore::new(at_once)),
            longest_wait,
            refusal,
        }
    }

    /// Waits for a turn; requests get them in the order of their arrival.
    pub(in crate::api) async fn take(&self) -> Result<WorkTurn, ApiError> {
        let turn = Arc::clone(&self.free).acquire_owned();
        match tokio::time::timeout(self.longest_wait, turn).await {
            Ok(Ok(turn)) => Ok(turn),
            // The semaphore is never closed.
            Ok(Err(_)) | Err(_) => Err(ApiError::new(ErrorCode::Busy, self.refusal)),
        }
    }

    /// Number of free turns.
    #[cfg(test)]
    pub(super) fn free(&self) -> usize {
        self.free.available_permits()
    }
}
