//! The rolls that limits and cones leave at a waypoint: arcs.

use super::FreeRoll;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use crate::model::tolerances::ATTITUDE_TOLERANCE;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// The admissible rolls beside an attitude that points a body axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RollArcs {
    /// The body axis that is pointed, of unit length.
    pub(crate) axis: Vector3<f64>,
    /// Least and greatest roll of each arc, rad; none where every roll is admissible.
    pub(crate) arcs: Vec<[f64; 2]>,
}

impl From<FreeRoll> for RollArcs {
    fn from(free: FreeRoll) -> Self {
        Self {
            axis: free.axis,
            arcs: free.range.into_iter().collect(),
        }
    }
}

impl RollArcs {
    /// What cones leave of the admissible rolls from an attitude. Where that is nothing, those at which
    /// no cone is entered by more than the tolerance; the cones that exclude all rolls are left aside.
    pub(crate) fn clear_of(free: &FreeRoll, cones: &[ForbiddenCone], attitude: &Attitude) -> Self {
        let clear = [0.0, ATTITUDE_TOLERANCE]
            .map(|tolerance| free.clear_of(cones.iter().copied(), attitude, tolerance));
        let Some(mut arcs) = clear.into_iter().find(|arcs| !arcs.is_empty()) else {
            return Self::from(*free);
        };
        if free.range.is_none()
            && let ([[first, _], ..], [.., [_, last]]) = (&arcs[..], &arcs[..])
            && *first <= -PI
            && *last >= PI
        {
            // Those at both ends of the whole turn are one.
            let [_, end] = arcs.remove(0);
            match arcs.last_mut() {
                Some(last) => last[1] = end + TAU,
                None => return Self::from(*free),
            }
        }
        Self {
            axis: free.axis,
            arcs,
        }
    }

    /// The attitude after a roll, rad.
    pub(crate) fn rolled(&self, attitude: &Attitude, roll: f64) -> Attitude {
        self.within(None).rolled(attitude, roll)
    }

    /// The same rolls, seen from the attitude after a roll, rad.
    pub(crate) fn after(&self, roll: f64) -> Self {
        let arcs = self.arcs.iter().map(|arc| arc.map(|end| end - roll));
        Self {
            axis: self.axis,
            arcs: arcs.collect(),
        }
    }

    /// The admissible roll that is nearest to that of an attitude, rad, from one that points the axis.
    pub(crate) fn towards(&self, from: &Attitude, attitude: &Attitude) -> f64 {
        self.nearest(self.within(None).between(from, attitude))
    }

    /// The admissible roll that is nearest to a roll, rad, whole turns apart being the same.
    pub(crate) fn nearest(&self, roll: f64) -> f64 {
        let away = |to: f64| ((to - roll) / TAU - ((to - roll) / TAU).round()).abs();
        let nearest = self
            .arcs
            .iter()
            .map(|arc| self.within(Some(*arc)).nearest(roll));
        let nearest = nearest.min_by(|one, other| away(*one).total_cmp(&away(*other)));
        nearest.unwrap_or(roll)
    }

    /// The arc around roll 0, or the one that is nearest to it; `None` where every roll is admissible.
    pub(crate) fn own(&self) -> Option<[f64; 2]> {
        let nearest = self.nearest(0.0);
        let mut arcs = self.arcs.iter();
        arcs.find(|[least, greatest]| (*least..=*greatest).contains(&nearest))
            .copied()
    }

    /// Whether all rolls of others about the same axis, seen from a roll, rad, are among these.
    pub(crate) fn include(&self, others: &Self, roll: f64) -> bool {
        let covers = |rolls: [f64; 2]| {
            let mut arcs = self.arcs.iter();
            arcs.any(|arc| self.within(Some(*arc)).admits(rolls))
        };
        let mut shifted = others.arcs.iter().map(|arc| arc.map(|end| roll + end));
        self.arcs.is_empty() || (!others.arcs.is_empty() && shifted.all(covers))
    }

    fn within(&self, range: Option<[f64; 2]>) -> FreeRoll {
        FreeRoll {
            axis: self.axis,
            range,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about_z(range: Option<[f64; 2]>) -> FreeRoll {
        FreeRoll {
            axis: Vector3::z(),
            range,
        }
    }

    /// Body x must not be within an angle of a direction across z.
    fn cone(azimuth: f64, half_angle: f64) -> ForbiddenCone {
        ForbiddenCone {
            axis: Vector3::x(),
            direction: Vector3::new(azimuth.cos(), azimuth.sin(), 0.0),
            half_angle,
        }
    }

    fn close(found: &[[f64; 2]], expected: &[[f64; 2]]) -> bool {
        let pairs = found.iter().flatten().zip(expected.iter().flatten());
        found.len() == expected.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9)
    }

    #[test]
    fn cones_leave_arcs_and_the_two_ends_of_a_whole_turn_are_one() {
        let level = Attitude::identity();
        let arcs = |range, cones: &[ForbiddenCone]| {
            RollArcs::clear_of(&about_z(range), cones, &level).arcs
        };
        assert!(arcs(None, &[]).is_empty());
        assert!(close(&arcs(None, &[cone(0.5, 0.2)]), &[[0.7, 0.3 + TAU]]));
        let both = [cone(0.5, 0.2), cone(2.0, 0.5)];
        assert!(close(&arcs(None, &both), &[[0.7, 1.5], [2.5, 0.3 + TAU]]));
        assert!(close(
            &arcs(None, &[cone(PI, 1.0)]),
            &[[1.0 - PI, PI - 1.0]]
        ));
        assert!(close(
            &arcs(Some([0.0, 1.0]), &both),
            &[[0.0, 0.3], [0.7, 1.0]]
        ));
        // Nothing is left: who plans has refused it, and the cone is left aside.
        assert!(arcs(None, &[cone(0.0, 3.2)]).is_empty());
    }

    #[test]
    fn the_nearest_roll_lies_in_the_nearest_arc() {
        let rolls = RollArcs {
            axis: Vector3::z(),
            arcs: vec![[0.7, 1.5], [2.5, 3.0]],
        };
        for (roll, nearest, own) in [
            (0.0, 0.7, [0.7, 1.5]),
            (1.0, 1.0, [-0.3, 0.5]),
            (1.9, 1.5, [-1.2, -0.4]),
            (2.2, 2.5, [0.3, 0.8]),
            (2.7 - TAU, 2.7, [2.5 - 2.7 + TAU, 3.0 - 2.7 + TAU]),
        ] {
            assert!((rolls.nearest(roll) - nearest).abs() < 1e-12, "{roll}");
            let seen = rolls.after(roll).own().expect("arcs");
            assert!(close(&[seen], &[own]), "{roll} {seen:?}");
        }
        let one = |arc| RollArcs {
            arcs: vec![arc],
            ..rolls.clone()
        };
        let every = RollArcs {
            arcs: Vec::new(),
            ..rolls.clone()
        };
        assert!(
            rolls.include(&one([0.1, 0.2]), 0.7 - TAU) && !rolls.include(&one([0.0, 2.0]), 0.8)
        );
        assert!(every.include(&rolls, 1.0) && !rolls.include(&every, 1.0));
    }
}
