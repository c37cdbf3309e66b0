//! What a worker may write that was taken for dead and comes back: nothing.

use super::{ID, ended, improve, lease, on_a_store, plan, submitted};
use crate::store::{JobRow, JobState, SegmentRow, Store};

/// Everything that is recorded of the job and what belongs to it, as text.
async fn record(store: &Store) -> Vec<String> {
    let mut found = Vec::new();
    for rows in [
        "SELECT json_array(state, attempt, fence, boot_id, lease_until_us, started_us, \
         finished_us, stage, done, total, incumbent_s, lower_bound_s, detail) FROM jobs",
        "SELECT json_array(id, kind, data) FROM events ORDER BY id",
        "SELECT json_array(total_time_s, hex(document)) FROM incumbents",
        "SELECT json_array(hex(document)) FROM results",
        "SELECT json_array(name, hex(motion)) FROM segments ORDER BY name",
    ] {
        let rows = sqlx::query_scalar::<_, String>(rows);
        found.extend(rows.fetch_all(&store.readers).await.expect("read"));
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

/// What of all that a worker writes was taken from a lease, other than its end.
async fn taken_midway(store: &Store, lease: &JobRow, content: u8) -> [bool; 3] {
    [
        store.beat(lease, 9_000).await.expect("tried"),
        improve(store, lease, f64::from(content)).await,
        store
            .put_segments(lease, &segment(content))
            .await
            .expect("tried"),
    ]
}

/// What of the ways to end a lease was taken.
async fn taken_at_the_end(store: &Store, lease: &JobRow, state: JobState) -> [bool; 2] {
    let end = ended(state, Some(plan(20.0)));
    [
        store.finish(lease, &end, 6).await.expect("tried"),
        store.release(lease, 7).await.expect("tried"),
    ]
}

/// Tries all that a stale worker could write; none of it may be taken or leave a trace.
async fn refused(store: &Store, stale: &JobRow) {
    let before = record(store).await;
    assert_eq!(taken_midway(store, stale, 20).await, [false; 3]);
    for state in [JobState::Succeeded, JobState::Stopped, JobState::Failed] {
        assert_eq!(taken_at_the_end(store, stale, state).await, [false; 2]);
    }
    assert_eq!(record(store).await, before);
}

#[test]
fn nothing_of_a_stale_claim_is_taken_at_any_stage_of_its_successor() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let stale = lease(&store, "first").await.job;
        store.recover("second", 3).await.expect("recovered");
        refused(&store, &stale).await;
        let newest = lease(&store, "second").await.job;
        assert_eq!((newest.attempt, newest.fence), (2, stale.fence + 1));
        refused(&store, &stale).await;
        assert_eq!(taken_midway(&store, &newest, 30).await, [true; 3]);
        refused(&store, &stale).await;
        let end = ended(JobState::Succeeded, Some(plan(30.0)));
        assert!(store.finish(&newest, &end, 8).await.expect("written"));
        refused(&store, &stale).await;
        let job = store.job(ID).await.expect("read").expect("there");
        assert_eq!(
            (job.state().expect("known"), job.incumbent_s),
            (JobState::Succeeded, Some(30.0))
        );
    });
}

#[test]
fn a_claim_of_the_same_process_is_stale_too_once_it_was_given_back() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let stale = lease(&store, "only").await.job;
        assert!(store.release(&stale, 3).await.expect("given back"));
        let newest = lease(&store, "only").await.job;
        // The attempt did not count: nothing but the fence tells the two apart.
        assert_eq!((newest.attempt, newest.fence), (1, stale.fence + 1));
        refused(&store, &stale).await;
        assert_eq!(taken_midway(&store, &newest, 30).await, [true; 3]);
        refused(&store, &stale).await;
    });
}
