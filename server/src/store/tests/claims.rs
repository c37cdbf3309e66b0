//! Claims ahead, begins that are stored later, and exchanges of many jobs.

use super::{
    Claim, Exchange, JobEnd, JobRow, JobState, Lease, MemoryRoom, OtherProcesses, QueueLimits,
    Store, Submission, Submitted, ended, on_a_store, plan, sql, submission,
};
use crate::store::{Exchanged, ProgressRow, Work};

/// Submits tiny jobs, and a job that is none of them after each number of `large`.
async fn queue(store: &Store, jobs: u8, large: &[u8]) {
    let limits = QueueLimits {
        all: 99,
        client: 99,
    };
    for number in 1..=jobs {
        let job = Submission {
            id: id(number),
            targets: if large.contains(&number) { 200 } else { 2 },
            ..submission()
        };
        let queued = store.submit(&job, limits, 1).await.expect("answered");
        assert!(matches!(queued, Submitted::New(_)), "{queued:?}");
    }
}

fn id(number: u8) -> String {
    format!("00000000-0000-7000-8000-0000000000{number:02}")
}

fn claim(at_most: usize) -> Claim<'static> {
    Claim {
        boot_id: "first",
        lease_until_us: 1_000,
        room: MemoryRoom::ALL,
        takes_shards: false,
        at_most,
        begins_later: true,
    }
}

async fn exchanged(store: &Store, exchange: Exchange<'_>) -> Exchanged {
    store.exchange(&exchange, 5).await.expect("exchanged")
}

async fn claimed(store: &Store, at_most: usize) -> Vec<Lease> {
    let claim = Some(claim(at_most));
    let asked = Exchange {
        claim,
        ..Exchange::default()
    };
    exchanged(store, asked).await.leases
}

fn numbers(leases: &[Lease]) -> Vec<i64> {
    leases.iter().map(|lease| lease.job.sequence).collect()
}

fn end(job: &JobRow, begun_us: Option<i64>) -> JobEnd {
    let progress = ProgressRow {
        stage: "verify",
        done: 1,
        total: None,
        incumbent_s: None,
        lower_bound_s: None,
        value: None,
        value_bound: None,
    };
    JobEnd {
        lease: job.clone(),
        begun: begun_us.map(|begun_us| job.begun(begun_us)),
        progress: Some(progress),
        ended: ended(JobState::Succeeded, Some(plan(20.0))),
        has_shards: false,
        at_us: 9,
    }
}

/// State, attempt, begin, end and stage of a job.
async fn job(
    store: &Store,
    number: u8,
) -> (JobState, i64, Option<i64>, Option<i64>, Option<String>) {
    let job = store.job(&id(number)).await.expect("read").expect("there");
    let state = job.state().expect("a state");
    (
        state,
        job.attempt,
        job.started_us,
        job.finished_us,
        job.stage,
    )
}

/// Kind and state of the events of a job.
async fn events(store: &Store, number: i64) -> Vec<(i64, String)> {
    let events = store.events_after(number, 0).await.expect("read");
    events
        .into_iter()
        .map(|event| (event.id, event.data))
        .collect()
}

#[test]
fn jobs_that_are_claimed_ahead_look_queued_until_they_begin() {
    on_a_store(|store| async move {
        queue(&store, 5, &[]).await;
        let leases = claimed(&store, 3).await;
        assert_eq!(numbers(&leases), [1, 2, 3]);
        for number in 1..=3 {
            assert_eq!(
                job(&store, number).await,
                (JobState::Queued, 0, None, None, None)
            );
        }
        assert_eq!(store.waiting().await.expect("counted"), 5);
        // Others get what is left.
        assert_eq!(numbers(&claimed(&store, 9).await), [4, 5]);
        assert!(claimed(&store, 9).await.is_empty());
        let begun = [leases[0].job.begun(6)];
        let told = exchanged(
            &store,
            Exchange {
                begun: &begun,
                returned: &[leases[1].job.clone()],
                ..Exchange::default()
            },
        )
        .await;
        assert!(told.lost_begins.is_empty());
        assert_eq!(
            job(&store, 1).await,
            (JobState::Running, 1, Some(6), None, None)
        );
        assert_eq!(events(&store, 1).await.len(), 2);
        // The returned one is the next, and may have ended its process: now it begins at once.
        let again = claimed(&store, 9).await;
        assert_eq!(numbers(&again), [2]);
        assert!(again[0].has_begun().expect("a state"));
    });
}

#[test]
fn ends_are_stored_together_with_begins_that_were_not() {
    on_a_store(|store| async move {
        queue(&store, 4, &[]).await;
        let leases = claimed(&store, 3).await;
        let ends: Vec<JobEnd> = (6..)
            .zip(&leases)
            .map(|(begun_us, lease)| end(&lease.job, Some(begun_us)))
            .collect();
        store.request_cancel(&id(2), 7).await.expect("cancelled");
        let told = exchanged(
            &store,
            Exchange {
                ends: &ends,
                claim: Some(claim(9)),
                ..Exchange::default()
            },
        )
        .await;
        assert_eq!(
            (told.lost_ends, numbers(&told.leases), told.waiting),
            (vec![2], vec![4], 0)
        );
        let stage = Some("verify".to_owned());
        assert_eq!(
            job(&store, 1).await,
            (JobState::Succeeded, 1, Some(6), Some(9), stage.clone())
        );
        assert_eq!(
            job(&store, 2).await,
            (JobState::Cancelled, 0, None, Some(7), None)
        );
        assert_eq!(
            job(&store, 3).await,
            (JobState::Succeeded, 1, Some(8), Some(9), stage)
        );
        for number in [1, 3] {
            let told = events(&store, number).await;
            let ids: Vec<i64> = told.iter().map(|(id, _)| *id).collect();
            assert_eq!(ids, [1, 2, 3]);
            for ((_, data), state) in told.iter().zip(["queued", "running", "succeeded"]) {
                assert!(data.contains(state), "{data}");
            }
            let (_, result) = store
                .result(&id(u8::try_from(number).expect("small")))
                .await
                .expect("read")
                .expect("there");
            assert!(result.expect("a plan").is_final);
        }
        // The same once more, as after an answer that was lost: nothing changes.
        let told = exchanged(
            &store,
            Exchange {
                ends: &ends,
                ..Exchange::default()
            },
        )
        .await;
        assert_eq!(told.lost_ends, [1, 2, 3]);
        assert_eq!(events(&store, 1).await.len(), 3);
    });
}

#[test]
fn an_attempt_counts_once_however_its_begin_was_stored() {
    on_a_store(|store| async move {
        queue(&store, 1, &[]).await;
        let leases = claimed(&store, 1).await;
        let begun = [leases[0].job.begun(6)];
        let told = Exchange {
            begun: &begun,
            ..Exchange::default()
        };
        exchanged(&store, told).await;
        // Whoever stored it did not hear of it.
        let ends = [end(&leases[0].job, Some(6))];
        let told = Exchange {
            ends: &ends,
            ..Exchange::default()
        };
        assert!(exchanged(&store, told).await.lost_ends.is_empty());
        let (state, attempt, ..) = job(&store, 1).await;
        assert_eq!((state, attempt), (JobState::Succeeded, 1));
    });
}

#[test]
fn only_tiny_jobs_are_claimed_ahead_and_in_their_turn() {
    on_a_store(|store| async move {
        queue(&store, 5, &[3]).await;
        assert_eq!(numbers(&claimed(&store, 9).await), [1, 2]);
        let alone = claimed(&store, 9).await;
        assert_eq!(numbers(&alone), [3]);
        assert!(alone[0].has_begun().expect("a state"));
        assert_eq!(numbers(&claimed(&store, 9).await), [4, 5]);
    });
}

#[test]
fn claims_of_a_dead_process_are_free_again_and_count_no_attempt() {
    for others in [OtherProcesses::Ended, OtherProcesses::MayLive] {
        on_a_store(|store| async move {
            queue(&store, 2, &[]).await;
            let lost = claimed(&store, 2).await;
            let early = store.recover("second", OtherProcesses::MayLive, 999).await;
            assert!(early.expect("tried").is_empty());
            let recovered = store.recover("second", others, 1_001).await;
            assert_eq!(recovered.expect("recovered").unclaimed, 2);
            let ends = [end(&lost[0].job, Some(6))];
            let late = Exchange {
                ends: &ends,
                ..Exchange::default()
            };
            assert_eq!(exchanged(&store, late).await.lost_ends, [1]);
            // One of them may have ended the process: they begin alone, and count.
            let next = claimed(&store, 9).await;
            assert_eq!(numbers(&next), [1]);
            assert_eq!((next[0].job.attempt, next[0].job.fence), (1, 2));
        });
    }
}

#[test]
fn a_table_of_legs_is_never_claimed_ahead() {
    on_a_store(|store| async move {
        queue(&store, 1, &[]).await;
        let limits = QueueLimits {
            all: 99,
            client: 99,
        };
        let table = Submission {
            id: id(2),
            work: Work::LegTable,
            ..submission()
        };
        store.submit(&table, limits, 1).await.expect("answered");
        assert_eq!(numbers(&claimed(&store, 9).await), [1]);
        assert!(claimed(&store, 9).await[0].has_begun().expect("a state"));
    });
}

#[test]
fn a_claim_that_is_kept_is_prolonged() {
    on_a_store(|store| async move {
        queue(&store, 1, &[]).await;
        let leases = claimed(&store, 1).await;
        assert!(store.prolong(&leases[0].job, 9_000).await.expect("tried"));
        let (until,): (i64,) = sql("SELECT claimed_until_us FROM jobs")
            .fetch_one(&store.database)
            .await
            .expect("read");
        assert_eq!(until, 9_000);
    });
}
