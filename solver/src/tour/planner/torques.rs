//! The torques of a motion, one piece for each of its intervals.

use crate::leg::profile::Profile;
use nalgebra::DVector;
use std::ops::Range;

/// Intervals shorter than this share of the whole flight are joined to their neighbour: their
/// torque would be a quotient of two vanishing numbers.
pub(super) const MIN_PIECE_SHARE: f64 = 1e-9;

/// Lengths, s, and wheel torques, N m, over some intervals of a motion; none of the pieces is
/// shorter than `shortest`, s, unless all of them together are.
pub(super) fn torques(
    profile: &Profile,
    intervals: Range<usize>,
    shortest: f64,
) -> Vec<(f64, DVector<f64>)> {
    let end = intervals.end;
    let mut first = intervals.start;
    let mut pieces = Vec::with_capacity(intervals.len());
    for k in intervals {
        let length: f64 = profile.lengths[first..=k].iter().sum();
        let rest: f64 = profile.lengths[k + 1..end].iter().sum();
        // Join with the next interval when this one, or all that is left, is too short alone.
        let last = k + 1 == end;
        if !last && (length < shortest || rest < shortest) {
            continue;
        }
        if length > 0.0 {
            let change = &profile.wheels[k + 1] - &profile.wheels[first];
            pieces.push((length, change / length));
        }
        first = k + 1;
    }
    pieces
}
