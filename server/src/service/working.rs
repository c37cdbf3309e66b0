//! A process that only solves: jobs of a database that it shares with services and other workers.

use super::{
    ServiceError, be_nicer, lower_priority, on_runtime, open_store, shared_threads, system,
};
use crate::api;
use crate::base::lifecycle::{GRACE, Shutdown};
use crate::jobs::{Jobs, Worker};
use crate::store::{DatabaseAddress, OtherProcesses, QueueLimits};
use slewplan_solver::run::pool::SolverPool;
use std::net::SocketAddr;
use std::num::NonZeroUsize;
use std::sync::Arc;
use tokio::net::TcpListener;
use uuid::Uuid;

/// Settings of a worker.
#[derive(Debug)]
pub(crate) struct WorkSettings {
    /// Where the database is.
    pub(crate) database: DatabaseAddress,
    /// Maximum number of connections to the server of the database, beside those for notices.
    pub(crate) database_connections: u32,
    /// Where metrics and health are answered, if anywhere.
    pub(crate) metrics: Option<SocketAddr>,
    /// Threads of the solver; one per core without it.
    pub(crate) threads: Option<usize>,
    /// Number of jobs that are solved at once.
    pub(crate) jobs: usize,
    /// Whether parts of large tables of legs are offered to other processes.
    pub(crate) spread_legs: bool,
    /// Memory limit of the jobs that are solved at once, bytes.
    pub(crate) job_memory: u64,
}

/// Niceness of a worker: services and a database on the same machine, which somebody waits for, take precedence.
const WORKER_NICENESS: i32 = 5;
/// A worker queues nothing.
const NO_QUEUE: QueueLimits = QueueLimits { all: 0, client: 0 };

/// Solves until a signal ends it. Calls `tell` once it takes jobs, with the address of its metrics.
///
/// # Errors
///
/// What kept it from working, and errors of `tell`.
pub(crate) fn run<E: From<ServiceError>>(
    settings: &WorkSettings,
    tell: impl FnOnce(Option<SocketAddr>) -> Result<(), E>,
) -> Result<(), E> {
    be_nicer(WORKER_NICENESS);
    let threads = settings.threads.and_then(NonZeroUsize::new);
    let pools = shared_threads(threads, settings.jobs)?;
    on_runtime(work(settings, pools, tell))
}

async fn work<E: From<ServiceError>>(
    settings: &WorkSettings,
    pools: Vec<Arc<SolverPool>>,
    tell: impl FnOnce(Option<SocketAddr>) -> Result<(), E>,
) -> Result<(), E> {
    let shutdown = Shutdown::on_signals().map_err(system("cannot listen for signals"))?;
    let boot_id = Uuid::new_v4().to_string();
    let connections = settings.database_connections;
    let others = OtherProcesses::MayLive;
    let store = open_store(&settings.database, connections, others, &boot_id).await?;
    let jobs = Jobs::new(
        store.clone(),
        NO_QUEUE,
        settings.job_memory,
        settings.spread_legs,
    );
    let metrics = match settings.metrics {
        Some(address) => Some(serve_metrics(address, jobs.clone()).await?),
        None => None,
    };
    jobs.follow_others(boot_id.clone());
    let worker = Worker::start(&jobs, pools, &boot_id, lower_priority)
        .map_err(system("cannot start the worker"))?;
    tell(metrics)?;
    shutdown.clone().begun().await;
    if tokio::time::timeout(GRACE, worker.drain()).await.is_err() {
        tracing::warn!("running jobs did not end in time; they will run again");
    }
    store.close().await;
    tracing::info!("the worker has ended");
    Ok(())
}

/// Answers metrics and health until the process ends. Returns the address.
async fn serve_metrics(address: SocketAddr, jobs: Jobs) -> Result<SocketAddr, ServiceError> {
    let cannot_listen = || system(format!("cannot listen on {address}"));
    let listener = TcpListener::bind(address).await.map_err(cannot_listen())?;
    let own = listener.local_addr().map_err(cannot_listen())?;
    tokio::spawn(axum::serve(listener, api::worker_router(jobs)).into_future());
    Ok(own)
}
