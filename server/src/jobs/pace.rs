//! How fast the jobs of a process end, and what follows for the next claim.

use std::time::Duration;

/// Time after its begin at which a job that has not ended is no tiny one: its begin is stored then. Several
/// times what a tiny job computes, since other jobs and processes share the cores.
pub(super) const TINY: Duration = Duration::from_millis(100);
/// Time that claimed jobs may wait in this process while others wait for a worker.
const AHEAD_S: f64 = 0.1;
/// Maximum number of jobs of a claim.
const MAX_CLAIM: usize = 16;
/// A claim takes at most one of so many waiting jobs: where few wait, other workers may be idle.
const SHARE: usize = 8;
/// What any job that is not tiny counts for in the average, s.
const SLOW_S: f64 = 0.2;
/// Weight of the newest job in the average.
const WEIGHT: f64 = 0.2;

/// Times of the last jobs.
#[derive(Debug, Default)]
pub(super) struct Pace {
    /// Average time of a job, s; `None` before the first one.
    average_s: Option<f64>,
    /// Number of jobs that waited at the last claim.
    waiting: usize,
}

impl Pace {
    /// Notes the time of a job that has ended, s.
    pub(super) fn ended(&mut self, solved_s: f64) {
        let average_s = match self.average_s {
            Some(average_s) if solved_s < TINY.as_secs_f64() => {
                average_s + WEIGHT * (solved_s - average_s)
            }
            _ => solved_s.min(SLOW_S),
        };
        self.average_s = Some(average_s);
    }

    /// Notes that a job takes longer than a tiny one: some tiny ones must follow until more are expected.
    pub(super) fn slow(&mut self) {
        self.average_s = Some(SLOW_S);
    }

    /// Notes the number of jobs that waited.
    pub(super) fn left(&mut self, waiting: usize) {
        self.waiting = waiting;
    }

    /// Whether jobs have been tiny lately.
    pub(super) fn is_fast(&self) -> bool {
        self.average_s
            .is_some_and(|average_s| average_s < TINY.as_secs_f64())
    }

    /// Number of jobs to be claimed at once.
    pub(super) fn claim(&self) -> usize {
        let Some(average_s) = self.average_s.filter(|_| self.is_fast()) else {
            return 1;
        };
        let in_time = (1..=MAX_CLAIM)
            .rev()
            .find(|&jobs| jobs as f64 * average_s <= AHEAD_S);
        in_time.unwrap_or(1).min(self.waiting / SHARE).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tiny_jobs_of_a_long_queue_are_claimed_ahead() {
        let mut pace = Pace::default();
        pace.left(1000);
        assert!(!pace.is_fast());
        assert_eq!(pace.claim(), 1);
        pace.ended(0.002);
        assert!(pace.is_fast());
        assert_eq!(pace.claim(), MAX_CLAIM);
        pace.left(3 * SHARE);
        assert_eq!(pace.claim(), 3);
        pace.left(0);
        assert_eq!(pace.claim(), 1);
        pace.left(1000);
        pace.ended(0.052);
        // The average is 12 ms.
        assert_eq!(pace.claim(), 8);
        for end in [|pace: &mut Pace| pace.ended(60.0), Pace::slow] {
            end(&mut pace);
            assert!(!pace.is_fast());
            assert_eq!(pace.claim(), 1);
            pace.ended(0.002);
            assert!(!pace.is_fast());
            for _ in 0..4 {
                pace.ended(0.002);
            }
            assert!(pace.is_fast());
        }
    }
}
