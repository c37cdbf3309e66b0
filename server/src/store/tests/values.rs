//! Plans of jobs whose targets have values: worth comes before time.

use super::*;

/// A report of a plan with its value, and a bound of values.
async fn report(store: &Store, lease: &JobRow, (seconds, worth): (f64, f64), value_bound: f64) {
    let progress = ProgressRow {
        stage: "search",
        done: 1,
        total: None,
        incumbent_s: Some(seconds),
        lower_bound_s: None,
        value: Some(worth),
        value_bound: Some(value_bound),
    };
    let plan = valued(seconds, worth);
    let written = store.progress(lease, &progress, Some(&plan), 3).await;
    assert!(written.expect("tried"));
}

fn valued(seconds: f64, worth: f64) -> NewIncumbent {
    NewIncumbent {
        value: Some(worth),
        ..plan(seconds)
    }
}

async fn known(store: &Store) -> (Option<f64>, Option<f64>, Option<f64>) {
    let job = job(store).await;
    (job.incumbent_s, job.value, job.value_bound)
}

async fn stored_s(store: &Store) -> Option<f64> {
    value(store, "SELECT total_time_s FROM incumbents").await
}

#[test]
fn a_plan_that_is_worth_more_replaces_a_shorter_one() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        report(&store, &lease, (20.0, 1.0), 5.0).await;
        report(&store, &lease, (40.0, 2.0), 4.0).await;
        assert_eq!(known(&store).await, (Some(40.0), Some(2.0), Some(4.0)));
        assert_eq!(stored_s(&store).await, Some(40.0));
        // Worth less, worth as much and longer, and a weaker bound change nothing.
        report(&store, &lease, (10.0, 1.5), 4.5).await;
        report(&store, &lease, (41.0, 2.0), 4.5).await;
        assert_eq!(known(&store).await, (Some(40.0), Some(2.0), Some(4.0)));
        report(&store, &lease, (39.0, 2.0), 3.0).await;
        assert_eq!(known(&store).await, (Some(39.0), Some(2.0), Some(3.0)));
        assert_eq!(stored_s(&store).await, Some(39.0));
    });
}

#[test]
fn the_better_plan_of_an_earlier_attempt_is_the_end() {
    for (seconds, worth, is_kept) in [(10.0, 1.0, true), (90.0, 3.0, false), (30.0, 2.0, false)] {
        on_a_store(|store| async move {
            submitted(&store).await;
            let lease = lease(&store, "first").await.job;
            report(&store, &lease, (40.0, 2.0), 4.0).await;
            let end = ended(JobState::Stopped, Some(valued(seconds, worth)));
            assert!(store.finish(&lease, &end, 4).await.expect("written"));
            let expected = if is_kept {
                (Some(40.0), Some(2.0), Some(4.0))
            } else {
                (Some(seconds), Some(worth), Some(4.0))
            };
            assert_eq!(known(&store).await, expected);
        });
    }
}
