//! Races of two processes that both hold a lease of the same job: the job has one result.
//!
//! `SLEWPLAN_RACES` sets the number of races.

use super::{ID, ended, event_states, json, lease, on_an_address, open, plan, result, submitted};
use crate::store::{JobState, Lease, MemoryRoom, OtherProcesses, Store};
use std::time::Duration;

const USUAL: u64 = 40;
/// Longest head start of one of the two, µs: about the time that the other needs.
const HEAD_START_US: u64 = 3_000;

/// Delay of a racer in a round, chosen so that over the rounds each of them comes first.
fn wait(round: u64, step: u64) -> Duration {
    Duration::from_micros(round * step % HEAD_START_US)
}

/// The job for the rescuer, unless it has ended. Postgres passes over a job while another
/// transaction looks whether it may end it.
async fn leased(rescuer: &Store) -> Option<Lease> {
    loop {
        let found = rescuer
            .lease("rescuer", 1_000, MemoryRoom::ALL, 6)
            .await
            .expect("tried");
        let job = rescuer.job(ID).await.expect("read").expect("there");
        if found.is_some() || job.finished_us.is_some() {
            return found;
        }
    }
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
        rescuer
            .recover("rescuer", OtherProcesses::Ended, 4)
            .await
            .expect("recovered");
        let Some(found) = leased(rescuer).await else {
            return false;
        };
        let end = ended(JobState::Succeeded, Some(plan(30.0)));
        rescuer.finish(&found.job, &end, 7).await.expect("tried")
    };
    tokio::join!(late, rescue)
}

/// Number of events of the end of the job.
async fn end_events(store: &Store) -> usize {
    let events = event_states(store).await;
    let goes_on = ["state queued", "state running"];
    events
        .iter()
        .filter(|event| event.starts_with("state") && !goes_on.contains(&event.as_str()))
        .count()
}

#[test]
fn a_job_that_two_workers_end_has_one_end() {
    let rounds =
        std::env::var("SLEWPLAN_RACES").map_or(USUAL, |text| text.parse().expect("a number"));
    on_an_address(async |address| {
        let (stale, rescuer) = (open(&address).await, open(&address).await);
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
