//! Limits on queued jobs.

use super::{lease, on_a_store, submission};
use crate::store::{QueueLimits, Store, Submission, Submitted};

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
