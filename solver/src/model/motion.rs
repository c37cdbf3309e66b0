//! A motion as plain numbers: what a leg's solution is outside of the optimiser.

use serde::{Deserialize, Serialize};

/// Attitudes and wheel momenta at nodes, and the time between them; the torque between two nodes is
/// constant, the change of momentum over the time.
///
/// Stores keep it, tables of legs carry it, and it comes back bit for bit. Nothing is promised of the
/// numbers: whoever takes a motion from outside checks that they fit together.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Attitude at every node, scalar-last unit quaternions; of a leg relative to its begin.
    pub attitudes_xyzw: Vec<[f64; 4]>,
    /// Momentum of every enabled wheel about its axis at every node, N m s.
    pub wheel_momenta_nms: Vec<Vec<f64>>,
    /// Time between nodes, s.
    pub lengths_s: Vec<f64>,
}
