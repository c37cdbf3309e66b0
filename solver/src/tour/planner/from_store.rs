//! Solutions of stored motions, as they were solved.

use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::motion::Motion;
use crate::nlp::NlpStatus;
use crate::tour::legs::StoredSegment;
use nalgebra::DVector;

/// A segment to be stored.
pub(super) fn stored_segment(solution: &LegSolution) -> StoredSegment {
    let costates = solution.costates.iter();
    StoredSegment {
        motion: (&solution.profile).into(),
        costates_s_per_nms: costates.map(|it| it.as_slice().to_vec()).collect(),
    }
}

/// The solution of a stored segment; `None` when its numbers do not fit together.
pub(super) fn segment_from_store(
    stored: StoredSegment,
    intervals: Vec<usize>,
) -> Option<LegSolution> {
    let costates = stored.costates_s_per_nms.into_iter();
    Some(LegSolution {
        costates: costates.map(DVector::from_vec).collect(),
        ..from_store(stored.motion, intervals)?
    })
}

/// The solution of one leg, with as many intervals as it was solved with; `None` when its numbers do
/// not fit together.
pub(super) fn leg_from_store(motion: Motion) -> Option<LegSolution> {
    let intervals = vec![motion.lengths_s.len()];
    from_store(motion, intervals)
}

fn from_store(motion: Motion, intervals: Vec<usize>) -> Option<LegSolution> {
    let profile = Profile::from_motion(motion)?;
    let all: usize = intervals.iter().sum();
    (profile.intervals() == all).then_some(LegSolution {
        status: NlpStatus::Converged,
        profile,
        intervals,
        iterations: 0,
        infeasibility: 0.0,
        costates: Vec::new(),
    })
}
