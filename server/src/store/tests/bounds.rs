//! Limits on stored legs and versions of spacecraft.

use super::{change, on_a_store, sql, value};
use crate::store::spacecraft::KEPT_VERSIONS;
use crate::store::{LegFilter, NewLeg, Store};
use slewplan_solver::model::motion::Motion;
use slewplan_solver::tour::legs::{LegKind, StoredLeg};

fn leg(number: u8, spacecraft: &str) -> NewLeg {
    NewLeg {
        identity: format!("leg {number}"),
        leg: StoredLeg {
            spacecraft: spacecraft.to_owned(),
            kind: LegKind::RestToRest,
            turn_xyzw: [0.0, 0.0, 0.0, 1.0],
            body_momentum_nms: [0.0; 3],
            reversible: false,
            duration_s: number.into(),
            certified_lower_bound_s: None,
            solve_time_s: 0.1,
            status: "converged".into(),
            motion: Motion::default(),
        },
    }
}

/// The durations of all stored legs, s, and the number of spacecraft.
async fn stored(store: &Store) -> (Vec<f64>, i64) {
    let all = LegFilter {
        spacecraft: None,
        turn: None,
        after: None,
        limit: 100,
    };
    let legs = store.legs(&all).await.expect("read");
    let spacecraft = value(store, "SELECT count(*) FROM leg_spacecraft").await;
    (legs.iter().map(|leg| leg.duration_s).collect(), spacecraft)
}

/// Sets the solver version of a stored leg.
async fn set_version(store: &Store, identity: &str, version: &str) {
    let update = sql("UPDATE legs SET solver_version = $1 WHERE identity = $2");
    change(store, update.bind(version).bind(identity)).await;
}

#[test]
fn legs_of_other_versions_are_deleted_in_batches() {
    on_a_store(|store| async move {
        let legs = [leg(1, "a"), leg(2, "b"), leg(3, "b"), leg(4, "c")];
        store.put_legs(&legs, 1).await.expect("stored");
        set_version(&store, "leg 1", "0.0.0").await;
        set_version(&store, "leg 2", "0.0.0").await;
        set_version(&store, "leg 4", "9999").await;
        assert_eq!(
            store.delete_legs_of_other_versions(2).await.expect("tried"),
            2
        );
        assert_eq!(
            store.delete_legs_of_other_versions(2).await.expect("tried"),
            1
        );
        assert_eq!(
            store.delete_legs_of_other_versions(2).await.expect("tried"),
            0
        );
        assert_eq!(stored(&store).await, (vec![3.0], 1));
    });
}

/// The certified bound of the only stored leg, s, as it is listed and as it is found for a solve.
async fn certified(store: &Store, leg: &NewLeg) -> [Option<f64>; 2] {
    let all = LegFilter {
        spacecraft: None,
        turn: None,
        after: None,
        limit: 2,
    };
    let listed = store.legs(&all).await.expect("read");
    let [listed] = &listed[..] else {
        panic!("{listed:?}");
    };
    let found = store.known_legs(&["another", &leg.identity]).await;
    let [None, Some(found)] = &found.expect("read")[..] else {
        panic!("the leg is not there");
    };
    [
        listed.certified_lower_bound_s(),
        found.certified_lower_bound_s,
    ]
}

#[test]
fn certified_bounds_of_another_version_are_not_given_out_until_they_are_stored_again() {
    on_a_store(|store| async move {
        let mut bounded = leg(3, "a");
        bounded.leg.certified_lower_bound_s = Some(2.5);
        let legs = [bounded];
        assert_eq!(store.put_legs(&legs, 1).await.expect("stored"), 1);
        assert_eq!(certified(&store, &legs[0]).await, [Some(2.5); 2]);
        for other in ["bound_version - 1", "bound_version + 1", "NULL"] {
            let update = format!("UPDATE legs SET bound_version = {other}");
            change(&store, sql(sqlx::AssertSqlSafe(update))).await;
            assert_eq!(certified(&store, &legs[0]).await, [None; 2], "{other}");
            assert_eq!(store.put_legs(&legs, 2).await.expect("stored"), 1);
            assert_eq!(certified(&store, &legs[0]).await, [Some(2.5); 2]);
            assert_eq!(store.put_legs(&legs, 3).await.expect("stored"), 0);
        }
    });
}

#[test]
fn legs_are_found_by_their_rotation_within_the_tolerance() {
    on_a_store(|store| async move {
        let mut turned = leg(1, "a");
        turned.leg.turn_xyzw = [0.1_f64.sin(), 0.0, 0.0, 0.1_f64.cos()];
        store.put_legs(&[turned], 1).await.expect("stored");
        // It is 0.2 rad away.
        for (tolerance, count) in [(0.19, 0), (0.21, 1)] {
            let near = LegFilter {
                spacecraft: None,
                turn: Some(([0.0, 0.0, 0.0, 1.0], tolerance)),
                after: None,
                limit: 100,
            };
            assert_eq!(store.legs(&near).await.expect("read").len(), count);
        }
    });
}

#[test]
fn the_oldest_legs_are_deleted_first() {
    on_a_store(|store| async move {
        let legs = [leg(1, "a"), leg(2, "b"), leg(3, "a")];
        store.put_legs(&legs, 1).await.expect("stored");
        assert_eq!(store.delete_oldest_legs(1).await.expect("tried"), 1);
        assert_eq!(stored(&store).await, (vec![2.0, 3.0], 2));
        assert_eq!(store.delete_oldest_legs(9).await.expect("tried"), 2);
        assert_eq!(stored(&store).await, (vec![], 0));
        assert_eq!(store.put_legs(&legs, 2).await.expect("stored again"), 3);
    });
}

#[test]
fn only_the_newest_versions_of_a_spacecraft_are_kept() {
    on_a_store(|store| async move {
        let other = store.put_spacecraft("other", "{}", 1).await;
        assert_eq!(other.expect("stored").version, 1);
        for version in 1..=KEPT_VERSIONS + 2 {
            let document = format!("{{\"version\":{version}}}");
            let stored = store.put_spacecraft("sat", &document, 1).await;
            assert_eq!(stored.expect("stored").version, version);
        }
        for (version, there) in [(1, false), (2, false), (3, true), (KEPT_VERSIONS + 2, true)] {
            let found = store.spacecraft("sat", Some(version)).await;
            assert_eq!(found.expect("read").is_some(), there, "{version}");
        }
        let other = store.spacecraft("other", Some(1)).await;
        assert!(other.expect("read").is_some());
    });
}

#[test]
fn checking_writability_commits_a_write() {
    on_a_store(|store| async move {
        for now_us in [7, 9] {
            store.check_writable(now_us).await.expect("written");
            let query = sql("SELECT one, checked_us FROM readiness");
            let rows: Vec<(i64, i64)> = query.fetch_all(&store.database).await.expect("read");
            assert_eq!(rows, [(1, now_us)]);
        }
    });
}
