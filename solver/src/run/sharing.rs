//! Threads shared by several solves: a fixed number of slots, without one of which nobody computes.
//!
//! Every solve has workers of its own ([`SolverPool`](super::pool::SolverPool)), as many as there are
//! slots. A worker takes a slot for each piece of its work. When another solve waits for one, it gives
//! it back in the middle of the piece, where it asks whether to stop. So a solve of seconds ends beside
//! one of hours whose pieces are long, and the workers that compute are never more than the slots.
//!
//! A slot goes to the waiting solve that has computed least. Who had nothing to compute gets no credit
//! for it, and nobody waits for what it has computed long ago, when the slots were free.

use std::cell::RefCell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time for which a slot is kept although others wait: short against what a person notices, long
/// against the exchange of the workers and their caches.
const QUANTUM: Duration = Duration::from_millis(10);
/// How much more a solve that begins to compute may have computed than the others.
const MAX_DEBT: Duration = Duration::from_millis(100);
/// Longest wait of a worker that has given its slot back. After it the worker goes on without one: it
/// might hold what the owners of all slots are waiting for.
const MAX_PAUSE: Duration = Duration::from_secs(1);

thread_local! {
    /// The slot with which this thread computes.
    static HELD: RefCell<Option<Held>> = const { RefCell::new(None) };
}

/// The slots of several solves.
#[derive(Debug)]
struct Slots {
    state: Mutex<State>,
    changed: Condvar,
    /// Number of workers that wait, read without the lock.
    waiting: AtomicUsize,
}

#[derive(Debug)]
struct State {
    /// Free slots, below zero while workers go on without one.
    free: isize,
    solves: Vec<Usage>,
}

/// What one solve has of the slots.
#[derive(Debug, Default, Clone)]
struct Usage {
    holding: usize,
    waiting: usize,
    /// Time in slots, counted from that of the others where this one had nothing to compute.
    used: Duration,
}

impl Usage {
    fn is_active(&self) -> bool {
        self.holding + self.waiting > 0
    }
}

impl State {
    /// The solve that gets the next slot.
    fn next(&self) -> Option<usize> {
        let waiting = self.solves.iter().enumerate();
        let waiting = waiting.filter(|(_, usage)| usage.waiting > 0);
        waiting
            .min_by_key(|(_, usage)| usage.used)
            .map(|(at, _)| at)
    }

    /// Begins to wait for a slot.
    fn wait(&mut self, solve: usize) {
        if !self.solves[solve].is_active() {
            let active = self.solves.iter().filter(|usage| usage.is_active());
            if let Some(least) = active.map(|usage| usage.used).min() {
                let used = &mut self.solves[solve].used;
                *used = (*used).clamp(least, least + MAX_DEBT);
            }
        }
        self.solves[solve].waiting += 1;
    }

    fn take(&mut self, solve: usize) {
        self.free -= 1;
        self.solves[solve].waiting -= 1;
        self.solves[solve].holding += 1;
    }

    fn give_back(&mut self, solve: usize) {
        self.free += 1;
        self.solves[solve].holding -= 1;
    }
}

impl Slots {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes a slot for a solve that has begun to wait, at the latest at some time.
    fn take(&self, mut state: MutexGuard<'_, State>, solve: usize, latest: Option<Instant>) {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        while state.free <= 0 || state.next() != Some(solve) {
            let Some(latest) = latest else {
                let woken = self.changed.wait(state);
                state = woken.unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            let left = latest.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            let woken = self.changed.wait_timeout(state, left);
            state = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
        self.waiting.fetch_sub(1, Ordering::Relaxed);
        state.take(solve);
        drop(state);
        // The next free slot may be that of another.
        self.changed.notify_all();
    }
}

/// The place of one solve among those that share slots.
#[derive(Debug, Clone)]
pub(super) struct Share {
    slots: Arc<Slots>,
    solve: usize,
}

impl Share {
    /// The shares of some solves in a number of slots.
    pub(super) fn of(slots: usize, solves: usize) -> impl Iterator<Item = Self> {
        let slots = Arc::new(Slots {
            state: Mutex::new(State {
                free: slots.try_into().unwrap_or(isize::MAX),
                solves: vec![Usage::default(); solves],
            }),
            changed: Condvar::new(),
            waiting: AtomicUsize::new(0),
        });
        (0..solves).map(move |solve| Self {
            slots: Arc::clone(&slots),
            solve,
        })
    }

    /// Waits for a slot and computes with it until the guard is dropped, or goes on with that which
    /// this thread has.
    pub(super) fn compute(&self) -> Computing {
        let begun = HELD.with_borrow_mut(|held| {
            let begins = held.is_none();
            if begins {
                *held = Some(self.take(None));
            }
            begins
        });
        Computing { begun }
    }

    fn take(&self, latest: Option<Instant>) -> Held {
        let mut state = self.slots.lock();
        state.wait(self.solve);
        self.slots.take(state, self.solve, latest);
        Held {
            share: self.clone(),
            since: Instant::now(),
        }
    }
}

/// A slot of this thread.
#[derive(Debug)]
struct Held {
    share: Share,
    since: Instant,
}

impl Held {
    /// Counts the time since the last count.
    fn count(&mut self, state: &mut State) {
        let now = Instant::now();
        state.solves[self.share.solve].used += now - self.since;
        self.since = now;
    }

    /// Gives the slot to a solve that has computed less, if there is one, and waits for the next.
    fn offer(&mut self) {
        let slots = Arc::clone(&self.share.slots);
        if slots.waiting.load(Ordering::Relaxed) == 0 || self.since.elapsed() < QUANTUM {
            return;
        }
        let solve = self.share.solve;
        let mut state = slots.lock();
        self.count(&mut state);
        let next = state.next().filter(|next| *next != solve);
        if next.is_none_or(|next| state.solves[next].used >= state.solves[solve].used) {
            return;
        }
        state.wait(solve);
        state.give_back(solve);
        slots.changed.notify_all();
        slots.take(state, solve, Instant::now().checked_add(MAX_PAUSE));
        self.since = Instant::now();
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        let slots = Arc::clone(&self.share.slots);
        let mut state = slots.lock();
        self.count(&mut state);
        state.give_back(self.share.solve);
        drop(state);
        slots.changed.notify_all();
    }
}

/// This thread computes with a slot.
#[derive(Debug)]
pub(super) struct Computing {
    begun: bool,
}

impl Drop for Computing {
    fn drop(&mut self) {
        if self.begun {
            drop(HELD.take());
        }
    }
}

/// This thread has given its slot back while it waits for others; it takes the next when this is
/// dropped.
#[derive(Debug)]
pub(super) struct Waiting(Option<Share>);

/// Gives the slot of this thread back, if it has one, because it is going to wait for others.
pub(super) fn wait_for_others() -> Waiting {
    let held = HELD.take();
    Waiting(held.map(|held| held.share.clone()))
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(share) = &self.0 {
            let held = share.take(None);
            HELD.set(Some(held));
        }
    }
}

/// Lets others compute whose turn it is, if this thread shares its slot with any.
pub(super) fn offer_slot() {
    HELD.with_borrow_mut(|held| {
        if let Some(held) = held {
            held.offer();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(usage: &[(usize, u64)]) -> State {
        let solves = usage.iter().map(|&(waiting, used)| Usage {
            holding: 0,
            waiting,
            used: Duration::from_secs(used),
        });
        State {
            free: 1,
            solves: solves.collect(),
        }
    }

    #[test]
    fn the_next_slot_is_that_of_the_waiting_solve_that_has_computed_least() {
        assert_eq!(state(&[(1, 9), (0, 2), (2, 5)]).next(), Some(2));
        assert_eq!(state(&[(0, 9), (0, 2)]).next(), None);
    }

    #[test]
    fn who_had_nothing_to_compute_gets_no_credit_and_does_not_pay_for_what_was_free() {
        let mut idle = state(&[(1, 9), (0, 2), (0, 12)]);
        idle.wait(1);
        idle.wait(2);
        let used: Vec<u128> = idle.solves.iter().map(|u| u.used.as_millis()).collect();
        assert_eq!(used, [9_000, 9_000, 9_100]);
        // Alone there is nobody to count from.
        let mut alone = state(&[(0, 9), (0, 2)]);
        alone.wait(1);
        assert_eq!(alone.solves[1].used.as_secs(), 2);
    }
}
