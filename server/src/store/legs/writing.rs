//! Legs are stored many in a statement.

use super::{NewLeg, SOLVER_VERSION, key};
use crate::store::database::Turn;
use crate::store::database::statement::{Value, sql};
use crate::store::writing::WriteTransaction;
use crate::store::{Store, StoreError};
use slewplan_solver::bounds;
use std::collections::{BTreeMap, HashMap};

/// Maximum number of legs of one statement.
const BATCH: usize = 64;

impl Store {
    /// Stores legs, all of them or none. Returns how many were not stored by this version with bounds
    /// of this version before.
    pub(crate) async fn put_legs(&self, legs: &[NewLeg], now_us: i64) -> Result<u64, StoreError> {
        let mut transaction = self.begin().await?;
        let new = put_legs(&mut transaction, legs, now_us).await?;
        transaction.commit().await?;
        Ok(new)
    }
}

/// Stores legs with the rest of a transaction. Returns how many were not stored by this version with
/// bounds of this version before.
pub(in crate::store) async fn put_legs(
    transaction: &mut WriteTransaction,
    legs: &[NewLeg],
    now_us: i64,
) -> Result<u64, StoreError> {
    if legs.is_empty() {
        return Ok(0);
    }
    transaction.take_turn(Turn::Legs).await?;
    let keys: Vec<String> = legs.iter().map(|leg| key(&leg.identity)).collect();
    // A statement must not store a leg twice; of two the last one counts.
    let last: HashMap<_, _> = keys.iter().enumerate().map(|(i, key)| (key, i)).collect();
    let different: Vec<_> = keys
        .iter()
        .zip(legs)
        .enumerate()
        .filter(|(i, (key, _))| last.get(key) == Some(i))
        .map(|(_, leg)| leg)
        .collect();
    let mut new = 0;
    for batch in different.chunks(BATCH) {
        new += put_batch(transaction, batch, now_us).await?;
    }
    Ok(new)
}

async fn put_batch(
    transaction: &mut WriteTransaction,
    legs: &[(&String, &NewLeg)],
    now_us: i64,
) -> Result<u64, StoreError> {
    let spacecraft: BTreeMap<String, &str> = legs
        .iter()
        .map(|(_, new)| (key(&new.leg.spacecraft), &*new.leg.spacecraft))
        .collect();
    let described = spacecraft.into_iter();
    sql("INSERT INTO leg_spacecraft (key, document) \
         SELECT new_key, new_document FROM {rows $1 new_key text, new_document text} AS new \
         WHERE true ON CONFLICT DO NOTHING")
    .rows(
        described
            .map(|(key, document)| [key.into(), document.into()])
            .collect(),
    )
    .execute(&mut **transaction)
    .await?;
    let motions = legs
        .iter()
        .map(|(_, new)| serde_json::to_vec(&new.leg.motion));
    let motions: Vec<Vec<u8>> =
        motions
            .collect::<Result<_, _>>()
            .map_err(|error| StoreError::Inconsistent {
                table: "legs",
                what: error.to_string(),
            })?;
    let rows = legs
        .iter()
        .zip(&motions)
        .map(|((key, new), motion)| row(key, new, motion));
    sql(
        "INSERT INTO legs (solver_version, bound_version, created_us, key, identity, spacecraft, kind, \
         turn_x, turn_y, turn_z, turn_w, momentum_x, momentum_y, momentum_z, reversible, duration_s, \
         certified_lower_bound_s, solve_time_s, status, trajectory) \
         SELECT CAST($1 AS text), CAST($2 AS bigint), CAST($3 AS bigint), new.* FROM \
         {rows $4 key text, identity text, spacecraft text, kind text, \
         x double precision, y double precision, z double precision, w double precision, \
         h_x double precision, h_y double precision, h_z double precision, \
         reversible boolean, duration_s double precision, certified double precision, \
         solve_time_s double precision, status text, trajectory {bytes}} AS new WHERE true \
         ON CONFLICT (key) DO UPDATE SET reversible = excluded.reversible, duration_s = excluded.duration_s, \
         certified_lower_bound_s = excluded.certified_lower_bound_s, \
         bound_version = excluded.bound_version, solve_time_s = excluded.solve_time_s, \
         status = excluded.status, \
         solver_version = excluded.solver_version, trajectory = excluded.trajectory, \
         created_us = excluded.created_us WHERE legs.solver_version <> excluded.solver_version \
         OR legs.bound_version IS DISTINCT FROM excluded.bound_version",
    )
    .bind(SOLVER_VERSION)
    .bind(bounds::VERSION)
    .bind(now_us)
    .rows(rows.collect())
    .execute(&mut **transaction)
    .await
}

/// A leg with its key and its motion as JSON, as a row.
fn row<'v>(key: &'v String, new: &'v NewLeg, motion: &'v Vec<u8>) -> [Value<'v>; 17] {
    let leg = &new.leg;
    let [x, y, z, w] = leg.turn_xyzw;
    let [h_x, h_y, h_z] = leg.body_momentum_nms;
    [
        key.into(),
        (&new.identity).into(),
        super::key(&leg.spacecraft).into(),
        <&str>::from(leg.kind).into(),
        x.into(),
        y.into(),
        z.into(),
        w.into(),
        h_x.into(),
        h_y.into(),
        h_z.into(),
        leg.reversible.into(),
        leg.duration_s.into(),
        leg.certified_lower_bound_s.into(),
        leg.solve_time_s.into(),
        (&leg.status).into(),
        motion.into(),
    ]
}
