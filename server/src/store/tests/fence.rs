//! A worker with a stale lease writes nothing.

use super::{ID, ended, improve, lease, on_a_store, plan, sql, submitted};
use crate::store::{JobRow, JobState, OtherProcesses, SegmentRow, Store};

/// What is written of the job in all tables, as text.
async fn record(store: &Store) -> Vec<String> {
    let mut found = Vec::new();
    for (columns, table) in [
        (
            &[
                "state",
                "attempt",
                "fence",
                "boot_id",
                "lease_until_us",
                "started_us",
                "finished_us",
                "stage",
                "done",
                "total",
                "incumbent_s",
                "lower_bound_s",
                "detail",
            ][..],
            "jobs",
        ),
        (&["id", "kind", "data"], "events"),
        (&["total_time_s", "digest"], "incumbents"),
        (&["digest"], "results"),
        (&["name", "motion"], "segments"),
    ] {
        for column in columns {
            let texts = format!("SELECT CAST({column} AS text) FROM {table} ORDER BY 1");
            let texts: Vec<(Option<String>,)> = sql(sqlx::AssertSqlSafe(texts))
                .fetch_all(&store.database)
                .await
                .expect("read");
            found.extend(
                texts
                    .into_iter()
                    .map(|(text,)| format!("{column} {text:?}")),
            );
        }
    }
    found
}

fn segment(content: u8) -> [SegmentRow; 1] {
    [SegmentRow {
        name: "piece 1 2 3".into(),
        intervals: 2,
        motion: vec![content; 24],
    }]
}

/// Which writes of a lease succeed, other than those that end it.
async fn writes(store: &Store, lease: &JobRow, content: u8) -> [bool; 3] {
    [
        store.prolong(lease, 9_000).await.expect("tried"),
        improve(store, lease, f64::from(content)).await,
        store
            .put_segments(lease, &segment(content))
            .await
            .expect("tried"),
    ]
}

/// Which writes that end a lease succeed.
async fn endings(store: &Store, lease: &JobRow, state: JobState) -> [bool; 2] {
    let end = ended(state, Some(plan(20.0)));
    [
        store.finish(lease, &end, 6).await.expect("tried"),
        store.release(lease, 7).await.expect("tried"),
    ]
}

/// Asserts that every write of a stale lease is refused and changes no row.
async fn assert_refused(store: &Store, stale: &JobRow) {
    let before = record(store).await;
    assert_eq!(writes(store, stale, 20).await, [false; 3]);
    for state in [JobState::Succeeded, JobState::Stopped, JobState::Failed] {
        assert_eq!(endings(store, stale, state).await, [false; 2]);
    }
    assert_eq!(record(store).await, before);
}

#[test]
fn a_stale_lease_is_refused_at_every_stage_of_its_successor() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let stale = lease(&store, "first").await.job;
        store
            .recover("second", OtherProcesses::Ended, 3)
            .await
            .expect("recovered");
        assert_refused(&store, &stale).await;
        let newest = lease(&store, "second").await.job;
        assert_eq!((newest.attempt, newest.fence), (2, stale.fence + 1));
        assert_refused(&store, &stale).await;
        assert_eq!(writes(&store, &newest, 30).await, [true; 3]);
        assert_refused(&store, &stale).await;
        let end = ended(JobState::Succeeded, Some(plan(30.0)));
        assert!(store.finish(&newest, &end, 8).await.expect("written"));
        assert_refused(&store, &stale).await;
        let job = store.job(ID).await.expect("read").expect("there");
        assert_eq!(
            (job.state().expect("known"), job.incumbent_s),
            (JobState::Succeeded, Some(30.0))
        );
    });
}

#[test]
fn a_released_lease_of_the_same_process_is_stale() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let stale = lease(&store, "only").await.job;
        assert!(store.release(&stale, 3).await.expect("given back"));
        let newest = lease(&store, "only").await.job;
        // The released attempt does not count: the two leases differ in the fence only.
        assert_eq!((newest.attempt, newest.fence), (1, stale.fence + 1));
        assert_refused(&store, &stale).await;
        assert_eq!(writes(&store, &newest, 30).await, [true; 3]);
        assert_refused(&store, &stale).await;
    });
}
