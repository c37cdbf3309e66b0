//! Turns: how much of one sort of work is done at once.

use super::super::error::{ApiError, ErrorCode};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// The right to do work; the next one has it when this is dropped.
pub(super) type Turn = OwnedSemaphorePermit;

/// The turns of one sort of work.
pub(in crate::api) struct Turns {
    free: Arc<Semaphore>,
    patience: Duration,
    others: &'static str,
}

impl Turns {
    /// So many at once; who has waited so long is told what the others do.
    pub(super) fn new(at_once: usize, patience: Duration, others: &'static str) -> Self {
        Self {
            free: Arc::new(Semaphore::new(at_once)),
            patience,
            others,
        }
    }

    /// Waits for a turn, in the order of coming.
    pub(super) async fn take(&self) -> Result<Turn, ApiError> {
        let turn = Arc::clone(&self.free).acquire_owned();
        match tokio::time::timeout(self.patience, turn).await {
            Ok(Ok(turn)) => Ok(turn),
            // Nobody closes the semaphore.
            Ok(Err(_)) | Err(_) => Err(ApiError::new(ErrorCode::Busy, self.others)),
        }
    }

    /// How many may begin now.
    #[cfg(test)]
    pub(super) fn free(&self) -> usize {
        self.free.available_permits()
    }
}
