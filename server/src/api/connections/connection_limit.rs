//! The limit on connections, and the eviction of idle ones.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, timeout};

/// Time after which another connection is evicted, if none has closed.
const EVICTION_RETRY: Duration = Duration::from_millis(50);

/// Limits the number of connections.
#[derive(Debug)]
pub(super) struct ConnectionLimit {
    permits: Arc<Semaphore>,
    max: u32,
    open: Arc<Mutex<OpenConnections>>,
}

#[derive(Debug, Default)]
struct OpenConnections {
    states: BTreeMap<u64, ConnectionState>,
    next: u64,
}

/// Whether a connection waits for a request.
#[derive(Debug, Clone)]
pub(super) struct ConnectionState {
    /// Since when the connection has waited for a request; `None` while one is answered.
    waiting: Arc<Mutex<Option<Instant>>>,
    eviction: Arc<Notify>,
}

impl ConnectionState {
    fn new() -> Self {
        Self {
            waiting: Arc::new(Mutex::new(Some(Instant::now()))),
            eviction: Arc::default(),
        }
    }

    fn waiting(&self) -> MutexGuard<'_, Option<Instant>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A request has arrived completely.
    pub(super) fn has_request(&self) {
        *self.waiting() = None;
    }

    /// Its answer has been sent.
    pub(super) fn has_answer(&self) {
        *self.waiting() = Some(Instant::now());
    }
}

/// The permission to hold one connection; returned when it is dropped.
#[derive(Debug)]
pub(super) struct ConnectionPermit {
    number: u64,
    state: ConnectionState,
    open: Arc<Mutex<OpenConnections>>,
    _permit: OwnedSemaphorePermit,
}

impl ConnectionLimit {
    /// A limit of `max` connections.
    pub(super) fn new(max: usize) -> Self {
        Self {
            permits: Arc::new(Semaphore::new(max)),
            max: u32::try_from(max).unwrap_or(u32::MAX),
            open: Arc::default(),
        }
    }

    /// Takes a permit. When there is none, the connection that has waited longest for a request is
    /// evicted; when all are being answered, this waits.
    pub(super) async fn permit(&self) -> ConnectionPermit {
        let permit = loop {
            if self.permits.available_permits() == 0 {
                self.evict_longest_waiting();
            }
            let permit = Arc::clone(&self.permits).acquire_owned();
            // Evicts again, because the chosen connection may have received a request in the
            // meantime.
            if let Ok(Ok(permit)) = timeout(EVICTION_RETRY, permit).await {
                break permit;
            }
        };
        let state = ConnectionState::new();
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let number = open.next;
        open.next += 1;
        open.states.insert(number, state.clone());
        ConnectionPermit {
            number,
            state,
            open: Arc::clone(&self.open),
            _permit: permit,
        }
    }

    fn evict_longest_waiting(&self) {
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let since = |state: &ConnectionState| *state.waiting();
        let longest = open
            .states
            .values()
            .filter_map(|state| Some((since(state)?, state)))
            .min_by_key(|(since, _)| *since);
        if let Some((_, state)) = longest {
            state.eviction.notify_one();
        }
    }

    /// Waits until all connections are closed.
    pub(super) async fn emptied(&self) {
        let all = self.permits.acquire_many(self.max).await;
        drop(all);
    }
}

impl ConnectionPermit {
    /// The connection is established and waits for its first request.
    pub(super) fn begin(&self) {
        self.state.has_answer();
    }

    /// What the connection is doing.
    pub(super) fn state(&self) -> ConnectionState {
        self.state.clone()
    }

    /// Waits until the connection is evicted.
    pub(super) async fn evicted(&self) {
        loop {
            self.state.eviction.notified().await;
            if self.state.waiting().is_some() {
                return;
            }
        }
    }
}

impl Drop for ConnectionPermit {
    fn drop(&mut self) {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.states.remove(&self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn the_longest_waiting_connection_is_evicted() {
        let connection_limit = ConnectionLimit::new(3);
        let mut permits = Vec::new();
        for _ in 0..3 {
            permits.push(connection_limit.permit().await);
            tokio::time::advance(Duration::from_secs(1)).await;
        }
        // The first connection begins again, so that it has waited least.
        permits[0].begin();
        permits[1].state().has_request();
        let leaves = async {
            permits[2].evicted().await;
            permits.pop();
        };
        let (newcomer, ()) = tokio::join!(connection_limit.permit(), leaves);
        assert_eq!(newcomer.number, 3);
    }
}
