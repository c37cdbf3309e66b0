//! Write transactions, and the alarm for failed syncs.

use super::database::{Database, Transaction};
use super::{FormatEvent, Store, StoreError};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;
use tokio::sync::watch;

/// Raised when the operating system failed to sync a commit to the disk.
///
/// After a failed sync the kernel may have dropped the pages, and the next sync succeeds without
/// them: later commits of this process could rest on lost pages. It has to end; the next process
/// reads the write-ahead log from the disk and uses only the part that its checksums confirm.
#[derive(Debug, Clone)]
pub(super) struct SyncAlarm(Arc<watch::Sender<bool>>);

impl Default for SyncAlarm {
    fn default() -> Self {
        Self(Arc::new(watch::Sender::new(false)))
    }
}

impl SyncAlarm {
    /// Raises the alarm if the error is a failed sync, and passes the error on.
    pub(super) fn check(&self, error: StoreError) -> StoreError {
        if error.is_failed_sync() {
            self.0.send_replace(true);
        }
        error
    }

    async fn raised(&self) {
        // Cannot fail: the sender lives as long as `self`.
        let _ = self.0.subscribe().wait_for(|raised| *raised).await;
    }
}

/// A write transaction; it is rolled back unless it is committed.
#[derive(Debug)]
pub(super) struct WriteTransaction {
    transaction: Transaction,
    /// Formats the events.
    pub(super) format_event: FormatEvent,
    alarm: SyncAlarm,
    database: Database,
}

impl WriteTransaction {
    /// Commits and syncs the transaction.
    pub(super) async fn commit(self) -> Result<(), StoreError> {
        let alarm = self.alarm;
        let committed = self.transaction.commit().await;
        committed.map_err(|error| alarm.check(error.into()))?;
        if let Database::Sqlite(database) = &self.database {
            database.written.notify_one();
        }
        Ok(())
    }

    /// Ends the transaction without its changes. One that is only dropped keeps its locks until the
    /// pool has its connection back, some time after the drop.
    pub(super) async fn rollback(self) -> Result<(), StoreError> {
        Ok(self.transaction.rollback().await?)
    }
}

impl Deref for WriteTransaction {
    type Target = Transaction;

    fn deref(&self) -> &Transaction {
        &self.transaction
    }
}

impl DerefMut for WriteTransaction {
    fn deref_mut(&mut self) -> &mut Transaction {
        &mut self.transaction
    }
}

impl Store {
    /// Begins a transaction; one of SQLite holds the write lock from its begin.
    pub(super) async fn begin(&self) -> Result<WriteTransaction, StoreError> {
        let begun = self.database.begin().await;
        Ok(WriteTransaction {
            transaction: begun.map_err(|error| self.alarm.check(error))?,
            format_event: self.format_event,
            alarm: self.alarm.clone(),
            database: self.database.clone(),
        })
    }

    /// Waits until a sync has failed.
    pub(crate) async fn sync_failed(&self) {
        self.alarm.raised().await;
    }
}
