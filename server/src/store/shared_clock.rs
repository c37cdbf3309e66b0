//! The clock that leases are measured by.
//!
//! Leases of one database are given and taken by processes on several machines, whose clocks may
//! differ by more than a lease. They go by the clock of the server.

use super::database::Database;
use super::{Store, StoreError};
use crate::base::clock;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

/// By how much the clock of a server is ahead of that of this machine, µs.
#[derive(Debug, Clone, Default)]
pub(super) struct ClockOffset(Arc<AtomicI64>);

impl Store {
    /// The time by which leases are given, microseconds since 1970.
    pub(crate) fn lease_clock_us(&self) -> i64 {
        let ahead = match &self.database {
            Database::Sqlite(_) => 0,
            Database::Postgres(database) => database.clock.0.load(Ordering::Relaxed),
        };
        clock::now_us().saturating_add(ahead)
    }

    /// Compares the clock of this machine with that of the server, and looks what waits there; nothing does
    /// in a file, whose process looks by itself.
    pub(crate) async fn compare_clocks(&self) -> Result<Standing, StoreError> {
        let Database::Postgres(database) = &self.database else {
            return Ok(Standing::default());
        };
        let before = clock::now_us();
        let look = "SELECT now_us, \
             EXISTS (SELECT 1 FROM jobs WHERE state = 'queued' AND boot_id IS NULL), \
             EXISTS (SELECT 1 FROM jobs WHERE state = 'running' AND lease_until_us < now_us) \
             OR coalesce((SELECT min(claimed_until_us) FROM jobs) < now_us, false) \
             FROM (SELECT CAST(extract(epoch FROM clock_timestamp()) * 1000000 AS bigint) AS now_us) \
             AS clock";
        let (server, jobs_wait, leases_expired): (i64, bool, bool) =
            sqlx::query_as(look).fetch_one(&database.pool).await?;
        let here = i64::midpoint(before, clock::now_us());
        database.clock.0.store(server - here, Ordering::Relaxed);
        Ok(Standing {
            jobs_wait,
            leases_expired,
        })
    }
}

/// What waits on a server.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Standing {
    /// Whether jobs are queued that nobody has claimed.
    pub(crate) jobs_wait: bool,
    /// Whether leases or claims have expired.
    pub(crate) leases_expired: bool,
}
