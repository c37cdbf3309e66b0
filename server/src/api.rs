//! HTTP: routes, what they take and what they answer. No SQL and no solving here.

mod access;
mod admission;
mod computing;
pub(crate) mod connections;
mod describe;
mod error;
mod extract;
mod legs;
mod metrics;
mod observe;
mod operations;
mod page;
mod plans;
mod protect;
mod respond;
mod router;
mod slews;
mod spacecraft;
mod stored;
mod studies;
mod verify;

pub(crate) use access::Access;
pub(crate) use router::{openapi, router};

use crate::base::lifecycle::Shutdown;
use crate::jobs::Jobs;
use crate::store::Store;
use computing::Turns;
use metrics::RequestMetrics;
use slewplan_solver::run::pool::SolverPool;
use std::sync::Arc;
use tokio::sync::Semaphore;

/// What every handler can reach.
#[derive(Clone)]
pub(crate) struct App(Arc<Parts>);

/// The parts of the service.
struct Parts {
    /// The queue.
    jobs: Jobs,
    /// What a request may ask for at most.
    limits: Limits,
    /// Whether keys are asked for.
    access: Access,
    /// When the service ends.
    shutdown: Shutdown,
    /// Where jobs and queries are solved.
    pool: Arc<SolverPool>,
    /// Where legs are looked up, so that this never waits for a solve.
    lookups: Arc<SolverPool>,
    /// Requests that compute take turns.
    solving: Turns,
    /// So do those that integrate flights.
    flying: Turns,
    /// Streams of events that are open: a part of all connections.
    streams: Arc<Semaphore>,
    /// Whether work can be taken, as found lately.
    readiness: operations::health::Readiness,
    /// Counts and durations of requests.
    metrics: RequestMetrics,
}

/// What a request may ask for at most.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Largest body, bytes.
    pub(crate) body_bytes: usize,
    /// Most targets of a scenario.
    pub(crate) targets: usize,
    /// Most streams of events at once.
    pub(crate) streams: usize,
}

/// Bytes of the largest body for each of its values and names. Plans and files of legs have some 15 for
/// each, so that half of the largest body can be full of them; in memory they take about 24 bytes.
const BYTES_PER_VALUE: usize = 32;
/// Values and names that every body may have, however small the largest body is.
const MIN_VALUES: usize = 1 << 16;

impl Limits {
    /// Most values in a body, those in lists and objects included, and names of members.
    pub(crate) fn body_values(self) -> usize {
        (self.body_bytes / BYTES_PER_VALUE).max(MIN_VALUES)
    }
}

impl App {
    /// The state of a service: its queue, limits, doors, end, and the pools for solving and for
    /// looking up.
    pub(crate) fn new(
        jobs: Jobs,
        limits: Limits,
        access: Access,
        shutdown: Shutdown,
        [pool, lookups]: [Arc<SolverPool>; 2],
    ) -> Self {
        Self(Arc::new(Parts {
            jobs,
            limits,
            access,
            shutdown,
            pool,
            lookups,
            solving: computing::solving(),
            flying: computing::flying(),
            streams: Arc::new(Semaphore::new(limits.streams)),
            readiness: operations::health::Readiness::default(),
            metrics: RequestMetrics::default(),
        }))
    }

    fn jobs(&self) -> &Jobs {
        &self.0.jobs
    }

    fn store(&self) -> &Store {
        self.0.jobs.store()
    }

    fn limits(&self) -> &Limits {
        &self.0.limits
    }

    fn shutdown(&self) -> &Shutdown {
        &self.0.shutdown
    }
}
