//! The service: start of database, worker and routes, and their shutdown.

pub(crate) mod working;

use crate::api::connections;
use crate::api::{self, Access, AllowedHost, App, OwnHosts, RequestLimits};
use crate::base::lifecycle::{GRACE, Shutdown};
use crate::documents;
use crate::jobs::leg_cache::upkeep;
use crate::jobs::{Jobs, Worker, retention, segments};
use crate::store::{DatabaseAddress, DatabaseLock, OtherProcesses, QueueLimits, Store, StoreError};
use slewplan_solver::run::pool::{PoolError, SolverPool};
use std::io;
use std::net::SocketAddr;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use uuid::Uuid;

/// Settings of the service.
#[derive(Debug)]
pub(crate) struct ServiceSettings {
    /// Address to listen on.
    pub(crate) listen: SocketAddr,
    /// Where the database is.
    pub(crate) database: DatabaseAddress,
    /// Maximum number of connections to a server of databases, beside those for notices.
    pub(crate) database_connections: u32,
    /// Threads of the solver; one per core without it.
    pub(crate) threads: Option<usize>,
    /// Number of jobs that this process solves at once; none where only others on the same database
    /// solve.
    pub(crate) jobs: usize,
    /// Maximum size of a request body, bytes.
    pub(crate) max_body_bytes: usize,
    /// Maximum number of targets of a scenario.
    pub(crate) max_targets: usize,
    /// Limits on the number of queued jobs.
    pub(crate) queue: QueueLimits,
    /// Whether parts of large tables of legs are offered to other processes.
    pub(crate) spread_legs: bool,
    /// Memory limit of the jobs that are solved at once, bytes.
    pub(crate) job_memory: u64,
    /// Whether requests need no key, whatever the address.
    pub(crate) no_keys: bool,
    /// Hosts by which the service is reached, beside loopback names and its address.
    pub(crate) allowed_hosts: Vec<AllowedHost>,
    /// Time for which ended jobs are kept; without it they are not deleted.
    pub(crate) retain: Option<Duration>,
    /// Maximum number of cached legs.
    pub(crate) legs: u64,
    /// Maximum number of connections.
    pub(crate) connections: usize,
}

/// By how much the solver's threads are nicer than the others of their process, so that threads for requests take
/// precedence.
const SOLVER_NICENESS: i32 = 10;
/// Longest wait for blocking threads after the shutdown.
const RUNTIME_SHUTDOWN: Duration = Duration::from_millis(500);
/// Interval at which a service without keys looks for a first one; where it is told of one, behind that.
const KEY_POLL: Duration = Duration::from_millis(500);
const SHARED_KEY_POLL: Duration = Duration::from_secs(10);
/// Threads for requests, which do no computing.
const REQUEST_THREADS: usize = 2;

/// Errors that end the service.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ServiceError {
    /// The path of the database.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A public address without keys.
    #[error(
        "--listen: {0} can be reached from other machines, and there are no keys; make one with \
         slewplan keys create, or let everybody in with --no-keys"
    )]
    NoKeysOnPublicAddress(SocketAddr),
    /// The operating system refused threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// A sync of the database failed.
    #[error(
        "the disk failed to sync a write; restart the service when the disk works: no acknowledged write is lost"
    )]
    Disk,
    /// The listener has ended.
    #[error("internal error: the service has stopped listening; the log has the cause")]
    ListenerStopped,
    /// The operating system.
    #[error("{what}: {source}")]
    System {
        /// The operation that failed.
        what: String,
        /// The error of the operating system.
        source: io::Error,
    },
}

fn system(what: impl Into<String>) -> impl FnOnce(io::Error) -> ServiceError {
    |source| ServiceError::System {
        what: what.into(),
        source,
    }
}

/// Serves until a signal ends it. Calls `tell` with the address once requests are accepted.
///
/// # Errors
///
/// What kept it from running, and errors of `tell`.
pub(crate) fn run<E: From<ServiceError>>(
    settings: &ServiceSettings,
    tell: impl FnOnce(SocketAddr) -> Result<(), E>,
) -> Result<(), E> {
    let threads = settings.threads.and_then(NonZeroUsize::new);
    // Requests compute in turn with the jobs.
    let [requests, jobs @ ..] = &shared_threads(threads, 1 + settings.jobs)?[..] else {
        unreachable!("a pool for each");
    };
    let lookups = SolverPool::new(NonZeroUsize::new(1)).map_err(ServiceError::from)?;
    let pools = [Arc::clone(requests), Arc::new(lookups)];
    on_runtime(serve(settings, pools, jobs.to_vec(), tell))
}

/// Pools for a number of solves at once, which share the threads of the solver.
fn shared_threads(
    threads: Option<NonZeroUsize>,
    solves: usize,
) -> Result<Vec<Arc<SolverPool>>, ServiceError> {
    let pools = SolverPool::sharing(threads, solves, lower_priority)?;
    Ok(pools.into_iter().map(Arc::new).collect())
}

/// Runs the service, or only a worker, on the threads for requests and for the database.
fn on_runtime<E: From<ServiceError>>(work: impl Future<Output = Result<(), E>>) -> Result<(), E> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(REQUEST_THREADS)
        .enable_all()
        .build()
        .map_err(system("cannot start the threads for requests"))?;
    let worked = runtime.block_on(work);
    if worked.is_ok() {
        // Threads that still block are left to the end of the process.
        runtime.shutdown_timeout(RUNTIME_SHUTDOWN);
    } else {
        // The process ends at once. The worker, which was not asked to end, still uses the runtime.
        std::mem::forget(runtime);
    }
    worked
}

/// Opens the database; where this process is the only one, jobs of the one before are taken back.
async fn open_store(
    address: &DatabaseAddress,
    connections: u32,
    others: OtherProcesses,
    boot_id: &str,
) -> Result<Store, ServiceError> {
    let store = Store::open_with(address, connections, documents::jobs::tell).await?;
    if others == OtherProcesses::Ended {
        let now_us = store.lease_clock_us();
        let recovered = store.recover(boot_id, others, now_us).await?;
        tracing::info!(?recovered, "jobs of the process before");
    }
    tracing::info!(boot_id, database = %address, "store is open");
    Ok(store)
}

/// Whether requests need a key: always once there is one. Without keys only loopback addresses are
/// served.
async fn access(settings: &ServiceSettings, store: &Store) -> Result<Access, ServiceError> {
    if settings.no_keys {
        tracing::warn!("no keys are required: everyone who reaches the service has full access");
        return Ok(Access::new(false));
    }
    let keys = store.keys().await?;
    if !keys.is_empty() {
        let now = crate::base::clock::now_us();
        if !keys.iter().any(|key| key.is_valid(now)) {
            tracing::warn!(
                "no key is valid: nobody can use the service until slewplan keys create makes one"
            );
        }
        return Ok(Access::new(true));
    }
    if settings.listen.ip().is_loopback() {
        let open = Access::new(false);
        tokio::spawn(await_first_key(store.clone(), open.clone()));
        return Ok(open);
    }
    Err(ServiceError::NoKeysOnPublicAddress(settings.listen))
}

/// Requires keys as soon as there is one.
async fn await_first_key(store: Store, access: Access) {
    while !access.asks_for_keys() {
        if store.is_shared() {
            // After the wait or a notice.
            let _ = tokio::time::timeout(SHARED_KEY_POLL, store.told_of_keys()).await;
        } else {
            tokio::time::sleep(KEY_POLL).await;
        }
        match store.keys().await {
            Ok(keys) if keys.is_empty() => {}
            Ok(_) => {
                access.ask_for_keys();
                tracing::info!("a key has been created: requests need keys from now on");
            }
            Err(error) => tracing::warn!(%error, "keys cannot be read"),
        }
    }
}

/// Lowers the priority of the calling thread, which is one of the solver's.
fn lower_priority() {
    be_nicer(SOLVER_NICENESS);
}

/// Lowers the priority of the calling thread and of those that it will start (Linux applies niceness per thread).
fn be_nicer(by: i32) {
    if let Err(error) = rustix::process::nice(by) {
        tracing::debug!(%error, "the priority of a thread cannot be lowered");
    }
}

/// Locks a file of SQLite for this process. A server of Postgres is shared.
fn claim_database(
    address: &DatabaseAddress,
) -> Result<(Option<DatabaseLock>, OtherProcesses), ServiceError> {
    match address {
        DatabaseAddress::File(path) => {
            let lock = DatabaseLock::take(path)?;
            Ok((Some(lock), OtherProcesses::Ended))
        }
        DatabaseAddress::Postgres(_) => Ok((None, OtherProcesses::MayLive)),
    }
}

async fn serve<E: From<ServiceError>>(
    settings: &ServiceSettings,
    pools: [Arc<SolverPool>; 2],
    job_pools: Vec<Arc<SolverPool>>,
    tell: impl FnOnce(SocketAddr) -> Result<(), E>,
) -> Result<(), E> {
    let shutdown = Shutdown::on_signals().map_err(system("cannot listen for signals"))?;
    let (_lock, others) = claim_database(&settings.database)?;
    let boot_id = Uuid::new_v4().to_string();
    let connections = settings.database_connections;
    let store = open_store(&settings.database, connections, others, &boot_id).await?;
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
    tokio::spawn(segments::delete_of_ended_jobs(store.clone()));
    tokio::spawn(upkeep::keep_within(store.clone(), settings.legs));
    let jobs = Jobs::new(
        store.clone(),
        settings.queue,
        settings.job_memory,
        settings.spread_legs,
    );
    jobs.follow_others(boot_id.clone());
    let worker = Worker::start(&jobs, job_pools, &boot_id, lower_priority)
        .map_err(system("cannot start the worker"))?;
    let limits = RequestLimits {
        body_bytes: settings.max_body_bytes,
        targets: settings.max_targets,
        // Event streams take at most half of the connections.
        streams: settings.connections.div_ceil(2),
        jobs: settings.jobs,
    };
    let hosts = OwnHosts::new(address, settings.allowed_hosts.clone());
    let router = api::router(App::new(
        jobs,
        limits,
        access,
        hosts,
        shutdown.clone(),
        pools,
    ));
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
    // Both at once: event streams report the release of the job that they follow.
    let finished = async { tokio::join!(worker.drain(), &mut serving) };
    if tokio::time::timeout(GRACE, finished).await.is_err() {
        tracing::warn!("requests or running jobs did not end in time; the jobs will run again");
    }
    store.close().await;
    tracing::info!("the service has ended");
    Ok(())
}
