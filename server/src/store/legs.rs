//! Solved legs.

mod upkeep;
mod writing;

pub(super) use writing::put_legs;

use super::database::row::{FromRow, Row};
use super::database::statement::sql;
use super::{Store, StoreError};
use slewplan_solver::bounds;
use slewplan_solver::model::cone::ForbiddenCone;
use slewplan_solver::model::motion::Motion;
use slewplan_solver::tour::legs::{LegKind, StoredLeg};
use slewplan_solver::tour::planner;
use std::str::FromStr;

/// Legs of other versions of the solver are never found. They are replaced when they are solved
/// again, and deleted when the service starts.
pub(super) const SOLVER_VERSION: &str = env!("CARGO_PKG_VERSION");

/// Tolerance on the scalar product of two unit quaternions: far above its rounding error, and less
/// than 1e-6 rad as an angle.
const ROUNDING: f64 = 1e-14;

/// A leg to be stored.
#[derive(Debug, Clone)]
pub(crate) struct NewLeg {
    /// Canonical text of its problem.
    pub(crate) identity: String,
    /// The leg.
    pub(crate) leg: StoredLeg,
}

row! {
    columns leg_columns;
    /// A stored leg without its motion.
    #[derive(Debug, Clone)]
    pub(crate) struct CachedLegRow {
        /// Order in which legs were stored.
        pub(crate) sequence: i64,
        /// SHA-256 of the identity, hex.
        pub(crate) key: String,
        identity: String,
        /// SHA-256 of the spacecraft's canonical text, hex.
        pub(crate) spacecraft: String,
        /// The kind of table for which it was solved.
        pub(crate) kind: String,
        turn_x: f64,
        turn_y: f64,
        turn_z: f64,
        turn_w: f64,
        momentum_x: f64,
        momentum_y: f64,
        momentum_z: f64,
        /// Whether the reversed motion is a solution too.
        pub(crate) reversible: bool,
        /// Minimum time, s.
        pub(crate) duration_s: f64,
        certified_lower_bound_s: Option<f64>,
        bound_version: Option<i64>,
        /// Wall-clock time of the solve, s.
        pub(crate) solve_time_s: f64,
        /// How the solve ended.
        pub(crate) status: String,
        /// Version that solved it.
        pub(crate) solver_version: String,
        /// When it was stored.
        pub(crate) created_us: i64,
    }
}

impl CachedLegRow {
    /// The turn from begin to end, scalar-last quaternion.
    pub(crate) fn turn_xyzw(&self) -> [f64; 4] {
        [self.turn_x, self.turn_y, self.turn_z, self.turn_w]
    }

    /// Total momentum in body axes at the begin, N m s.
    pub(crate) fn momentum(&self) -> [f64; 3] {
        [self.momentum_x, self.momentum_y, self.momentum_z]
    }

    /// No slew with its conditions takes less, s, proved; `None` where nothing is, and of bounds of
    /// another version.
    pub(crate) fn certified_lower_bound_s(&self) -> Option<f64> {
        self.certified_lower_bound_s
            .filter(|_| self.bound_version == Some(bounds::VERSION.into()))
    }

    /// The cones that it keeps out of, in the frame in which it begins at the identity attitude.
    pub(crate) fn cones(&self) -> Vec<ForbiddenCone> {
        planner::cones_of(&self.identity)
    }

    /// The leg with what its row does not hold.
    fn stored(self, spacecraft: String, motion: Motion) -> Result<StoredLeg, StoreError> {
        Ok(StoredLeg {
            spacecraft,
            kind: LegKind::from_str(&self.kind).map_err(|_| StoreError::Inconsistent {
                table: "legs",
                what: format!("there is no kind {}", self.kind),
            })?,
            turn_xyzw: self.turn_xyzw(),
            body_momentum_nms: self.momentum(),
            reversible: self.reversible,
            duration_s: self.duration_s,
            certified_lower_bound_s: self.certified_lower_bound_s(),
            status: self.status,
            solve_time_s: self.solve_time_s,
            motion,
        })
    }
}

/// Which legs to list.
#[derive(Debug)]
pub(crate) struct LegFilter {
    /// Only legs of this spacecraft.
    pub(crate) spacecraft: Option<String>,
    /// Only legs whose rotation is close to this one, or, if reversible, to its inverse:
    /// scalar-last quaternion and tolerance, rad.
    pub(crate) turn: Option<([f64; 4], f64)>,
    /// Only legs stored after this one.
    pub(crate) after: Option<i64>,
    /// Maximum number of rows.
    pub(crate) limit: i64,
}

/// The key of a leg or a spacecraft: SHA-256 of its canonical text, hex.
pub(crate) fn key(identity: &str) -> String {
    crate::base::digest::hex(identity.as_bytes())
}

/// The keys of legs.
pub(super) fn keys_of(identities: &[&str]) -> Vec<String> {
    identities.iter().map(|identity| key(identity)).collect()
}

/// Keys as the text of a JSON array.
pub(super) fn json_of(keys: &[String]) -> String {
    serde_json::to_string(keys).expect("texts are plain data")
}

impl Store {
    /// The stored legs of identities, in their order, that this version of the solver solved.
    pub(crate) async fn known_legs(
        &self,
        identities: &[&str],
    ) -> Result<Vec<Option<StoredLeg>>, StoreError> {
        let found: Vec<KnownLeg> = sql(concat!(
            "SELECT place, document, trajectory, ",
            leg_columns!(),
            " FROM {asked} {with_legs} \
             JOIN (SELECT key AS spacecraft_key, document FROM leg_spacecraft) AS known \
             ON spacecraft_key = spacecraft WHERE solver_version = $2"
        ))
        .bind(json_of(&keys_of(identities)))
        .bind(SOLVER_VERSION)
        .fetch_all(&self.database)
        .await?;
        let mut legs = vec![None; identities.len()];
        for KnownLeg {
            place,
            leg,
            spacecraft,
        } in found
        {
            let place = usize::try_from(place).unwrap_or(usize::MAX);
            if identities.get(place) == Some(&&*leg.row.identity) {
                legs[place] = Some(leg.row.stored(spacecraft, leg.motion)?);
            }
        }
        Ok(legs)
    }

    /// A leg by its key, with its motion.
    pub(crate) async fn leg(
        &self,
        key: &str,
    ) -> Result<Option<(CachedLegRow, Motion)>, StoreError> {
        let found: Option<LegWithMotion> = sql(concat!(
            "SELECT trajectory, ",
            leg_columns!(),
            " FROM legs WHERE key = $1"
        ))
        .bind(key)
        .fetch_optional(&self.database)
        .await?;
        Ok(found.map(|leg| (leg.row, leg.motion)))
    }

    /// Legs in the order in which they were stored.
    pub(crate) async fn legs(&self, filter: &LegFilter) -> Result<Vec<CachedLegRow>, StoreError> {
        let ([x, y, z, w], tolerance) = filter.turn.unwrap_or_default();
        sql(concat!(
            "SELECT ",
            leg_columns!(),
            " FROM legs WHERE ($1 IS NULL OR spacecraft = $1) AND ($2 IS NULL OR sequence > $2) \
             AND (NOT $3 \
             OR abs(turn_x * $4 + turn_y * $5 + turn_z * $6 + turn_w * $7) >= $8 \
             OR (reversible AND \
             abs(turn_w * $7 - turn_x * $4 - turn_y * $5 - turn_z * $6) >= $8)) \
             ORDER BY sequence LIMIT $9"
        ))
        .bind(&filter.spacecraft)
        .bind(filter.after)
        .bind(filter.turn.is_some())
        .bind(x)
        .bind(y)
        .bind(z)
        .bind(w)
        // The product of two equal quaternions is one up to rounding.
        .bind((tolerance / 2.0).cos() - ROUNDING)
        .bind(filter.limit)
        .fetch_all(&self.database)
        .await
    }

    /// Number of stored legs.
    pub(crate) async fn leg_count(&self) -> Result<i64, StoreError> {
        let (count,) = sql("SELECT count(*) FROM legs")
            .fetch_one(&self.database)
            .await?;
        Ok(count)
    }
}

/// A leg with its motion.
struct LegWithMotion {
    row: CachedLegRow,
    motion: Motion,
}

impl FromRow for LegWithMotion {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            row: CachedLegRow::from_row(row)?,
            motion: read_motion(&row.get::<Vec<u8>>("trajectory")?)?,
        })
    }
}

/// A leg with all that a solve takes of it.
struct KnownLeg {
    /// Place of its key among those asked for.
    place: i64,
    leg: LegWithMotion,
    /// Canonical text.
    spacecraft: String,
}

impl FromRow for KnownLeg {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            place: row.get("place")?,
            leg: LegWithMotion::from_row(row)?,
            spacecraft: row.get("document")?,
        })
    }
}

fn read_motion(json: &[u8]) -> Result<Motion, StoreError> {
    serde_json::from_slice(json).map_err(|error| StoreError::Inconsistent {
        table: "legs",
        what: error.to_string(),
    })
}
