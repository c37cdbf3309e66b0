//! Parts of tables of legs in the queue.

use super::{
    Claim, Exchange, ID, JobState, Lease, MemoryRoom, OtherProcesses, QueueLimits, Store,
    Submission, ended, lease, on_a_store, plan, submission, submitted, value,
};
use crate::store::{JobEnd, Listing, NewShard, Submitted, Work};

fn shard(number: u8) -> NewShard {
    NewShard {
        id: format!("00000000-0000-7000-8000-0000000001{number:02}"),
        document: vec![number],
        legs: 32,
    }
}

/// The next job of a process, which is idle or not.
async fn next(store: &Store, takes_shards: bool) -> Option<Lease> {
    let claim = Claim {
        boot_id: "other",
        lease_until_us: 1_000,
        room: MemoryRoom::ALL,
        takes_shards,
        at_most: 1,
        begins_later: true,
    };
    let exchange = Exchange {
        claim: Some(claim),
        ..Exchange::default()
    };
    let exchanged = store.exchange(&exchange, 5).await.expect("exchanged");
    exchanged.leases.into_iter().next()
}

async fn offered(store: &Store) -> i64 {
    value(store, "SELECT count(*) FROM jobs WHERE parent IS NOT NULL").await
}

#[test]
fn parts_are_taken_by_idle_workers_after_all_other_jobs_and_seen_by_nobody() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let parent = lease(&store, "first").await.job;
        let parts = [shard(1), shard(2)];
        store.put_shards(&parent, &parts, 3).await.expect("offered");
        // The queue has room for one job.
        let limits = QueueLimits { all: 1, client: 1 };
        let job = Submission {
            id: "00000000-0000-7000-8000-000000000002".into(),
            priority: -10,
            ..submission()
        };
        let queued = store.submit(&job, limits, 4).await.expect("answered");
        assert!(matches!(queued, Submitted::New(_)), "{queued:?}");
        assert_eq!(store.waiting().await.expect("counted"), 1);
        for work in [Work::Plan, Work::LegTable] {
            let listing = Listing {
                work,
                limit: 9,
                ..Listing::default()
            };
            let listed = store.jobs(&listing).await.expect("listed").len();
            assert_eq!(listed, if work == Work::Plan { 2 } else { 0 });
        }
        assert!(store.job(&shard(1).id).await.expect("read").is_none());
        let first = next(&store, true).await.expect("a job");
        assert_eq!((first.job.parent, &*first.job.id), (None, &*job.id));
        assert!(next(&store, false).await.is_none());
        let taken = next(&store, true).await.expect("a part");
        assert_eq!(
            (taken.job.parent, taken.scenario),
            (Some(parent.sequence), vec![1])
        );
        assert!(taken.job.state().expect("a state") == JobState::Running);
        let found = store.sharded_job(parent.sequence).await.expect("read");
        let found = found.expect("the job is worked on");
        assert!(!found.is_table() && found.scenario == b"{}");
        store.end_shard(&taken.job).await.expect("deleted");
        assert_eq!(offered(&store).await, 1);
        // A lost lease deletes nothing.
        store.end_shard(&taken.job).await.expect("tried");
        assert_eq!(offered(&store).await, 1);
    });
}

#[test]
fn parts_are_replaced_by_the_next_table_and_deleted_with_the_end_of_their_job() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let parent = lease(&store, "first").await.job;
        store
            .put_shards(&parent, &[shard(1)], 3)
            .await
            .expect("offered");
        let lost = next(&store, true).await.expect("a part").job;
        store
            .put_shards(&parent, &[shard(2), shard(3)], 4)
            .await
            .expect("offered");
        assert_eq!(offered(&store).await, 2);
        assert!(!store.prolong(&lost, 9_000).await.expect("tried"));
        // A killed worker's part is queued again.
        let killed = next(&store, true).await.expect("a part").job;
        let recovered = store.recover("first", OtherProcesses::MayLive, 2_000).await;
        assert_eq!(recovered.expect("recovered").queued, 2);
        assert!(!store.prolong(&killed, 9_000).await.expect("tried"));
        // So was the job itself: whoever had it offers nothing any more.
        store
            .put_shards(&parent, &[shard(4)], 5)
            .await
            .expect("tried");
        assert_eq!(offered(&store).await, 0);
        let again = next(&store, true).await.expect("the job").job;
        assert_eq!(again.id, ID);
        store
            .put_shards(&again, &[shard(5)], 6)
            .await
            .expect("offered");
        assert_eq!(offered(&store).await, 1);
        let end = JobEnd {
            lease: again.clone(),
            begun: None,
            progress: None,
            ended: ended(JobState::Succeeded, Some(plan(20.0))),
            has_shards: true,
            at_us: 7,
        };
        let exchange = Exchange {
            ends: &[end],
            ..Exchange::default()
        };
        store.exchange(&exchange, 7).await.expect("ended");
        assert_eq!(offered(&store).await, 0);
        assert!(
            store
                .sharded_job(again.sequence)
                .await
                .expect("read")
                .is_none()
        );
    });
}
