//! The jobs that this process works on, and the requests on them.

use slewplan_solver::run::stop::StopSignal;
use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Number of requests that are remembered, in case their job begins here a moment later.
const REMEMBERED: usize = 1024;

/// The running jobs of a process.
#[derive(Debug, Default)]
pub(super) struct ActiveJobs(Mutex<State>);

#[derive(Debug, Default)]
struct State {
    jobs: Vec<ActiveJob>,
    /// Jobs with a request that were not running here, the oldest first.
    requested: VecDeque<String>,
}

#[derive(Debug)]
struct ActiveJob {
    id: String,
    fence: i64,
    stop: StopSignal,
}

impl ActiveJobs {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a job, which a lease allows. Whether there may be requests on it that its row, read with the
    /// lease, does not have.
    pub(super) fn begin(&self, id: &str, fence: i64, stop: &StopSignal) -> bool {
        let mut state = self.state();
        state.jobs.push(ActiveJob {
            id: id.to_owned(),
            fence,
            stop: stop.clone(),
        });
        state.requested.iter().any(|requested| requested == id)
    }

    /// Removes a job.
    pub(super) fn end(&self, id: &str, fence: i64) {
        let is_it = |job: &ActiveJob| job.id == id && job.fence == fence;
        self.state().jobs.retain(|job| !is_it(job));
    }

    /// Acts on a job, if it runs here; else remembers that there is a request on it.
    pub(super) fn request(&self, id: &str, act: impl Fn(&StopSignal)) {
        let mut state = self.state();
        let mut found = false;
        for job in state.jobs.iter().filter(|job| job.id == id) {
            act(&job.stop);
            found = true;
        }
        if !found {
            state.requested.push_back(id.to_owned());
            if state.requested.len() > REMEMBERED {
                state.requested.pop_front();
            }
        }
    }

    /// Cancels all of them.
    pub(super) fn cancel_all(&self) {
        for job in &self.state().jobs {
            job.stop.cancel();
        }
    }

    /// Identifiers of the jobs.
    pub(super) fn ids(&self) -> Vec<String> {
        self.state().jobs.iter().map(|job| job.id.clone()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_reaches_its_job_or_is_remembered_for_it() {
        let active = ActiveJobs::default();
        let [early, late] = [(); 2].map(|()| StopSignal::new());
        assert!(!active.begin("early", 1, &early));
        active.request("early", StopSignal::request);
        active.request("late", StopSignal::request);
        assert!(early.is_set());
        assert!(active.begin("late", 1, &late) && !late.is_set());
        active.end("early", 2);
        assert_eq!(active.ids(), ["early", "late"]);
        active.end("early", 1);
        active.cancel_all();
        assert!(late.is_set());
        for number in 0..REMEMBERED {
            active.request(&number.to_string(), StopSignal::request);
        }
        // Forgotten, as the oldest.
        assert!(!active.begin("late", 2, &late));
    }
}
