//! Work of a request on the solver's threads: in turn, within a time, and only while somebody waits.

use super::App;
use super::error::{ApiError, ErrorCode};
use slewplan_solver::stop::StopSignal;
use std::time::Duration;

/// Longest time that a request may wait for its turn, and compute, s.
pub(super) const LONGEST_S: u64 = 60;
pub(super) const LONGEST: Duration = Duration::from_secs(LONGEST_S);
/// For work of which half is worth nothing.
pub(super) const UNTIL_DONE: Duration = Duration::MAX;
const RETRY_S: u32 = 5;

/// Waits for its turn, then does the work; the signal is given when the time is up.
pub(super) async fn in_turn<T: Send + 'static>(
    app: &App,
    longest: Duration,
    work: impl FnOnce(&StopSignal) -> T + Send + 'static,
) -> Result<T, ApiError> {
    let turn = tokio::time::timeout(LONGEST, app.0.computing.acquire()).await;
    let Ok(Ok(_permit)) = turn else {
        let error = ApiError::new(ErrorCode::Busy, "other requests are being computed");
        return Err(error.retry_after(RETRY_S));
    };
    at_once(app, (StopSignal::new(), longest), work).await
}

/// Does the work now, with a signal that may have been given already.
pub(super) async fn at_once<T: Send + 'static>(
    app: &App,
    (stop, longest): (StopSignal, Duration),
    work: impl FnOnce(&StopSignal) -> T + Send + 'static,
) -> Result<T, ApiError> {
    let _guard = StopOnDrop(stop.clone());
    let signal = stop.clone();
    let mut work = tokio::task::spawn_blocking(move || work(&signal));
    let mut shutdown = app.shutdown().clone();
    let finished = tokio::select! {
        finished = &mut work => finished,
        () = tokio::time::sleep(longest) => { stop.request(); work.await }
        () = shutdown.begun() => { stop.cancel(); work.await }
    };
    finished.map_err(|error| {
        tracing::error!(%error, "the work of a request failed");
        ApiError::new(ErrorCode::Internal, "the answer could not be computed")
    })
}

/// Stops the work when nobody waits for it any more.
struct StopOnDrop(StopSignal);

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.cancel();
    }
}
