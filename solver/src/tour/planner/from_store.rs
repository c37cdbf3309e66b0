//! Solutions of stored motions, as they were solved.

use super::canonical::CanonicalLeg;
use super::tables::SolvedLeg;
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::motion::Motion;
use crate::nlp::NlpStatus;
use crate::tour::legs::{LegKind, StoredLeg, StoredSegment};
use nalgebra::DVector;

/// A solved leg to be stored.
pub(super) fn stored_leg(leg: &CanonicalLeg, kind: LegKind, solved: &SolvedLeg) -> StoredLeg {
    let profile = &solved.solution.profile;
    StoredLeg {
        spacecraft: leg.spacecraft().to_owned(),
        kind,
        turn_xyzw: leg.to.attitude.xyzw(),
        body_momentum_nms: leg.dynamics.momentum.into(),
        reversible: leg.reversible,
        duration_s: profile.duration(),
        certified_lower_bound_s: solved.certified,
        status: solved.solution.status.into_str().into(),
        solve_time_s: solved.solve_time,
        motion: profile.into(),
    }
}

/// A stored leg as a solved one; `None` when its numbers do not fit together.
pub(super) fn leg_from_store(leg: &CanonicalLeg, stored: StoredLeg) -> Option<SolvedLeg> {
    Some(SolvedLeg {
        solution: leg_solution(stored.motion)?,
        certified: stored.certified_lower_bound_s,
        solves: 0,
        solve_time: stored.solve_time_s,
        from_store: true,
        is_condensed: false,
        described_from: leg.described_from(),
    })
}

/// The solution of one leg, with as many intervals as it was solved with; `None` when its numbers do
/// not fit together.
pub(super) fn leg_solution(motion: Motion) -> Option<LegSolution> {
    let intervals = vec![motion.lengths_s.len()];
    from_store(motion, intervals)
}

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
