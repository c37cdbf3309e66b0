//! Plans, bounds and codes at the end of a job.

use super::{
    ID, change, ended, improve, job, json, lease, on_a_store, plan, result, sql, submitted, value,
};
use crate::store::{
    EndCode, Ended, JobRow, JobState, OtherProcesses, PackedPlan, ProgressRow, Store,
};

const REASONS: &str = r#"{"status":"failed"}"#;

/// An end without a plan, with a document of the reasons.
fn failed() -> Ended {
    Ended {
        document: Some(PackedPlan::of(REASONS.as_bytes())),
        detail: Some("why".into()),
        code: Some(EndCode::Internal),
        early: false,
        ..ended(JobState::Failed, None)
    }
}

/// Records an incumbent and a lower bound.
async fn bounded(store: &Store, lease: &JobRow, incumbent_s: f64, lower_bound_s: f64) {
    let progress = ProgressRow {
        stage: "search",
        done: 1,
        total: None,
        incumbent_s: Some(incumbent_s),
        lower_bound_s: Some(lower_bound_s),
        value: None,
        value_bound: None,
    };
    let written = store.progress(lease, &progress, None, 3).await;
    assert!(written.expect("tried"));
}

async fn kept_plans(store: &Store) -> i64 {
    value(store, "SELECT count(*) FROM incumbents").await
}

/// Plans of more than 50 s violate a cone.
#[test]
fn the_end_says_whether_the_plan_violates_a_cone() {
    for (seconds, violated) in [(20.0, false), (60.0, true)] {
        on_a_store(|store| async move {
            submitted(&store).await;
            let first = lease(&store, "first").await.job;
            assert!(improve(&store, &first, seconds).await);
            assert_eq!(job(&store).await.keep_out_violated, None);
            // Cut short without a plan: that of before is the result.
            let end = ended(JobState::Failed, None);
            assert!(store.finish(&first, &end, 4).await.expect("written"));
            let job = job(&store).await;
            assert_eq!(job.state().expect("known"), JobState::Stopped);
            assert_eq!(job.keep_out_violated, Some(violated));
        });
        on_a_store(|store| async move {
            submitted(&store).await;
            let lease = lease(&store, "first").await.job;
            let end = ended(JobState::Succeeded, Some(plan(seconds)));
            assert!(store.finish(&lease, &end, 4).await.expect("written"));
            assert_eq!(job(&store).await.keep_out_violated, Some(violated));
        });
    }
}

#[test]
fn a_failure_keeps_the_best_plan() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        assert!(improve(&store, &lease, 20.0).await);
        let before = result(&store).await.1.expect("a plan");
        assert!(store.finish(&lease, &failed(), 4).await.expect("written"));
        let (state, kept) = result(&store).await;
        let kept = kept.expect("the plan is still there");
        assert_eq!((state, kept.is_final), (JobState::Failed, false));
        assert_eq!(kept.digest, before.digest);
        let job = job(&store).await;
        assert_eq!(job.incumbent_s, Some(20.0));
        assert_eq!(job.code.as_deref(), Some("internal_error"));
    });
}

#[test]
fn without_a_plan_the_document_of_reasons_is_the_result() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        assert!(store.finish(&lease, &failed(), 4).await.expect("written"));
        let (state, reasons) = result(&store).await;
        let reasons = reasons.expect("reasons");
        assert_eq!((state, reasons.is_final), (JobState::Failed, true));
        assert_eq!(reasons.document, REASONS);
    });
}

#[test]
fn the_bound_never_falls() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let first = lease(&store, "first").await.job;
        assert!(improve(&store, &first, 20.0).await);
        bounded(&store, &first, 20.0, 15.0).await;
        store
            .recover("second", OtherProcesses::Ended, 4)
            .await
            .expect("recovered");
        let second = lease(&store, "second").await.job;
        assert_eq!(second.lower_bound_s, Some(15.0));
        bounded(&store, &second, 30.0, 11.0).await;
        assert_eq!(job(&store).await.lower_bound_s, Some(15.0));
        // Its own bound is 10.
        let end = ended(JobState::Succeeded, Some(plan(18.0)));
        assert!(store.finish(&second, &end, 6).await.expect("written"));
        let job = job(&store).await;
        let known = (job.incumbent_s, job.lower_bound_s);
        assert_eq!(known, (Some(18.0), Some(15.0)));
    });
}

#[test]
fn another_attempt_does_not_begin_with_a_bound_of_another_version() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let first = lease(&store, "first").await.job;
        bounded(&store, &first, 20.0, 15.0).await;
        let other = sql("UPDATE jobs SET bound_version = bound_version - 1");
        change(&store, other).await;
        store
            .recover("second", OtherProcesses::Ended, 4)
            .await
            .expect("recovered");
        let second = lease(&store, "second").await.job;
        assert_eq!(second.lower_bound_s, None);
        bounded(&store, &second, 20.0, 11.0).await;
        store
            .recover("third", OtherProcesses::Ended, 5)
            .await
            .expect("recovered");
        let third = lease(&store, "third").await.job;
        assert_eq!(third.lower_bound_s, Some(11.0));
    });
}

#[test]
fn the_bound_never_exceeds_the_plan() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        bounded(&store, &lease, 20.0, 21.0).await;
        assert_eq!(job(&store).await.lower_bound_s, Some(20.0));
        let end = ended(JobState::Stopped, Some(plan(12.0)));
        assert!(store.finish(&lease, &end, 4).await.expect("written"));
        assert_eq!(job(&store).await.lower_bound_s, Some(12.0));
    });
}

#[test]
fn a_job_without_a_bound_ends_without_one() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let lease = lease(&store, "first").await.job;
        assert!(store.finish(&lease, &failed(), 4).await.expect("written"));
        let job = job(&store).await;
        assert_eq!((job.incumbent_s, job.lower_bound_s), (None, None));
    });
}

#[test]
fn a_dead_job_keeps_its_plan_and_has_a_reason() {
    on_a_store(|store| async move {
        submitted(&store).await;
        for (boot, next) in [("a", "b"), ("b", "c"), ("c", "d")] {
            let lease = lease(&store, boot).await.job;
            assert!(improve(&store, &lease, 20.0).await);
            store
                .recover(next, OtherProcesses::Ended, 4)
                .await
                .expect("recovered");
        }
        let (state, kept) = result(&store).await;
        assert_eq!(state, JobState::Dead);
        assert_eq!(kept.expect("a plan").document, json(20.0));
        let code = job(&store).await.code;
        assert_eq!(code.as_deref(), Some("process_died"));
        let events = store.events_after(1, 0).await.expect("read");
        let last = events.last().expect("an event");
        assert!(last.data.contains("\"code\":\"process_died\""), "{last:?}");
    });
}

#[test]
fn cancelling_deletes_the_incumbent() {
    on_a_store(|store| async move {
        submitted(&store).await;
        let first = lease(&store, "first").await.job;
        assert!(improve(&store, &first, 20.0).await);
        assert!(store.release(&first, 4).await.expect("released"));
        assert_eq!(kept_plans(&store).await, 1);
        store.request_cancel(ID, 5).await.expect("cancelled");
        assert_eq!(kept_plans(&store).await, 0);
        assert!(store.delete(ID).await.expect("deleted"));

        submitted(&store).await;
        let running = lease(&store, "first").await.job;
        assert!(improve(&store, &running, 20.0).await);
        store.request_cancel(ID, 6).await.expect("noted");
        // The process ends before its worker has noticed.
        store
            .recover("second", OtherProcesses::Ended, 7)
            .await
            .expect("recovered");
        assert_eq!(kept_plans(&store).await, 0);
        assert_eq!(job(&store).await.code, None);
    });
}
