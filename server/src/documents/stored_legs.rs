//! Remembered legs as JSON.

use super::number::Number;
use super::plan::{ControlDocument, QuaternionDocument};
use crate::base::clock::rfc3339;
use crate::store::CachedLegRow;
use serde::Serialize;
use slewplan_solver::model::cone::ForbiddenCone;
use slewplan_solver::model::motion::Motion;
use utoipa::ToSchema;

/// A remembered leg: a slew between two attitudes, told relative to the one where it begins.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = CachedLeg)]
pub(crate) struct StoredLegDocument {
    /// SHA-256 of the canonical text of the leg's problem.
    key: String,
    /// SHA-256 of the canonical text of the spacecraft.
    spacecraft_key: String,
    /// `rest_to_rest` or `lower_bound`.
    kind: String,
    /// The turn from begin to end: the attitude at the end relative to that at the begin.
    turn: QuaternionDocument,
    /// Total angular momentum in body axes at the begin, N m s.
    body_momentum_nms: [Number; 3],
    /// Number of cones that it keeps out of, `keep_out` of the leg: zero where its motion is the fastest
    /// without any.
    cones: usize,
    /// Whether it can be flown backwards: it then is the leg from its end to its begin too.
    reversible: bool,
    /// Minimum time, s.
    duration_s: Number,
    /// No slew with these conditions takes less, s, proved; `null` where nothing is, and for legs that
    /// were stored by a version before bounds were.
    certified_lower_bound_s: Option<Number>,
    /// Wall-clock time of the solve with all its starts, s.
    solve_time_s: Number,
    /// How the solve ended.
    status: String,
    /// Version of the solver.
    solver_version: String,
    /// When it was stored.
    #[schema(format = "date-time")]
    created_at: String,
}

/// A remembered leg with its motion.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = CachedLegWithTrajectory)]
pub(crate) struct FlownLegDocument {
    #[serde(flatten)]
    leg: StoredLegDocument,
    /// The cones that it keeps out of. To stay inside a cone is to keep out of the opposite one.
    keep_out: Vec<LegConeDocument>,
    trajectory: LegTrajectoryDocument,
}

/// A cone that a leg keeps out of.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegCone)]
struct LegConeDocument {
    /// Unit vector of the boresight in body axes.
    boresight_axis: [Number; 3],
    /// Unit vector along the cone's axis, relative to the attitude at the begin.
    direction: [Number; 3],
    half_angle_deg: Number,
}

impl From<&ForbiddenCone> for LegConeDocument {
    fn from(cone: &ForbiddenCone) -> Self {
        Self {
            boresight_axis: <[f64; 3]>::from(cone.axis).map(Number),
            direction: <[f64; 3]>::from(cone.direction).map(Number),
            half_angle_deg: Number(cone.half_angle.to_degrees()),
        }
    }
}

/// The motion of a leg.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegTrajectory)]
struct LegTrajectoryDocument {
    /// Torque of every enabled wheel, constant between nodes.
    controls: Vec<ControlDocument>,
    /// The state at every node.
    states: Vec<NodeDocument>,
}

/// The state at a node.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegNode)]
struct NodeDocument {
    /// Time from the begin, s.
    time_s: Number,
    /// Attitude relative to that at the begin.
    quaternion: QuaternionDocument,
    /// Momentum of every enabled wheel about its axis, N m s.
    wheel_momentum_nms: Vec<Number>,
}

/// A page of legs, in the order in which they were stored.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = CachedLegList)]
pub(crate) struct StoredLegListDocument {
    /// The legs of this page.
    pub(crate) legs: Vec<StoredLegDocument>,
    /// Where the next page begins; `null` on the last.
    pub(crate) next_cursor: Option<String>,
}

impl From<&CachedLegRow> for StoredLegDocument {
    fn from(row: &CachedLegRow) -> Self {
        Self {
            key: row.key.clone(),
            spacecraft_key: row.spacecraft.clone(),
            kind: row.kind.clone(),
            turn: row.turn_xyzw().into(),
            body_momentum_nms: row.momentum().map(Number),
            cones: row.cones().len(),
            reversible: row.reversible,
            duration_s: Number(row.duration_s),
            certified_lower_bound_s: row.certified_lower_bound_s().map(Number),
            solve_time_s: Number(row.solve_time_s),
            status: row.status.clone(),
            solver_version: row.solver_version.clone(),
            created_at: rfc3339(row.created_us),
        }
    }
}

impl FlownLegDocument {
    /// A leg with its motion.
    pub(crate) fn new(row: &CachedLegRow, motion: &Motion) -> Self {
        let begins = begins(&motion.lengths_s);
        let nodes = motion.attitudes_xyzw.iter().zip(&motion.wheel_momenta_nms);
        let momenta = motion.wheel_momenta_nms.windows(2);
        let intervals = motion.lengths_s.iter().zip(momenta);
        Self {
            leg: row.into(),
            keep_out: row.cones().iter().map(LegConeDocument::from).collect(),
            trajectory: LegTrajectoryDocument {
                controls: begins
                    .iter()
                    .zip(intervals)
                    .map(|(begin, (length, ends))| {
                        ControlDocument::new(*begin, *length, &torque(ends, *length))
                    })
                    .collect(),
                states: begins
                    .iter()
                    .zip(nodes)
                    .map(|(time, (attitude, momentum))| NodeDocument {
                        time_s: Number(*time),
                        quaternion: (*attitude).into(),
                        wheel_momentum_nms: Number::all(momentum),
                    })
                    .collect(),
            },
        }
    }
}

/// Time of every node, s.
fn begins(lengths_s: &[f64]) -> Vec<f64> {
    let mut time = 0.0;
    let ends = lengths_s.iter().map(|length| {
        time += length;
        time
    });
    std::iter::once(0.0).chain(ends).collect()
}

/// The motor torque that changes the momenta from the first to the second in a time.
fn torque(ends: &[Vec<f64>], length_s: f64) -> Vec<f64> {
    let change = ends[0].iter().zip(&ends[1]).map(|(from, to)| to - from);
    // Where no time passes nothing is driven.
    change
        .map(|change| {
            if length_s > 0.0 {
                change / length_s
            } else {
                0.0
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torque_is_the_change_of_momentum_over_time() {
        assert_eq!(torque(&[vec![1.0, 2.0], vec![2.0, 2.0]], 0.5), [2.0, 0.0]);
        assert_eq!(torque(&[vec![1.0], vec![1.0]], 0.0), [0.0]);
        assert_eq!(begins(&[1.0, 0.5]), [0.0, 1.0, 1.5]);
    }
}
