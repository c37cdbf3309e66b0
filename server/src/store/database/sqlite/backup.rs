//! Copies of a database that is in use.

use super::BUSY_TIMEOUT;
use crate::store::StoreError;
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, Connection};
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tempfile::NamedTempFile;

/// Interval between two syncs of the copy while it is written.
const SYNC_INTERVAL: Duration = Duration::from_millis(10);

/// Copies a database as of one moment while the service runs. The copy appears under its name only
/// when it is complete, synced and has passed the integrity check.
///
/// # Errors
///
/// When the database cannot be read, the copy cannot be written, or the copy fails the integrity
/// check.
pub(crate) async fn backup(database: &Path, copy: &Path) -> Result<(), StoreError> {
    let failed = |source: io::Error| StoreError::Copy {
        path: copy.into(),
        source,
    };
    let folder = match copy.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let partial = NamedTempFile::new_in(folder).map_err(failed)?;
    let options = SqliteConnectOptions::new().busy_timeout(BUSY_TIMEOUT);
    let mut source = options
        .clone()
        .filename(database)
        .read_only(true)
        .connect()
        .await?;
    let path = partial.path().to_string_lossy();
    let copying = sqlx::query("VACUUM INTO ?")
        .bind(path.as_ref())
        .execute(&mut source);
    let written = partial.reopen().map_err(failed)?;
    tokio::select! {
        copied = copying => copied.map(drop)?,
        error = sync_repeatedly(written) => return Err(failed(error)),
    }
    source.close().await?;
    let mut copied = options.filename(partial.path()).connect().await?;
    let verdict: String = sqlx::query_scalar("PRAGMA integrity_check")
        .fetch_one(&mut copied)
        .await?;
    copied.close().await?;
    if verdict != "ok" {
        return Err(StoreError::Damaged { what: "database" });
    }
    partial.as_file().sync_all().map_err(failed)?;
    partial.persist(copy).map_err(|error| failed(error.error))?;
    File::open(folder)
        .and_then(|folder| folder.sync_all())
        .map_err(failed)
}

/// Syncs a file that is being written again and again, until a sync fails. One sync at the end
/// would delay every other sync on the disk, those of the running service included.
async fn sync_repeatedly(file: File) -> io::Error {
    let file = Arc::new(file);
    loop {
        tokio::time::sleep(SYNC_INTERVAL).await;
        let file = Arc::clone(&file);
        let synced = tokio::task::spawn_blocking(move || file.sync_data()).await;
        if let Err(error) = synced.unwrap_or_else(|error| Err(io::Error::other(error))) {
            return error;
        }
    }
}
