//! Limits on queued jobs.

use super::{lease, on_a_store, submission};
use crate::store::{MemoryRoom, QueueLimits, Store, Submission, Submitted};

/// Submits a job with an identifier of this number.
async fn submit(store: &Store, number: u8, client: &str, limits: QueueLimits) -> Submitted {
    let job = Submission {
        id: format!("00000000-0000-7000-8000-0000000000{number:02}"),
        client: Some(client.into()),
        ..submission()
    };
    store.submit(&job, limits, 1).await.expect("answered")
}

#[test]
fn the_queue_takes_exactly_as_many_jobs_as_allowed() {
    let limits = QueueLimits { all: 3, client: 9 };
    on_a_store(|store| async move {
        for number in 0..3 {
            let answer = submit(&store, number, "a", limits).await;
            assert!(matches!(answer, Submitted::New(_)), "{number}: {answer:?}");
        }
        for number in 3..5 {
            let answer = submit(&store, number, "b", limits).await;
            assert!(matches!(answer, Submitted::QueueFull), "{answer:?}");
        }
        // A running job does not count as queued.
        lease(&store, "worker").await;
        let answer = submit(&store, 5, "b", limits).await;
        assert!(matches!(answer, Submitted::New(_)), "{answer:?}");
        let answer = submit(&store, 6, "b", limits).await;
        assert!(matches!(answer, Submitted::QueueFull), "{answer:?}");
        assert_eq!(store.waiting().await.expect("counted"), 3);
    });
}

#[test]
fn a_queue_that_is_not_counted_far_from_its_limit_takes_no_more() {
    const LIMIT: u32 = 264;
    on_a_store(|store| async move {
        let limits = QueueLimits {
            all: LIMIT.into(),
            client: 9,
        };
        let mut taken = 0;
        for number in 0..LIMIT + 2 {
            let job = Submission {
                id: format!("00000000-0000-7000-8000-{number:012}"),
                client: None,
                ..submission()
            };
            let answer = store.submit(&job, limits, 1).await.expect("submitted");
            taken += u32::from(matches!(answer, Submitted::New(_)));
        }
        assert_eq!(taken, LIMIT);
        assert!(!store.has_room(limits.all).await.expect("counted"));
        assert!(store.has_room(limits.all + 1).await.expect("counted"));
    });
}

#[test]
fn a_client_at_its_limit_does_not_block_others() {
    let limits = QueueLimits { all: 9, client: 2 };
    on_a_store(|store| async move {
        for number in 0..2 {
            let answer = submit(&store, number, "a", limits).await;
            assert!(matches!(answer, Submitted::New(_)), "{number}: {answer:?}");
        }
        let answer = submit(&store, 2, "a", limits).await;
        assert!(matches!(answer, Submitted::QuotaExceeded), "{answer:?}");
        let answer = submit(&store, 3, "b", limits).await;
        assert!(matches!(answer, Submitted::New(_)), "{answer:?}");
    });
}

#[test]
fn a_queue_of_size_zero_takes_no_job() {
    on_a_store(|store| async move {
        let answer = submit(&store, 0, "a", QueueLimits { all: 0, client: 9 }).await;
        assert!(matches!(answer, Submitted::QueueFull), "{answer:?}");
        assert_eq!(store.waiting().await.expect("counted"), 0);
    });
}

/// Submits a job with a priority; nobody's without a client.
async fn queue(store: &Store, number: u8, client: Option<&str>, priority: i64) {
    let job = Submission {
        id: format!("00000000-0000-7000-8000-0000000000{number:02}"),
        client: client.map(Into::into),
        priority,
        ..submission()
    };
    let limits = QueueLimits {
        all: 99,
        client: 99,
    };
    let queued = store.submit(&job, limits, 1).await.expect("answered");
    assert!(matches!(queued, Submitted::New(_)), "{queued:?}");
}

/// The numbers of all queued jobs in the order in which they are leased.
async fn order(store: &Store) -> Vec<i64> {
    let mut order = Vec::new();
    while let Some(lease) = store
        .lease("worker", 1_000, MemoryRoom::ALL, 2)
        .await
        .expect("tried")
    {
        order.push(lease.job.sequence);
    }
    order
}

#[test]
fn jobs_of_one_client_are_leased_in_the_order_of_their_submission() {
    on_a_store(|store| async move {
        for number in 1..=4 {
            queue(&store, number, None, 0).await;
        }
        assert_eq!(order(&store).await, [1, 2, 3, 4]);
    });
}

#[test]
fn jobs_of_several_clients_alternate() {
    on_a_store(|store| async move {
        for number in 1..=4 {
            queue(&store, number, Some("many"), 0).await;
        }
        queue(&store, 5, Some("few"), 0).await;
        // One without a key is a client of its own.
        queue(&store, 6, None, 0).await;
        queue(&store, 7, Some("few"), 0).await;
        let first = lease(&store, "worker").await.job;
        assert_eq!(first.sequence, 1);
        // Whoever comes later does not wait behind the others' first ones of before.
        queue(&store, 8, Some("late"), 0).await;
        assert_eq!(order(&store).await, [5, 6, 8, 2, 7, 3, 4]);
    });
}

#[test]
fn greater_priorities_come_first() {
    on_a_store(|store| async move {
        for (number, priority) in [(1, 0), (2, -10), (3, 10), (4, 0), (5, 10)] {
            queue(&store, number, Some("a"), priority).await;
        }
        assert_eq!(order(&store).await, [3, 5, 1, 4, 2]);
    });
}

#[test]
fn a_job_that_is_given_back_keeps_its_turn() {
    on_a_store(|store| async move {
        for number in 1..=3 {
            queue(&store, number, None, 0).await;
        }
        let first = lease(&store, "worker").await.job;
        assert!(store.release(&first, 3).await.expect("given back"));
        assert_eq!(order(&store).await, [1, 2, 3]);
    });
}

/// Queues jobs with numbers from 1, each with the time of its submission and the memory that it may
/// need.
async fn queue_sized(store: &Store, jobs: &[(i64, i64)]) {
    let limits = QueueLimits {
        all: 99,
        client: 99,
    };
    for (number, &(submitted_us, memory_bytes)) in (1_u8..).zip(jobs) {
        let job = Submission {
            id: format!("00000000-0000-7000-8000-0000000000{number:02}"),
            memory_bytes,
            ..submission()
        };
        let queued = store.submit(&job, limits, submitted_us).await;
        assert!(matches!(queued, Ok(Submitted::New(_))), "{queued:?}");
    }
}

#[test]
fn a_job_without_room_is_passed_over_until_it_has_waited_for_long() {
    on_a_store(|store| async move {
        queue_sized(&store, &[(10, 500), (11, 100), (12, 501), (13, 99)]).await;
        let leased = async |bytes, passed_over_since_us| {
            let room = MemoryRoom {
                bytes,
                passed_over_since_us,
            };
            let lease = store.lease("worker", 1_000, room, 20).await.expect("tried");
            lease.map(|lease| (lease.job.sequence, lease.memory_bytes))
        };
        assert_eq!(leased(99, 10).await, Some((4, 99)));
        // Now the first has waited for long, and nothing is begun before it.
        assert_eq!(leased(200, 11).await, None);
        assert_eq!(leased(500, 11).await, Some((1, 500)));
        assert_eq!(leased(i64::MAX, 0).await, Some((2, 100)));
        assert_eq!(leased(i64::MAX, 0).await, Some((3, 501)));
    });
}

/// Workers that ask at the same time get different jobs, and all of them.
#[test]
fn every_job_is_leased_once() {
    on_a_store(|store| async move {
        for number in 0..40 {
            queue(&store, number, Some(["a", "b"][usize::from(number % 2)]), 0).await;
        }
        let workers: Vec<_> = (0..4)
            .map(|_| {
                let store = store.clone();
                tokio::spawn(async move { order(&store).await })
            })
            .collect();
        let mut leased = Vec::new();
        for worker in workers {
            leased.extend(worker.await.expect("no panic"));
        }
        // Postgres passes over a job while another worker decides on it.
        leased.extend(order(&store).await);
        leased.sort_unstable();
        assert_eq!(leased, (1..=40).collect::<Vec<_>>());
    });
}
