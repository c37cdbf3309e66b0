//! The service put together: database, worker, routes, and their end.

use crate::api::connections;
use crate::api::{self, Access, App, Limits};
use crate::base::lifecycle::{GRACE, Shutdown};
use crate::documents::jobs::EventDocument;
use crate::jobs::leg_cache::upkeep;
use crate::jobs::{Jobs, Worker, retention, segments};
use crate::store::{DatabaseLock, QueueLimits, Store, StoreError};
use slewplan_solver::run::pool::{PoolError, SolverPool};
use std::io;
use std::net::SocketAddr;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use uuid::Uuid;

/// How the service shall run.
#[derive(Debug)]
pub(crate) struct Settings {
    /// Address to listen on.
    pub(crate) listen: SocketAddr,
    /// The database.
    pub(crate) database: PathBuf,
    /// Threads of the solver; one per core without it.
    pub(crate) threads: Option<usize>,
    /// Largest body, bytes.
    pub(crate) max_body_bytes: usize,
    /// Most targets of a scenario.
    pub(crate) max_targets: usize,
    /// How many jobs may wait.
    pub(crate) queue: QueueLimits,
    /// Memory of one job, bytes.
    pub(crate) job_memory: u64,
    /// Whether everybody is let in, whatever the address and the keys.
    pub(crate) no_keys: bool,
    /// Time after their end for which jobs are kept; for ever without it.
    pub(crate) retain: Option<Duration>,
    /// Most legs that are remembered.
    pub(crate) legs: u64,
    /// Most connections at once.
    pub(crate) connections: usize,
}

/// By how much the solver's threads stand back behind those for requests.
const POLITENESS: i32 = 10;
/// Longest wait for threads at the very end.
const LAST: Duration = Duration::from_millis(500);
/// How soon a first key closes a service that was open without one.
const KEY_WATCH: Duration = Duration::from_millis(500);
/// Threads for requests: they only wait and move bytes.
const REQUEST_THREADS: usize = 2;

/// What can keep the service from running.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ServiceError {
    /// The database.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// An address for others, and nothing that keeps them out.
    #[error(
        "--listen: {0} can be reached from other machines, and there are no keys; make one with \
         slewplan keys create, or let everybody in with --no-keys"
    )]
    NoKeysOnPublicAddress(SocketAddr),
    /// The operating system refused threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// What was acknowledged can no longer be kept.
    #[error(
        "the disk did not keep what was written; start again when it works: nothing that was \
         acknowledged is lost"
    )]
    Disk,
    /// No connections are taken any more.
    #[error("internal error: the service has stopped listening; the log has the cause")]
    ListenerStopped,
    /// The operating system.
    #[error("{what}: {source}")]
    System {
        /// What was tried.
        what: String,
        /// What the operating system says.
        source: io::Error,
    },
}

fn system(what: impl Into<String>) -> impl FnOnce(io::Error) -> ServiceError {
    |source| ServiceError::System {
        what: what.into(),
        source,
    }
}

/// Serves until a signal ends it. The address is told when requests are taken.
///
/// # Errors
///
/// What kept it from running, or from telling.
pub(crate) fn run<E: From<ServiceError>>(
    settings: &Settings,
    tell: impl FnOnce(SocketAddr) -> Result<(), E>,
) -> Result<(), E> {
    let threads = settings.threads.and_then(NonZeroUsize::new);
    let pools = [
        SolverPool::prepared(threads, step_back),
        SolverPool::new(NonZeroUsize::new(1)),
    ];
    let [solver, lookups] = pools.map(|pool| pool.map(Arc::new).map_err(ServiceError::from));
    let pools = [solver?, lookups?];
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(REQUEST_THREADS)
        .enable_all()
        .build()
        .map_err(system("cannot start the threads for requests"))?;
    let served = runtime.block_on(serve(settings, pools, tell));
    if served.is_ok() {
        // What blocks a thread now is not worth waiting for.
        runtime.shutdown_timeout(LAST);
    } else {
        // The process ends at once; a worker that was not asked to end must not find its runtime
        // gone before that.
        std::mem::forget(runtime);
    }
    served
}

/// Whether keys are asked for: always once there is one. Without keys only this machine is served.
async fn access(settings: &Settings, store: &Store) -> Result<Access, ServiceError> {
    if settings.no_keys {
        tracing::warn!("no keys are asked for: whoever reaches the service can do everything");
        return Ok(Access::new(false));
    }
    let keys = store.keys().await?;
    if !keys.is_empty() {
        return Ok(Access::new(true));
    }
    if settings.listen.ip().is_loopback() {
        let open = Access::new(false);
        tokio::spawn(await_first_key(store.clone(), open.clone()));
        return Ok(open);
    }
    Err(ServiceError::NoKeysOnPublicAddress(settings.listen))
}

/// Asks for keys as soon as there is one.
async fn await_first_key(store: Store, access: Access) {
    while !access.asks_for_keys() {
        tokio::time::sleep(KEY_WATCH).await;
        match store.keys().await {
            Ok(keys) if keys.is_empty() => {}
            Ok(_) => {
                access.ask_for_keys();
                tracing::info!("there is a key now: from now on keys are asked for");
            }
            Err(error) => tracing::warn!(%error, "keys cannot be looked for"),
        }
    }
}

/// Lets threads that answer requests go first. On Linux this concerns only the calling thread.
fn step_back() {
    if let Err(error) = rustix::process::nice(POLITENESS) {
        tracing::debug!(%error, "the solver competes with requests");
    }
}

async fn serve<E: From<ServiceError>>(
    settings: &Settings,
    pools: [Arc<SolverPool>; 2],
    tell: impl FnOnce(SocketAddr) -> Result<(), E>,
) -> Result<(), E> {
    let shutdown = Shutdown::on_signals().map_err(system("cannot listen for signals"))?;
    let _lock = DatabaseLock::take(&settings.database).map_err(ServiceError::from)?;
    let store = Store::open(&settings.database, EventDocument::tell)
        .await
        .map_err(ServiceError::from)?;
    let boot_id = Uuid::new_v4().to_string();
    let recovered = store
        .recover(&boot_id, crate::base::clock::now_us())
        .await
        .map_err(ServiceError::from)?;
    tracing::info!(boot_id, ?recovered, database = %settings.database.display(), "store is open");
    let access = access(settings, &store).await?;
    let listener = TcpListener::bind(settings.listen)
        .await
        .map_err(system(format!("cannot listen on {}", settings.listen)))?;
    let address = listener
        .local_addr()
        .map_err(system("cannot tell the own address"))?;
    if let Some(time) = settings.retain {
        tokio::spawn(retention::keep_for(store.clone(), time));
    }
    tokio::spawn(segments::forget(store.clone()));
    tokio::spawn(upkeep::keep_within(store.clone(), settings.legs));
    let jobs = Jobs::new(store.clone(), settings.queue, settings.job_memory);
    let worker = Worker::start(jobs.clone(), Arc::clone(&pools[0]), boot_id)
        .map_err(system("cannot start the worker"))?;
    let limits = Limits {
        body_bytes: settings.max_body_bytes,
        targets: settings.max_targets,
        // Who only listens does not keep others from asking.
        streams: settings.connections.div_ceil(2),
    };
    let router = api::router(App::new(jobs, limits, access, shutdown.clone(), pools));
    tell(address)?;
    tracing::info!(%address, "listening");
    let serving = connections::serve(listener, router, shutdown.clone(), settings.connections);
    let mut serving = tokio::spawn(serving);
    let mut ending = shutdown.clone();
    tokio::select! {
        biased;
        () = ending.begun() => {}
        () = store.sync_failed() => return Err(ServiceError::Disk.into()),
        _ = &mut serving => return Err(ServiceError::ListenerStopped.into()),
    }
    // Both at once: streams tell what becomes of the job that they follow.
    let finished = async { tokio::join!(worker.drain(), &mut serving) };
    if tokio::time::timeout(GRACE, finished).await.is_err() {
        tracing::warn!("requests or the running job were cut off; the job runs again");
    }
    store.close().await;
    tracing::info!("the service has ended");
    Ok(())
}
