//! The HTTP interface: routes, their requests and answers. No SQL and no solving here.

mod access;
mod admission;
mod computing;
pub(crate) mod connections;
mod describe;
mod error;
mod extract;
mod jobs;
mod leg_tables;
mod legs;
mod metrics;
mod negotiation;
mod observe;
mod operations;
mod origin;
mod page;
mod paging;
mod plans;
mod protect;
mod respond;
mod router;
mod slews;
mod spacecraft;
mod stored;
mod streaming;
mod studies;
mod verify;

pub(crate) use access::Access;
pub(crate) use origin::{AllowedHost, OwnHosts};
pub(crate) use router::{openapi, router, worker_router};

use crate::base::lifecycle::Shutdown;
use crate::jobs::Jobs;
use crate::store::Store;
use computing::Turns;
use metrics::RequestMetrics;
use slewplan_solver::run::pool::SolverPool;
use std::sync::Arc;
use tokio::sync::Semaphore;

/// The state that all handlers share.
#[derive(Clone)]
pub(crate) struct App(Arc<Parts>);

/// The parts of [`App`].
struct Parts {
    /// The jobs.
    jobs: Jobs,
    /// Limits on requests.
    limits: RequestLimits,
    /// Whether requests need keys.
    access: Access,
    /// The names and addresses of the service.
    hosts: OwnHosts,
    /// Signals the shutdown.
    shutdown: Shutdown,
    /// Threads for jobs and queries.
    pool: Arc<SolverPool>,
    /// Threads for look-ups of legs, which never wait for a solve.
    lookups: Arc<SolverPool>,
    /// Turns of requests that solve.
    solving: Turns,
    /// Turns of requests that integrate flights.
    integrating: Turns,
    /// Turns of requests that write tables of leg times.
    tabulating: Turns,
    /// Permits for event streams, fewer than connections.
    streams: Arc<Semaphore>,
    /// The cached answer of the readiness check.
    readiness: operations::health::Readiness,
    /// Counts and durations of requests.
    metrics: RequestMetrics,
}

/// Limits on requests.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RequestLimits {
    /// Maximum size of a body, bytes.
    pub(crate) body_bytes: usize,
    /// Maximum number of targets of a scenario.
    pub(crate) targets: usize,
    /// Maximum number of event streams at once.
    pub(crate) streams: usize,
    /// Number of jobs that this process solves at once.
    pub(crate) jobs: usize,
}

/// The number of values and names allowed in a body is its maximum size divided by this, bytes.
/// Plans and files of legs have about 15 bytes per value; in memory a value takes about 24 bytes.
const BYTES_PER_VALUE: usize = 32;
/// Number of values and names that a body may always have.
const MIN_VALUES: usize = 1 << 16;

impl RequestLimits {
    /// Maximum number of values in a body, nested ones included, and names of members.
    pub(crate) fn body_values(self) -> usize {
        (self.body_bytes / BYTES_PER_VALUE).max(MIN_VALUES)
    }
}

impl App {
    /// The state of a service, with its pools for solving and for look-ups.
    pub(crate) fn new(
        jobs: Jobs,
        limits: RequestLimits,
        access: Access,
        hosts: OwnHosts,
        shutdown: Shutdown,
        [pool, lookups]: [Arc<SolverPool>; 2],
    ) -> Self {
        Self(Arc::new(Parts {
            jobs,
            limits,
            access,
            hosts,
            shutdown,
            pool,
            lookups,
            solving: computing::solving(),
            integrating: computing::integrating(),
            tabulating: computing::tabulating(),
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

    fn limits(&self) -> &RequestLimits {
        &self.0.limits
    }

    fn shutdown(&self) -> &Shutdown {
        &self.0.shutdown
    }
}
