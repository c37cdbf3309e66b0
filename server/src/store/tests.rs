//! Leases, incumbents, segments and events over several attempts, and failures of the disk.

mod bounds;
mod claims;
mod copy;
mod ends;
mod fence;
mod notices;
mod outage;
#[path = "../../../tests/postgres.rs"]
mod postgres;
mod queue;
mod races;
mod schema;
mod shards;
mod sqlite;
mod statements;
mod values;

use super::database::row::FromRow;
use super::database::statement::{Statement, sql};
use super::{
    Claim, DatabaseAddress, Ended, Exchange, JobEnd, JobRow, JobState, Lease, MemoryRoom,
    NewIncumbent, OtherProcesses, PackedPlan, ProgressRow, QueueLimits, ResultRow, SegmentRow,
    Store, StoreError, Submission, Submitted, Work,
};

const ID: &str = "00000000-0000-7000-8000-000000000000";

fn json(total_time_s: f64) -> String {
    format!("{{\"total_time_s\":{total_time_s}}}")
}

fn plan(total_time_s: f64) -> NewIncumbent {
    NewIncumbent {
        document: PackedPlan::of(json(total_time_s).as_bytes()),
        total_time_s,
        lower_bound_s: 10.0,
        value: None,
        // Some are, some are not.
        keep_out_violated: total_time_s > 50.0,
    }
}

/// Records progress with a plan; whether the lease still held.
async fn improve(store: &Store, lease: &JobRow, total_time_s: f64) -> bool {
    let progress = ProgressRow {
        stage: "search",
        done: 1,
        total: None,
        incumbent_s: Some(total_time_s),
        lower_bound_s: Some(10.0),
        value: None,
        value_bound: None,
    };
    let plan = plan(total_time_s);
    let written = store.progress(lease, &progress, Some(&plan), 3).await;
    written.expect("tried")
}

fn ended(state: JobState, plan: Option<NewIncumbent>) -> Ended {
    Ended {
        state,
        incumbent_s: plan.as_ref().map(|plan| plan.total_time_s),
        lower_bound_s: plan.as_ref().map(|plan| plan.lower_bound_s),
        value: plan.as_ref().and_then(|plan| plan.value),
        value_bound: None,
        keep_out_violated: plan.as_ref().map(|plan| plan.keep_out_violated),
        document: plan.map(|plan| plan.document),
        detail: None,
        code: None,
        early: true,
    }
}

fn submission() -> Submission {
    Submission {
        work: Work::Plan,
        id: ID.into(),
        name: None,
        scenario: b"{}".into(),
        targets: 1,
        memory_bytes: 0,
        client: None,
        priority: 0,
        key: None,
    }
}

async fn submitted(store: &Store) {
    let limits = QueueLimits { all: 1, client: 1 };
    let queued = store
        .submit(&submission(), limits, 1)
        .await
        .expect("stored");
    assert!(matches!(queued, Submitted::New(_)));
}

impl Store {
    /// Claims the next job, and stores its begin.
    async fn lease(
        &self,
        boot_id: &str,
        lease_until_us: i64,
        room: MemoryRoom,
        now_us: i64,
    ) -> Result<Option<Lease>, StoreError> {
        let claim = Claim {
            boot_id,
            lease_until_us,
            room,
            takes_shards: true,
            at_most: 1,
            begins_later: false,
        };
        let exchange = Exchange {
            claim: Some(claim),
            ..Exchange::default()
        };
        let mut leases = self.exchange(&exchange, now_us).await?.leases;
        Ok(leases.pop())
    }

    /// Stores the end of a job; whether its lease was held.
    async fn finish(&self, lease: &JobRow, ended: &Ended, now_us: i64) -> Result<bool, StoreError> {
        let end = JobEnd {
            lease: lease.clone(),
            begun: None,
            progress: None,
            ended: ended.clone(),
            has_shards: false,
            at_us: now_us,
        };
        let exchange = Exchange {
            ends: &[end],
            ..Exchange::default()
        };
        let done = self.exchange(&exchange, now_us).await?;
        Ok(done.lost_ends.is_empty())
    }
}

async fn lease(store: &Store, boot_id: &str) -> Lease {
    let lease = store
        .lease(boot_id, 1_000, MemoryRoom::ALL, 2)
        .await
        .expect("leased");
    lease.expect("a job waits")
}

async fn result(store: &Store) -> (JobState, Option<ResultRow>) {
    let found = store.result(ID).await.expect("read");
    found.expect("the job is there")
}

/// An event with the state of the job and why it ended.
fn state_of(job: &JobRow, _: i64) -> Result<String, StoreError> {
    let (state, detail, code) = (job.state()?.into_str(), &job.detail, &job.code);
    let event = serde_json::json!({ "state": state, "detail": detail, "code": code });
    Ok(event.to_string())
}

/// Runs a test on an empty database of SQLite, and on one of Postgres.
fn on_a_store<F: Future<Output = ()>>(test: impl Fn(Store) -> F) {
    on_an_address(async |address| test(open(&address).await).await);
}

/// Runs a test that opens an empty database by itself.
fn on_an_address(test: impl AsyncFn(DatabaseAddress)) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("store.db");
    let server = postgres::new_database();
    for address in [Some(file.into_os_string()), server.map(Into::into)] {
        let Some(address) = address else {
            println!("not on Postgres, which is not installed");
            continue;
        };
        println!("on {}", address.display());
        let address = address.try_into().expect("an address");
        runtime().block_on(test(address));
    }
}

/// Runs a test of what only SQLite has.
fn on_sqlite<F: Future<Output = ()>>(test: impl FnOnce(Store) -> F) {
    let folder = tempfile::tempdir().expect("a folder");
    let address = DatabaseAddress::File(folder.path().join("store.db"));
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .expect("a runtime");
    runtime.block_on(async { test(open(&address).await).await });
}

fn runtime() -> tokio::runtime::Runtime {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build();
    runtime.expect("a runtime")
}

async fn open(address: &DatabaseAddress) -> Store {
    Store::open(address, state_of).await.expect("opened")
}

/// Changes rows beside the store.
async fn change(store: &Store, statement: Statement<'_>) {
    let mut transaction = store.begin().await.expect("begun");
    let changed = statement.execute(&mut *transaction).await.expect("valid");
    assert!(changed > 0);
    transaction.commit().await.expect("changed");
}

async fn job(store: &Store) -> JobRow {
    let found = store.job(ID).await.expect("read");
    found.expect("the job is there")
}

/// The only value of a query.
async fn value<T>(store: &Store, query: &'static str) -> T
where
    (T,): FromRow,
{
    let (value,) = sql(query).fetch_one(&store.database).await.expect("read");
    value
}

#[test]
fn a_lost_lease_stores_no_plan_and_ends_no_job() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lost = lease(&store, "first").await.job;
        store
            .recover("second", OtherProcesses::Ended, 3)
            .await
            .expect("recovered");
        let newest = lease(&store, "second").await.job;
        assert!(!improve(&store, &lost, 20.0).await);
        assert!(result(&store).await.1.is_none());
        assert!(improve(&store, &newest, 30.0).await);
        let end = ended(JobState::Stopped, Some(plan(20.0)));
        assert!(!store.finish(&lost, &end, 6).await.expect("tried"));
        let (state, kept) = result(&store).await;
        let kept = kept.expect("a plan");
        assert_eq!((state, kept.is_final), (JobState::Running, false));
        assert_eq!(kept.document, json(30.0));
    });
}

/// Kind and state of each event.
async fn event_states(store: &Store) -> Vec<String> {
    let events: Vec<(String, String)> = sql("SELECT kind, data FROM events ORDER BY id")
        .fetch_all(&store.database)
        .await
        .expect("read");
    let state = |(kind, data): (String, String)| {
        let event: serde_json::Value = serde_json::from_str(&data).expect("JSON");
        format!("{kind} {}", event["state"].as_str().expect("a state"))
    };
    events.into_iter().map(state).collect()
}

#[test]
fn every_change_of_state_has_an_event() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lost = lease(&store, "first").await.job;
        let recovered = store
            .recover("second", OtherProcesses::Ended, 3)
            .await
            .expect("recovered");
        assert_eq!((recovered.queued, recovered.cancelled), (1, 0));
        lease(&store, "second").await;
        store.request_cancel(ID, 5).await.expect("cancelled");
        let recovered = store
            .recover("third", OtherProcesses::Ended, 6)
            .await
            .expect("recovered");
        assert_eq!((recovered.queued, recovered.cancelled), (0, 1));
        assert!(!store.prolong(&lost, 9).await.expect("tried"));
        let expected = ["queued", "running", "queued", "running", "cancelled"];
        assert_eq!(
            event_states(&store).await,
            expected.map(|state| format!("state {state}"))
        );
    });
}

#[test]
fn cancelling_a_queued_job_has_an_event() {
    on_a_store(|store| async move {
        submitted(&store).await;
        store.request_cancel(ID, 5).await.expect("cancelled");
        assert_eq!(
            event_states(&store).await,
            ["state queued", "state cancelled"]
        );
    });
}

#[test]
fn prolonging_a_lease_is_stored() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        assert!(store.prolong(&lease, 9_000).await.expect("tried"));
        let lease: i64 = value(&store, "SELECT lease_until_us FROM jobs").await;
        assert_eq!(lease, 9_000);
        let sizes = store.sizes().await.expect("measured");
        assert!(sizes.iter().all(|(_, bytes)| *bytes > 0));
    });
}

#[test]
fn the_best_plan_of_all_attempts_is_the_result_of_an_interrupted_search() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let first = lease(&store, "first").await.job;
        for total in [30.0, 20.0] {
            assert!(improve(&store, &first, total).await);
        }
        store
            .recover("second", OtherProcesses::Ended, 4)
            .await
            .expect("recovered");
        let second = lease(&store, "second").await.job;
        assert_eq!((second.attempt, second.incumbent_s), (2, Some(20.0)));
        assert!(improve(&store, &second, 30.0).await);
        let (state, kept) = result(&store).await;
        let kept = kept.expect("a plan");
        assert_eq!((state, kept.is_final), (JobState::Running, false));
        assert_eq!(kept.document, json(20.0));
        // Stopped before it had any plan of its own.
        let end = ended(JobState::Failed, None);
        assert!(store.finish(&second, &end, 6).await.expect("written"));
        let (state, last) = result(&store).await;
        let last = last.expect("a plan");
        assert_eq!((state, last.is_final), (JobState::Stopped, true));
        assert_eq!(last.document, json(20.0));
    });
}

#[test]
fn a_cancelled_job_has_no_plan() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let first = lease(&store, "first").await.job;
        assert!(improve(&store, &first, 20.0).await);
        store.request_cancel(ID, 4).await.expect("noted");
        store
            .recover("second", OtherProcesses::Ended, 5)
            .await
            .expect("recovered");
        let (state, none) = result(&store).await;
        assert_eq!(state, JobState::Cancelled);
        assert!(none.is_none());
    });
}

#[test]
fn segments_are_kept_for_the_next_attempt_and_deleted_after_the_job() {
    on_a_store(|store| async move {
        let segment = SegmentRow {
            name: "piece 1 2 3".into(),
            intervals: 2,
            motion: vec![7; 24],
        };
        submitted(&store).await;
        let lost = lease(&store, "first").await.job;
        let older = SegmentRow {
            motion: vec![6; 24],
            ..segment.clone()
        };
        // Of two of one name in a batch the last one counts.
        let both = [older, segment.clone()];
        assert!(store.put_segments(&lost, &both).await.expect("written"));
        let kept = [segment.clone()];
        store
            .recover("second", OtherProcesses::Ended, 3)
            .await
            .expect("recovered");
        let second = lease(&store, "second").await.job;
        let late = [SegmentRow {
            motion: vec![8; 24],
            ..segment.clone()
        }];
        assert!(!store.put_segments(&lost, &late).await.expect("tried"));
        let found = store.segments(second.sequence).await;
        assert_eq!(found.expect("read"), kept);
        let other = store.segments(second.sequence + 1).await;
        assert_eq!(other.expect("read"), []);
        assert_eq!(
            store.delete_segments_of_ended_jobs(9).await.expect("tried"),
            0
        );
        let end = ended(JobState::Stopped, Some(plan(20.0)));
        assert!(store.finish(&second, &end, 4).await.expect("written"));
        assert_eq!(
            store.delete_segments_of_ended_jobs(9).await.expect("done"),
            1
        );
        let left = store.segments(second.sequence).await;
        assert_eq!(left.expect("read"), []);
    });
}

#[test]
fn a_damaged_plan_is_detected_and_not_returned() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        let end = ended(JobState::Stopped, Some(plan(20.0)));
        assert!(store.finish(&lease, &end, 3).await.expect("written"));
        let damage = sql("UPDATE results SET document = $1").bind(&b"{}"[..]);
        change(&store, damage).await;
        let error = store.result(ID).await.expect_err("it was changed");
        assert!(matches!(error, StoreError::Damaged { .. }), "{error}");
    });
}

#[test]
fn only_jobs_that_ended_before_the_given_time_are_deleted() {
    on_a_store(|store| async move {
        submitted(&store).await;
        assert_eq!(store.delete_ended_jobs(100, 9).await.expect("tried"), 0);
        let lease = lease(&store, "first").await.job;
        let end = ended(JobState::Stopped, Some(plan(20.0)));
        assert!(store.finish(&lease, &end, 50).await.expect("written"));
        assert_eq!(store.delete_ended_jobs(50, 9).await.expect("tried"), 0);
        assert_eq!(store.delete_ended_jobs(51, 9).await.expect("done"), 1);
        assert!(store.result(ID).await.expect("read").is_none());
    });
}
