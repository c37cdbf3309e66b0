//! Races of two processes that both hold a lease of the same job: the job has one result.
//!
//! `SLEWPLAN_RACES` sets the number of races.

use super::{ID, ended, json, lease, plan, result, state_of, submitted};
use crate::store::{JobState, Store};
use std::time::Duration;

const USUAL: u64 = 40;
/// Longest head start of one of the two, µs: about the time that the other needs.
const HEAD_START_US: u64 = 3_000;

/// Delay of a racer in a round, chosen so that over the rounds each of them comes first.
fn wait(round: u64, step: u64) -> Duration {
    Duration::from_micros(round * step % HEAD_START_US)
}

/// A stale worker ends the job while another process recovers and ends it. Whether the stale end
/// was recorded, and whether the other was.
async fn race(stale: &Store, rescuer: &Store, round: u64) -> (bool, bool) {
    submitted(stale).await;
    let lost = lease(stale, "stale").await.job;
    let late = async {
        tokio::time::sleep(wait(round, 769)).await;
        let end = ended(JobState::Stopped, Some(plan(20.0)));
        stale.finish(&lost, &end, 5).await.expect("tried")
    };
    let rescue = async {
        tokio::time::sleep(wait(round, 1_013)).await;
        rescuer.recover("rescuer", 4).await.expect("recovered");
        let found = rescuer.lease("rescuer", 1_000, 6).await.expect("tried");
        let Some(found) = found else { return false };
        let end = ended(JobState::Succeeded, Some(plan(30.0)));
        rescuer.finish(&found.job, &end, 7).await.expect("tried")
    };
    tokio::join!(late, rescue)
}

/// Number of events of the end of the job.
async fn end_events(store: &Store) -> i64 {
    let count = "SELECT count(*) FROM events WHERE kind = 'state' AND \
         json_extract(data, '$.state') NOT IN ('queued', 'running')";
    let count = sqlx::query_scalar(count).fetch_one(&store.readers).await;
    count.expect("counted")
}

#[test]
fn a_job_that_two_workers_end_has_one_end() {
    let rounds =
        std::env::var("SLEWPLAN_RACES").map_or(USUAL, |text| text.parse().expect("a number"));
    let folder = tempfile::tempdir().expect("a folder");
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    runtime.block_on(async {
        let path = folder.path().join("races.db");
        let stale = Store::open(&path, state_of).await.expect("opened");
        let rescuer = Store::open(&path, state_of)
            .await
            .expect("opened by another");
        let mut rescued = 0;
        for round in 0..rounds {
            let (by_stale, by_rescuer) = race(&stale, &rescuer, round).await;
            assert!(
                by_stale ^ by_rescuer,
                "{by_stale} {by_rescuer} in round {round}"
            );
            rescued += u64::from(by_rescuer);
            let (state, kept) = result(&rescuer).await;
            let kept = kept.expect("a plan");
            let expected = if by_rescuer {
                (JobState::Succeeded, 30.0)
            } else {
                (JobState::Stopped, 20.0)
            };
            assert_eq!(
                (state, kept.document),
                (expected.0, json(expected.1).into())
            );
            assert_eq!(end_events(&rescuer).await, 1);
            assert!(rescuer.delete(ID).await.expect("deleted"));
        }
        println!("{rounds} races, {rescued} won by the rescuer");
    });
}
