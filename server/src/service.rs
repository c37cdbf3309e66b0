//! The service put together: database, worker, routes, and their end.

use crate::cli::{Exit, Failure};
use crate::http::{self, App, Limits};
use crate::jobs::{Jobs, Worker};
use crate::lifecycle::{GRACE, Shutdown};
use crate::store::{DatabaseLock, Store, StoreError};
use slewplan_solver::pool::SolverPool;
use std::io;
use std::net::SocketAddr;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
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
    /// Most jobs that wait.
    pub(crate) queue_limit: i64,
}

/// Threads for requests: they only wait and move bytes.
const REQUEST_THREADS: usize = 2;

/// What can keep the service from running.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ServiceError {
    /// The database.
    #[error(transparent)]
    Store(#[from] StoreError),
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
pub(crate) fn run(
    settings: &Settings,
    tell: impl FnOnce(SocketAddr) -> Result<(), Failure>,
) -> Result<Exit, Failure> {
    let threads = settings.threads.and_then(NonZeroUsize::new);
    let pools = [
        Arc::new(SolverPool::new(threads)?),
        Arc::new(SolverPool::new(NonZeroUsize::new(1))?),
    ];
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(REQUEST_THREADS)
        .enable_all()
        .build()
        .map_err(system("cannot start the threads for requests"))?;
    runtime.block_on(serve(settings, pools, tell))?;
    Ok(Exit::Complete)
}

async fn serve(
    settings: &Settings,
    pools: [Arc<SolverPool>; 2],
    tell: impl FnOnce(SocketAddr) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let shutdown = Shutdown::on_signals().map_err(system("cannot listen for signals"))?;
    let _lock = DatabaseLock::take(&settings.database).map_err(ServiceError::from)?;
    let store = Store::open(&settings.database)
        .await
        .map_err(ServiceError::from)?;
    let boot_id = Uuid::new_v4().to_string();
    let recovered = store
        .recover(&boot_id, crate::clock::now_us())
        .await
        .map_err(ServiceError::from)?;
    tracing::info!(boot_id, ?recovered, database = %settings.database.display(), "store is open");
    let listener = TcpListener::bind(settings.listen)
        .await
        .map_err(system(format!("cannot listen on {}", settings.listen)))?;
    let address = listener
        .local_addr()
        .map_err(system("cannot tell the own address"))?;
    let jobs = Jobs::new(store.clone(), settings.queue_limit);
    let worker = Worker::start(jobs.clone(), Arc::clone(&pools[0]), boot_id)
        .map_err(system("cannot start the worker"))?;
    let limits = Limits {
        body_bytes: settings.max_body_bytes,
        targets: settings.max_targets,
        queue: settings.queue_limit,
    };
    let router = http::router(App::new(jobs, limits, shutdown.clone(), pools));
    tell(address)?;
    tracing::info!(%address, "listening");
    let mut ending = shutdown.clone();
    let serving =
        axum::serve(listener, router).with_graceful_shutdown(async move { ending.begun().await });
    tokio::select! {
        served = serving => served.map_err(system("cannot serve"))?,
        () = deadline(shutdown) => tracing::warn!("requests were cut off at the end"),
    }
    if tokio::time::timeout(GRACE, worker.drain()).await.is_err() {
        tracing::warn!("the running job was cut off; it runs again after the next start");
    }
    store.close().await;
    tracing::info!("the service has ended");
    Ok(())
}

/// The moment when open requests are no longer waited for.
async fn deadline(mut shutdown: Shutdown) {
    shutdown.begun().await;
    tokio::time::sleep(GRACE / 2).await;
}
