//! Work of a request away from the threads that serve requests: in turn, and, where it can be
//! stopped, within a time and only while somebody waits.

use super::App;
use super::error::{ApiError, ErrorCode};
use slewplan_solver::run::stop::StopSignal;
use std::time::Duration;
use tokio::task::{JoinError, JoinHandle, spawn_blocking};

mod turns;

use turns::Turn;
pub(super) use turns::Turns;

/// Longest time that a request may wait for its turn, and compute, s.
pub(super) const MAX_S: u64 = 60;
pub(super) const LONGEST: Duration = Duration::from_secs(MAX_S);
/// For work of which half is worth nothing.
pub(super) const UNTIL_DONE: Duration = Duration::MAX;
/// Flights that are integrated at once: there are not more cores to spare beside the solver.
const FLIGHTS: usize = 2;
/// Longest wait for a turn to integrate a flight.
const PATIENCE: Duration = Duration::from_secs(10);

/// Turns for what is computed on the solver's threads: one after another.
pub(super) fn solving() -> Turns {
    Turns::new(1, LONGEST, "other requests are being computed")
}

/// Turns for verifications and samples of flights.
pub(super) fn flying() -> Turns {
    Turns::new(FLIGHTS, PATIENCE, "other flights are being integrated")
}

/// Waits for its turn, then does the work; the signal is given when the time is up.
pub(super) async fn in_turn<T: Send + 'static>(
    app: &App,
    longest: Duration,
    work: impl FnOnce(&StopSignal) -> T + Send + 'static,
) -> Result<T, ApiError> {
    let turn = app.0.solving.take().await?;
    watched(app, Some(turn), (StopSignal::new(), longest), work).await
}

/// Does the work now, with a signal that may have been given already.
pub(super) async fn at_once<T: Send + 'static>(
    app: &App,
    limits: (StopSignal, Duration),
    work: impl FnOnce(&StopSignal) -> T + Send + 'static,
) -> Result<T, ApiError> {
    watched(app, None, limits, work).await
}

/// Waits for a turn to integrate a flight, then does it to the end: no signal can stop it.
pub(super) async fn flown<T: Send + 'static>(
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
    turn: Option<Turn>,
    (stop, longest): (StopSignal, Duration),
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

/// Starts the work. A turn ends with the work, not with the request, which ends early when its
/// caller hangs up: what goes on for nobody takes as much of the machine.
fn started<T: Send + 'static>(
    turn: Option<Turn>,
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

/// Stops the work when nobody waits for it any more.
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
    async fn a_turn_ends_with_the_work_and_not_with_who_waits_for_it() {
        let turns = Arc::new(Turns::new(1, LONGEST, "busy"));
        let (has_begun, begun) = oneshot::channel();
        let (end, ending) = mpsc::channel::<()>();
        let request = tokio::spawn({
            let turns = Arc::clone(&turns);
            let work = move || {
                has_begun.send(()).unwrap();
                ending.recv().unwrap();
            };
            async move { flown(&turns, work).await }
        });
        begun.await.unwrap();
        request.abort();
        assert!(request.await.unwrap_err().is_cancelled());
        assert_eq!(turns.free(), 0);
        end.send(()).unwrap();
        assert!(turns.take().await.is_ok());
    }

    #[tokio::test]
    async fn work_that_panics_gives_its_turn_back() {
        let turns = Turns::new(1, LONGEST, "busy");
        let failing = || -> u8 { panic!("on purpose") };
        assert!(flown(&turns, failing).await.is_err());
        assert_eq!(turns.free(), 1);
    }

    #[tokio::test(start_paused = true)]
    async fn who_waits_too_long_for_a_turn_is_told_to_come_again() {
        let turns = Turns::new(1, LONGEST, "busy");
        let turn = turns.take().await.unwrap();
        assert!(turns.take().await.is_err());
        drop(turn);
        assert!(turns.take().await.is_ok());
    }
}
