//! Access to the database for commands other than `serve`.

use super::Failure;
use crate::documents;
use crate::service::ServiceError;
use crate::store::{DatabaseAddress, Store};
use std::fs;
use tokio::runtime::Runtime;

/// A runtime with one thread for the database.
pub(super) fn start() -> Result<Runtime, Failure> {
    let started = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build();
    Ok(started.map_err(|source| ServiceError::System {
        what: "cannot start the threads of the database".into(),
        source,
    })?)
}

/// Opens a database that exists, works on it and closes it.
pub(super) fn with_existing_store<T>(
    database: &DatabaseAddress,
    work: impl AsyncFnOnce(&Store) -> Result<T, Failure>,
) -> Result<T, Failure> {
    check_there(database)?;
    with_store(database, work)
}

/// Refuses a file that does not exist.
pub(super) fn check_there(database: &DatabaseAddress) -> Result<(), Failure> {
    if let DatabaseAddress::File(path) = database {
        fs::metadata(path).map_err(|source| Failure::Unreadable {
            name: format!("the database {}", path.display()),
            source,
        })?;
    }
    Ok(())
}

/// Opens or creates a database, works on it and closes it.
pub(super) fn with_store<T>(
    database: &DatabaseAddress,
    work: impl AsyncFnOnce(&Store) -> Result<T, Failure>,
) -> Result<T, Failure> {
    start()?.block_on(async {
        let store = Store::open(database, documents::jobs::tell)
            .await
            .map_err(ServiceError::from)?;
        let done = work(&store).await;
        store.close().await;
        done
    })
}
