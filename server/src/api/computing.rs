//! Runs the computations of requests on other threads than those that serve them: in turn, with a
//! time limit, and stopped when the client disconnects.

use super::App;
use super::error::{ApiError, ErrorCode};
use slewplan_solver::run::stop::StopSignal;
use std::time::Duration;
use tokio::task::{JoinError, JoinHandle, spawn_blocking};

mod turns;

pub(super) use turns::{Turns, WorkTurn};

/// Longest time that a request may wait for its turn, and longest that it may compute, s.
pub(super) const MAX_S: u64 = 60;
pub(super) const LONGEST: Duration = Duration::from_secs(MAX_S);
/// No time limit, for work without partial results.
pub(super) const UNTIL_DONE: Duration = Duration::MAX;
/// Number of flights integrated at once, beside the threads of the solver.
const FLIGHTS: usize = 2;
/// Number of tables of leg times written at once: fewer than the database has readers, because each
/// may keep one while its client reads.
const TABLES: usize = 2;
/// Longest wait for a turn to integrate a flight, or to write a table.
const INTEGRATION_WAIT: Duration = Duration::from_secs(10);

/// Turns for computations on the solver's threads, one at a time.
pub(super) fn solving() -> Turns {
    Turns::new(1, LONGEST, "other requests are being computed")
}

/// Turns for verifications and exports, which integrate flights.
pub(super) fn integrating() -> Turns {
    Turns::new(
        FLIGHTS,
        INTEGRATION_WAIT,
        "other flights are being integrated",
    )
}

/// Turns for tables of leg times that are written as their clients read them.
pub(super) fn tabulating() -> Turns {
    Turns::new(TABLES, INTEGRATION_WAIT, "other tables are being written")
}

/// Waits for a turn, then does the work; its stop signal is set when the time is up.
pub(super) async fn in_turn<T: Send + 'static>(
    app: &App,
    longest: Duration,
    work: impl FnOnce(&StopSignal) -> T + Send + 'static,
) -> Result<T, ApiError> {
    let turn = app.0.solving.take().await?;
    watched(app, Some(turn), StopSignal::new(), longest, work).await
}

/// Waits for a turn to integrate a flight, then integrates it to the end without a time limit.
pub(super) async fn integrated<T: Send + 'static>(
    turns: &Turns,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, ApiError> {
    let turn = turns.take().await?;
    started(Some(turn), work)
        .await
        .map_err(|error| failed(&error))
}

async fn watched<T: Send + 'static>(
    app: &App,
    turn: Option<WorkTurn>,
    stop: StopSignal,
    longest: Duration,
    work: impl FnOnce(&StopSignal) -> T + Send + 'static,
) -> Result<T, ApiError> {
    let _guard = StopOnDrop(stop.clone());
    let signal = stop.clone();
    let mut work = started(turn, move || work(&signal));
    let mut shutdown = app.shutdown().clone();
    let finished = tokio::select! {
        finished = &mut work => finished,
        () = tokio::time::sleep(longest) => { stop.request(); work.await }
        () = shutdown.begun() => { stop.cancel(); work.await }
    };
    finished.map_err(|error| failed(&error))
}

/// Starts the work. The turn ends with the work and not with the request, because the work may
/// continue after its client has disconnected.
fn started<T: Send + 'static>(
    turn: Option<WorkTurn>,
    work: impl FnOnce() -> T + Send + 'static,
) -> JoinHandle<T> {
    spawn_blocking(move || {
        let _turn = turn;
        work()
    })
}

fn failed(error: &JoinError) -> ApiError {
    tracing::error!(%error, "the work of a request failed");
    ApiError::new(ErrorCode::Internal, "the answer could not be computed")
}

/// Stops the work when the request is dropped.
struct StopOnDrop(StopSignal);

impl Drop for StopOnDrop {
    fn drop(&mut self) {
        self.0.cancel();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, mpsc};
    use tokio::sync::oneshot;

    #[tokio::test]
    async fn a_turn_ends_with_the_work_and_not_with_the_request() {
        let turns = Arc::new(Turns::new(1, LONGEST, "busy"));
        let (has_begun, begun) = oneshot::channel();
        let (end, ending) = mpsc::channel::<()>();
        let request = tokio::spawn({
            let turns = Arc::clone(&turns);
            let work = move || {
                has_begun.send(()).unwrap();
                ending.recv().unwrap();
            };
            async move { integrated(&turns, work).await }
        });
        begun.await.unwrap();
        request.abort();
        assert!(request.await.unwrap_err().is_cancelled());
        assert_eq!(turns.free(), 0);
        end.send(()).unwrap();
        assert!(turns.take().await.is_ok());
    }

    #[tokio::test]
    async fn a_panic_of_the_work_ends_its_turn() {
        let turns = Turns::new(1, LONGEST, "busy");
        let failing = || -> u8 { panic!("on purpose") };
        assert!(integrated(&turns, failing).await.is_err());
        assert_eq!(turns.free(), 1);
    }

    #[tokio::test(start_paused = true)]
    async fn waiting_too_long_for_a_turn_is_answered_with_busy() {
        let turns = Turns::new(1, LONGEST, "busy");
        let turn = turns.take().await.unwrap();
        assert!(turns.take().await.is_err());
        drop(turn);
        assert!(turns.take().await.is_ok());
    }
}
