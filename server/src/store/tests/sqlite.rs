//! What only SQLite has: its write-ahead log, its settings, and failures of the disk.

use super::{ID, lease, on_sqlite, submitted};
use crate::store::database::Database;
use crate::store::{SegmentRow, Store};
use sqlx::SqlitePool;

fn writer(store: &Store) -> &SqlitePool {
    match &store.database {
        Database::Sqlite(database) => &database.writer,
        Database::Postgres(_) => panic!("a database of Postgres"),
    }
}

#[test]
fn the_wal_stays_small_under_continuous_writes() {
    on_sqlite(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        // About 64 MB in all; each write replaces the one before.
        for round in 0..64 {
            let segment = SegmentRow {
                name: "piece 1 2 3".into(),
                intervals: 2,
                motion: vec![round; 1 << 20],
            };
            let taken = store.put_segments(&lease, &[segment]).await;
            assert!(taken.expect("tried"));
        }
        let [_, (_, log)] = store.sizes().await.expect("measured")[..] else {
            panic!("no sizes");
        };
        assert!((1..16 << 20).contains(&log), "{log} bytes");
    });
}

/// The effect of this setting is shown by a test with a recorded disk (tests/trust).
#[test]
fn every_writing_connection_syncs_its_commits() {
    on_sqlite(|store| async move {
        const FULL: i64 = 2;
        for _ in 0..2 {
            let mut writer = writer(&store).acquire().await.expect("a connection");
            let setting = sqlx::query_scalar::<_, i64>("PRAGMA synchronous");
            let setting = setting.fetch_one(&mut *writer).await.expect("read");
            assert_eq!(setting, FULL);
            // The next one is new, as after a failure.
            writer.close().await.expect("closed");
        }
    });
}

#[test]
fn the_store_recovers_from_a_full_disk() {
    on_sqlite(|store| async move {
        submitted(&store).await;
        let big = "x".repeat(1 << 20);
        // More rounds than connections: each failure makes one connection unusable.
        for round in 0..3 {
            sqlx::query("PRAGMA max_page_count = 1")
                .execute(writer(&store))
                .await
                .expect("limited");
            let full = store.put_spacecraft("big", &big, 2).await;
            let error = full.expect_err("there is no room");
            assert!(error.is_disk_full(), "{error}");
            store.job(ID).await.expect("read").expect("there");
            // A new connection does not have the limit.
            let name = format!("small-{round}");
            let stored = store.put_spacecraft(&name, "{}", 3);
            stored.await.expect("the writer has recovered");
        }
    });
}
