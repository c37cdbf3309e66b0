//! Motions as plain data, and back.

use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use crate::nlp::NlpStatus;
use crate::tour::legs::StoredSegment;
use nalgebra::DVector;

/// Attitudes at the nodes, scalar-last quaternions.
pub(super) fn attitudes_of(profile: &Profile) -> Vec<[f64; 4]> {
    profile.attitudes.iter().map(Attitude::xyzw).collect()
}

/// Momenta of the wheels at the nodes, N m s.
pub(super) fn momenta_of(profile: &Profile) -> Vec<Vec<f64>> {
    let nodes = profile.wheels.iter();
    nodes.map(|h| h.as_slice().to_vec()).collect()
}

/// A segment to be stored.
pub(super) fn stored_segment(flown: &LegSolution) -> StoredSegment {
    let profile = &flown.profile;
    let prices = flown.costates.iter();
    StoredSegment {
        attitudes_xyzw: attitudes_of(profile),
        wheel_momenta_nms: momenta_of(profile),
        lengths_s: profile.lengths.clone(),
        costates_s_per_nms: prices.map(|price| price.as_slice().to_vec()).collect(),
    }
}

/// The flight of a stored segment, as it was solved; `None` when its numbers do not fit together.
pub(super) fn segment_from_store(
    stored: StoredSegment,
    intervals: Vec<usize>,
) -> Option<LegSolution> {
    let (wheels, lengths) = (stored.wheel_momenta_nms, stored.lengths_s);
    let prices = stored.costates_s_per_nms.into_iter();
    Some(LegSolution {
        costates: prices.map(DVector::from_vec).collect(),
        ..from_store(&stored.attitudes_xyzw, wheels, lengths, intervals)?
    })
}

/// The flight of one leg, with as many intervals as it was solved with.
pub(super) fn leg_from_store(
    attitudes_xyzw: &[[f64; 4]],
    wheel_momenta_nms: Vec<Vec<f64>>,
    lengths_s: Vec<f64>,
) -> Option<LegSolution> {
    let intervals = vec![lengths_s.len()];
    from_store(attitudes_xyzw, wheel_momenta_nms, lengths_s, intervals)
}

/// The flight of stored numbers, as it was solved; `None` when they do not fit together.
fn from_store(
    attitudes_xyzw: &[[f64; 4]],
    wheel_momenta_nms: Vec<Vec<f64>>,
    lengths_s: Vec<f64>,
    intervals: Vec<usize>,
) -> Option<LegSolution> {
    let attitudes: Option<Vec<_>> = attitudes_xyzw
        .iter()
        .map(|xyzw| Attitude::from_unit_xyzw(*xyzw))
        .collect();
    let wheels = wheel_momenta_nms.into_iter().map(DVector::from_vec);
    let profile = Profile {
        attitudes: attitudes?,
        wheels: wheels.collect(),
        lengths: lengths_s,
    };
    let all: usize = intervals.iter().sum();
    let fits = profile.attitudes.len() == all + 1
        && profile.wheels.len() == all + 1
        && profile.intervals() == all;
    fits.then_some(LegSolution {
        status: NlpStatus::Converged,
        profile,
        intervals,
        iterations: 0,
        infeasibility: 0.0,
        costates: Vec::new(),
    })
}
