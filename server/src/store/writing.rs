//! Write transactions, and the alarm for a disk that does not keep what is written.

use super::{Store, StoreError, TellJob};
use sqlx::{Sqlite, SqliteConnection, Transaction};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;
use tokio::sync::{Notify, watch};

/// Told when the operating system could not bring a commit to the disk.
///
/// After a failed sync the kernel may have dropped the pages, and the next sync succeeds without
/// them: nothing that this process writes can be trusted any more. It has to end; the next one
/// reads the write-ahead log from the disk and believes only what its checksums confirm.
#[derive(Debug, Clone)]
pub(super) struct Alarm(Arc<watch::Sender<bool>>);

impl Default for Alarm {
    fn default() -> Self {
        Self(Arc::new(watch::Sender::new(false)))
    }
}

impl Alarm {
    pub(super) fn heed(&self, error: StoreError) -> StoreError {
        if error.is_failed_sync() {
            self.0.send_replace(true);
        }
        error
    }

    async fn raised(&self) {
        // The sender lives as long as this.
        let _ = self.0.subscribe().wait_for(|raised| *raised).await;
    }
}

/// A write transaction; what is not committed is rolled back.
#[derive(Debug)]
pub(super) struct Writing {
    transaction: Transaction<'static, Sqlite>,
    /// Writes the events.
    pub(super) tell: TellJob,
    alarm: Alarm,
    written: Arc<Notify>,
}

impl Writing {
    /// Makes everything durable.
    pub(super) async fn commit(self) -> Result<(), StoreError> {
        let alarm = self.alarm;
        let committed = self.transaction.commit().await;
        committed.map_err(|error| alarm.heed(error.into()))?;
        self.written.notify_one();
        Ok(())
    }
}

impl Deref for Writing {
    type Target = SqliteConnection;

    fn deref(&self) -> &SqliteConnection {
        &self.transaction
    }
}

impl DerefMut for Writing {
    fn deref_mut(&mut self) -> &mut SqliteConnection {
        &mut self.transaction
    }
}

impl Store {
    /// Begins IMMEDIATE, so that nobody else can write in between.
    pub(super) async fn begin(&self) -> Result<Writing, StoreError> {
        let begun = self.writer.begin_with("BEGIN IMMEDIATE").await;
        Ok(Writing {
            transaction: begun.map_err(|error| self.alarm.heed(error.into()))?,
            tell: self.tell,
            alarm: self.alarm.clone(),
            written: Arc::clone(&self.written),
        })
    }

    /// Waits until the disk has failed to keep a commit.
    pub(crate) async fn sync_failed(&self) {
        self.alarm.raised().await;
    }
}
