//! Copies of a database that is in use.

use super::{PATIENCE, StoreError};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, Connection};
use std::fs::File;
use std::io;
use std::path::Path;
use tempfile::NamedTempFile;

/// Copies a database as it is at one moment. The copy appears complete, tested and on the disk, or
/// not at all; the service can go on meanwhile.
///
/// # Errors
///
/// When the database cannot be read, the copy cannot be written, or it is not a sound database.
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
    let options = SqliteConnectOptions::new().busy_timeout(PATIENCE);
    let mut source = options
        .clone()
        .filename(database)
        .read_only(true)
        .connect()
        .await?;
    sqlx::query("VACUUM INTO ?")
        .bind(partial.path().to_string_lossy().as_ref())
        .execute(&mut source)
        .await?;
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
