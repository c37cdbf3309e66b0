//! The document of a table of legs that is imported.

use super::inputs::{Kind, Scenario};
use serde::Serialize;
use utoipa::openapi::schema::ArrayBuilder;
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

/// A table of leg times with the motions behind it, as `slewplan legs --trajectories` writes it.
#[derive(Serialize, ToSchema)]
#[schema(as = LegFile)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct LegFileBody {
    /// Version that solved the legs: that of this service.
    version: String,
    kind: FlownKind,
    /// SHA-256 of the scenario: of its JSON with sorted members, all numbers as floating point (below
    /// 2^53), without spaces.
    #[schema(pattern = "^[0-9a-f]{64}$")]
    scenario_key: String,
    shard: ShardBody,
    /// Whether everything was solved.
    complete: bool,
    /// With its spacecraft written out.
    scenario: Scenario,
    /// The times; not looked at, since they follow from the trajectories.
    legs: Vec<LegRowBody>,
    trajectories: Vec<LegMotion>,
}

/// Kinds of legs that are flown.
#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum FlownKind {
    RestToRest,
    LowerBound,
}

/// Which part of the table, counted from 1.
#[derive(Serialize, ToSchema)]
#[schema(as = Shard)]
#[serde(deny_unknown_fields)]
struct ShardBody {
    #[schema(minimum = 1, format = "uint64")]
    index: u64,
    #[schema(minimum = 1, format = "uint64")]
    of: u64,
}

/// The time of a leg.
#[derive(Serialize, ToSchema)]
#[schema(as = LegRow)]
#[serde(deny_unknown_fields)]
struct LegRowBody {
    from: String,
    to: String,
    kind: Kind,
    #[schema(required = false, minimum = 0)]
    duration_s: Option<f64>,
    #[schema(required = false, minimum = 0)]
    certified_lower_bound_s: Option<f64>,
    #[schema(minimum = 0)]
    solve_time_s: f64,
    status: String,
}

/// The motion of a leg, in the frame in which it begins at the identity attitude.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct LegMotion {
    /// The key under which it is cached: SHA-256 of the canonical text of the leg's problem.
    #[schema(pattern = "^[0-9a-f]{64}$")]
    key: String,
    /// Wall-clock time of the solve, s.
    #[schema(minimum = 0)]
    solve_time_s: f64,
    /// Time between nodes, s.
    lengths_s: Vec<f64>,
    /// Attitude at every node, unit quaternions.
    attitudes_xyzw: Vec<Components>,
    /// Momentum of every enabled wheel about its axis at every node, N m s.
    wheel_momenta_nms: Vec<Vec<f64>>,
}

/// A quaternion as x, y, z, w.
#[derive(Serialize)]
struct Components([f64; 4]);

impl PartialSchema for Components {
    fn schema() -> RefOr<Schema> {
        ArrayBuilder::new()
            .items(f64::schema())
            .min_items(Some(4))
            .max_items(Some(4))
            .into()
    }
}

impl ToSchema for Components {}
