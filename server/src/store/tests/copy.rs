//! Copies of a whole database.

use super::{MemoryRoom, Store, open, postgres, runtime, submission};
use crate::store::copy::cells::{Cell, Cells};
use crate::store::copy::{TABLES, copied_tables};
use crate::store::database::Database;
use crate::store::database::statement::sql;
use crate::store::{DatabaseAddress, QueueLimits, StoreError, Submission, copy};
use sqlx::AssertSqlSafe;
use std::collections::BTreeMap;

/// Rows of every table, with values that do not pass by themselves: bounds of numbers, empty texts and
/// bytes, letters of several bytes, nothing.
const ROWS: [&str; 14] = [
    "INSERT INTO api_keys (id, client, digest, scopes, created_us, expires_us, revoked_us) \
     VALUES ('k1', 'é', 'd1', 'read write', 9223372036854775807, NULL, -1), \
     ('K1', '', 'd2', '', 0, 7, NULL)",
    "INSERT INTO spacecraft (name, version, document, created_us) \
     VALUES ('b', 2, '{}', 3), ('b', 10, '{\"a\": 0.1}', 4), ('a', 1, '', 5)",
    "INSERT INTO jobs (sequence, id, state, name, scenario, targets, incumbent_s, lower_bound_s, attempt, \
     fence, boot_id, lease_until_us, submitted_us, keep_out_violated, work, priority, turn, memory_bytes) \
     VALUES (3, 'j3', 'running', '\u{2603}', $1, 2, 1e-300, 0.1, 1, 1, 'boot', 5, 1, FALSE, 'plan', -10, 2, 7)",
    "INSERT INTO jobs (sequence, id, state, scenario, targets, submitted_us, keep_out_violated, client) \
     VALUES (4, 'j4', 'succeeded', $1, 0, 1, TRUE, 'é'), (5, 'j5', 'queued', $1, 0, 1, NULL, NULL), \
     (6, 'j6', 'dead', $1, 0, 1, NULL, ''), (7, 'j7', 'failed', $1, 0, 1, NULL, NULL), \
     (8, 'j8', 'cancelled', $1, 0, 1, NULL, NULL)",
    "INSERT INTO results (job, document, digest, packed) VALUES (4, $1, 'x', TRUE), (7, $2, '', FALSE)",
    "INSERT INTO incumbents (job, total_time_s, lower_bound_s, document, digest, packed, keep_out_violated) \
     VALUES (3, 1.7976931348623157e308, 5e-324, $1, 'x', TRUE, FALSE)",
    "INSERT INTO idempotency_keys (key, fingerprint, job, created_us) VALUES ('', 'f', 4, 1), ('Z', 'f', 5, 1), \
     ('a', 'f', 6, 1), ('é', 'f', 7, 1)",
    "INSERT INTO segments (sequence, job, name, solver_version, intervals, motion) \
     VALUES (9, 3, 'piece 1', 'v', 2, $1)",
    "INSERT INTO leg_table_parts (job, first, legs, cached, computed, document, packed, digest) \
     VALUES (3, 0, 1, 0, 1, $1, TRUE, 'x'), (3, 512, 1, 1, 0, $2, FALSE, 'y')",
    "INSERT INTO leg_spacecraft (key, document) VALUES ('s', 'text')",
    "INSERT INTO legs (sequence, key, identity, spacecraft, kind, turn_x, turn_y, turn_z, turn_w, momentum_x, \
     momentum_y, momentum_z, duration_s, solve_time_s, status, solver_version, trajectory, created_us, \
     reversible, certified_lower_bound_s, bound_version) \
     VALUES (12, 'l', 'i', 's', 'k', 0.1, -0.0, 1e-7, 1, 0, 0, 0, 2.5, 0.3, 'c', 'v', $1, 1, TRUE, NULL, NULL), \
     (2, 'm', 'i', 's', 'k', 0.1, 0.2, 1e-7, 1, 0, 0, 0, 2.5, 0.3, 'c', 'v', $1, 1, FALSE, 0.1, 3)",
    "INSERT INTO readiness (one, checked_us) VALUES (1, 5)",
    // The next job has a greater number, although this one is gone.
    "INSERT INTO jobs (sequence, id, state, scenario, targets, submitted_us) VALUES (50, 'gone', 'dead', $1, 0, 1)",
    "DELETE FROM jobs WHERE id = 'gone'",
];

async fn fill(store: &Store) {
    let (bytes, nothing) = (vec![0_u8, 255, 10, 0], Vec::<u8>::new());
    let mut transaction = store.begin().await.expect("begun");
    for row in ROWS {
        let mut statement = sql(row);
        for (place, value) in [("$1", &bytes), ("$2", &nothing)] {
            if row.contains(place) {
                statement = statement.bind(value);
            }
        }
        statement.execute(&mut *transaction).await.expect(row);
    }
    for id in 1..=1201 {
        sql("INSERT INTO events (job, id, kind, data) VALUES (3, $1, 'progress', '{}')")
            .bind(i64::from(id))
            .execute(&mut *transaction)
            .await
            .expect("stored");
    }
    transaction.commit().await.expect("committed");
}

/// All rows of all tables, in no order; truths as the numbers that they are in SQLite.
async fn contents(store: &Store) -> BTreeMap<&'static str, Vec<String>> {
    let mut all = BTreeMap::new();
    for table in copied_tables() {
        let columns: Vec<(String, String)> = sql("{columns_of}")
            .bind(table.name)
            .fetch_all(&store.database)
            .await
            .expect("columns");
        let names: Vec<_> = columns.into_iter().map(|(name, _)| name).collect();
        let query = format!("SELECT {} FROM {}", names.join(", "), table.name);
        let rows: Vec<Cells> = sql(AssertSqlSafe(query))
            .fetch_all(&store.database)
            .await
            .expect("rows");
        let rows = rows.into_iter().map(|Cells(cells)| {
            let cells = cells.into_iter().map(|cell| match cell {
                Cell::Truth(truth) => Cell::Integer(truth.map(i64::from)),
                Cell::Real(number) => Cell::Integer(number.map(|n| n.to_bits().cast_signed())),
                other => other,
            });
            format!("{:?}", cells.collect::<Vec<_>>())
        });
        let mut rows: Vec<_> = rows.collect();
        rows.sort();
        all.insert(table.name, rows);
    }
    all
}

/// A file in a folder, and a database of the server, where Postgres is installed.
fn addresses(folder: &tempfile::TempDir) -> Option<[DatabaseAddress; 2]> {
    let Some(server) = postgres::new_database() else {
        println!("not run: Postgres is not installed");
        return None;
    };
    let file = folder.path().join("copy.db").into_os_string();
    let addresses = [file, server.into()].map(|address| address.try_into().expect("an address"));
    Some(addresses)
}

/// Queues a job and returns its number.
async fn queue(store: &Store) -> i64 {
    let limits = QueueLimits { all: 9, client: 9 };
    let queued = store.submit(&submission(), limits, 1).await;
    queued.expect("queued");
    let job = store.job(&submission().id).await.expect("read");
    job.expect("it is there").sequence
}

#[test]
fn a_copy_there_and_back_has_every_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some([file, server]) = addresses(&folder) else {
        return;
    };
    let back = DatabaseAddress::File(folder.path().join("back.db"));
    runtime().block_on(async {
        let [file, server, back] = [open(&file).await, open(&server).await, open(&back).await];
        fill(&file).await;
        let there = copy(&file, &server).await.expect("copied");
        assert_eq!(there, copy(&server, &back).await.expect("copied"));
        let expected = contents(&file).await;
        assert!(
            expected.values().all(|rows| !rows.is_empty()),
            "{expected:?}"
        );
        let counted = there
            .iter()
            .map(|copied| (copied.table, usize::try_from(copied.rows).expect("a count")));
        let counts = expected.iter().map(|(table, rows)| (*table, rows.len()));
        assert_eq!(counted.collect::<BTreeMap<_, _>>(), counts.collect());
        for copied in [&server, &back] {
            assert!(contents(copied).await == expected);
            // Numbers go on after the greatest there ever was.
            assert_eq!(queue(copied).await, 51);
            let mut transaction = copied.begin().await.expect("begun");
            sql(
                "INSERT INTO segments (job, name, solver_version, intervals, motion) \
                 SELECT 3, 'next', 'v', 1, motion FROM segments WHERE sequence = 9",
            )
            .execute(&mut *transaction)
            .await
            .expect("stored");
            transaction.commit().await.expect("committed");
        }
    });
}

#[test]
fn only_an_empty_database_is_copied_to_and_a_failed_copy_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some([file, server]) = addresses(&folder) else {
        return;
    };
    runtime().block_on(async {
        let [source, target] = [open(&file).await, open(&server).await];
        fill(&source).await;
        let mut transaction = target.begin().await.expect("begun");
        sql("ALTER TABLE legs ADD CONSTRAINT short CHECK (duration_s < 1)")
            .execute(&mut *transaction)
            .await
            .expect("altered");
        transaction.commit().await.expect("committed");
        let failed = copy(&source, &target).await;
        assert!(matches!(failed, Err(StoreError::Database(_))), "{failed:?}");
        assert!(contents(&target).await.values().all(Vec::is_empty));
        queue(&target).await;
        let refused = copy(&source, &target).await;
        let is_told = matches!(
            refused,
            Err(StoreError::NotEmpty {
                table: "jobs",
                rows: 1
            })
        );
        assert!(is_told, "{refused:?}");
        let refused = copy(&target, &source).await;
        assert!(
            matches!(refused, Err(StoreError::NotEmpty { .. })),
            "{refused:?}"
        );
    });
}

/// A job whose process is gone goes on in the copy.
#[test]
fn a_running_job_is_taken_over_in_the_copy() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some([file, server]) = addresses(&folder) else {
        return;
    };
    runtime().block_on(async {
        let [source, target] = [open(&file).await, open(&server).await];
        queue(&source).await;
        let leased = source.lease("gone", 1_000, MemoryRoom::ALL, 2).await;
        assert!(leased.expect("leased").is_some());
        copy(&source, &target).await.expect("copied");
        let others = crate::store::OtherProcesses::MayLive;
        let recovered = target
            .recover("next", others, 1_001)
            .await
            .expect("recovered");
        assert_eq!(recovered.queued, 1);
        let again = target.lease("next", 2_000, MemoryRoom::ALL, 3).await;
        assert_eq!(again.expect("leased").expect("a job").job.attempt, 2);
        let limits = QueueLimits { all: 9, client: 9 };
        let other = Submission {
            id: "00000000-0000-7000-8000-000000000001".into(),
            ..submission()
        };
        target.submit(&other, limits, 1).await.expect("queued");
    });
}

#[test]
fn every_table_of_the_schema_is_in_the_list() {
    super::on_a_store(|store| async move {
        let tables = match &store.database {
            Database::Sqlite(_) => {
                "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite~_%' ESCAPE '~'"
            }
            Database::Postgres(_) => {
                "SELECT CAST(table_name AS text) FROM information_schema.tables \
                 WHERE table_schema = current_schema()"
            }
        };
        let tables: Vec<(String,)> = sql(tables)
            .fetch_all(&store.database)
            .await
            .expect("tables");
        let mut tables: Vec<String> = tables.into_iter().map(|(name,)| name).collect();
        tables.retain(|name| name != "_sqlx_migrations");
        tables.sort();
        let mut listed = TABLES.each_ref().map(|table| table.name);
        listed.sort_unstable();
        assert_eq!(tables, listed);
    });
}
