//! Who is connected, and who leaves when it is full.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, timeout};

/// Time after which somebody is asked to leave again, if nobody did.
const ASK_AGAIN: Duration = Duration::from_millis(50);

/// All connections.
#[derive(Debug)]
pub(super) struct Roster {
    seats: Arc<Semaphore>,
    most: u32,
    taken: Arc<Mutex<Taken>>,
}

#[derive(Debug, Default)]
struct Taken {
    places: BTreeMap<u64, Place>,
    next: u64,
}

/// What a connection is doing.
#[derive(Debug, Clone)]
pub(super) struct Place {
    /// Since when a request is waited for; nothing while one is answered.
    waiting: Arc<Mutex<Option<Instant>>>,
    leave: Arc<Notify>,
}

impl Place {
    fn new() -> Self {
        Self {
            waiting: Arc::new(Mutex::new(Some(Instant::now()))),
            leave: Arc::default(),
        }
    }

    fn waiting(&self) -> MutexGuard<'_, Option<Instant>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A request is here to its last byte.
    pub(super) fn has_request(&self) {
        *self.waiting() = None;
    }

    /// Its answer has been given.
    pub(super) fn has_answer(&self) {
        *self.waiting() = Some(Instant::now());
    }
}

/// The right to be connected; given back with the value.
#[derive(Debug)]
pub(super) struct Seat {
    number: u64,
    place: Place,
    taken: Arc<Mutex<Taken>>,
    _permit: OwnedSemaphorePermit,
}

impl Roster {
    /// Room for so many.
    pub(super) fn new(most: usize) -> Self {
        Self {
            seats: Arc::new(Semaphore::new(most)),
            most: u32::try_from(most).unwrap_or(u32::MAX),
            taken: Arc::default(),
        }
    }

    /// A seat. When there is none, whoever keeps the service waiting longest is asked to leave; when
    /// all requests are being answered, this waits.
    pub(super) async fn seat(&self) -> Seat {
        let permit = loop {
            if self.seats.available_permits() == 0 {
                self.make_room();
            }
            let permit = Arc::clone(&self.seats).acquire_owned();
            // Asked again, because whoever was asked may have begun to work meanwhile.
            if let Ok(Ok(permit)) = timeout(ASK_AGAIN, permit).await {
                break permit;
            }
        };
        let place = Place::new();
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let number = taken.next;
        taken.next += 1;
        taken.places.insert(number, place.clone());
        Seat {
            number,
            place,
            taken: Arc::clone(&self.taken),
            _permit: permit,
        }
    }

    fn make_room(&self) {
        let taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let since = |place: &Place| *place.waiting();
        let longest = taken
            .places
            .values()
            .filter_map(|place| Some((since(place)?, place)))
            .min_by_key(|(since, _)| *since);
        if let Some((_, place)) = longest {
            place.leave.notify_one();
        }
    }

    /// Waits until nobody is connected.
    pub(super) async fn emptied(&self) {
        let all = self.seats.acquire_many(self.most).await;
        drop(all);
    }
}

impl Seat {
    /// Somebody has come, and is waited for from now on.
    pub(super) fn begin(&self) {
        self.place.has_answer();
    }

    /// What the connection is doing.
    pub(super) fn place(&self) -> Place {
        self.place.clone()
    }

    /// Waits until somebody needs the seat more.
    pub(super) async fn asked_to_leave(&self) {
        loop {
            self.place.leave.notified().await;
            if self.place.waiting().is_some() {
                return;
            }
        }
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        taken.places.remove(&self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn the_longest_waiting_leaves_and_the_answered_stay() {
        let connection_limit = Roster::new(3);
        let mut seats = Vec::new();
        for _ in 0..3 {
            seats.push(connection_limit.seat().await);
            tokio::time::advance(Duration::from_secs(1)).await;
        }
        // Whoever sits on the first came last: it has waited least.
        seats[0].begin();
        seats[1].place().has_request();
        let leaves = async {
            seats[2].asked_to_leave().await;
            seats.pop();
        };
        let (newcomer, ()) = tokio::join!(connection_limit.seat(), leaves);
        assert_eq!(newcomer.number, 3);
    }
}
