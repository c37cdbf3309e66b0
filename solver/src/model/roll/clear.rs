//! The rolls about a boresight at which others stay clear of cones.

use super::FreeRoll;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use std::f64::consts::{PI, TAU};

impl FreeRoll {
    /// The admissible rolls from an attitude at which no cone is entered by more than a tolerance, rad:
    /// intervals in increasing order, in the limits, or in `[-pi, pi]` without them.
    #[must_use]
    pub fn clear_of(
        &self,
        cones: impl IntoIterator<Item = ForbiddenCone>,
        attitude: &Attitude,
        tolerance: f64,
    ) -> Vec<[f64; 2]> {
        let mut clear = vec![self.range.unwrap_or([-PI, PI])];
        for cone in cones {
            match self
                .circle(&cone, attitude)
                .inside(cone.half_angle - tolerance)
            {
                Inside::Never => {}
                Inside::Always => return Vec::new(),
                Inside::Between(arc) => clear = without(&clear, arc),
            }
        }
        clear
    }

    /// The least depth in a cone over the admissible rolls from an attitude, rad; negative outside.
    #[must_use]
    pub fn least_depth(&self, cone: &ForbiddenCone, attitude: &Attitude) -> f64 {
        let farthest = self.circle(cone, attitude).middle + PI;
        let candidates = self
            .range
            .into_iter()
            .flatten()
            .chain([self.nearest(farthest)]);
        let depths = candidates.map(|roll| cone.depth(&self.rolled(attitude, roll)));
        depths.fold(f64::INFINITY, f64::min)
    }

    /// The circle on which a cone's boresight moves with the roll.
    fn circle(&self, cone: &ForbiddenCone, attitude: &Attitude) -> Circle {
        let direction = attitude.to_body(cone.direction);
        let along = self.axis * self.axis.dot(&cone.axis);
        let (cosine, sine) = (
            (cone.axis - along).dot(&direction),
            self.axis.cross(&cone.axis).dot(&direction),
        );
        Circle {
            offset: along.dot(&direction),
            radius: cosine.hypot(sine),
            middle: sine.atan2(cosine),
        }
    }
}

/// The cosine of the angle between a boresight and the axis of a cone, by the roll:
/// `offset + radius cos(roll - middle)`.
struct Circle {
    offset: f64,
    radius: f64,
    middle: f64,
}

/// At which rolls a boresight is inside a cone.
enum Inside {
    Never,
    Always,
    /// Between these, rad.
    Between([f64; 2]),
}

impl Circle {
    fn inside(&self, half_angle: f64) -> Inside {
        let excess = half_angle.clamp(0.0, PI).cos() - self.offset;
        if half_angle <= 0.0 || excess >= self.radius {
            Inside::Never
        } else if excess <= -self.radius {
            Inside::Always
        } else {
            let half = (excess / self.radius).acos();
            Inside::Between([self.middle - half, self.middle + half])
        }
    }
}

/// Intervals without an open arc, whole turns apart being the same.
fn without(intervals: &[[f64; 2]], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let cut = |[begin, end]: [f64; 2]| {
        // The arc, shorter than a whole turn, at its last place that begins before the interval does.
        let from_there = from - TAU * ((from - begin) / TAU).ceil();
        let length = to - from;
        let mut left = Vec::new();
        let (mut clear_from, mut next) = (begin, from_there);
        while next < end {
            if next >= clear_from {
                left.push([clear_from, next]);
            }
            clear_from = clear_from.max(next + length);
            next += TAU;
        }
        if clear_from <= end {
            left.push([clear_from, end]);
        }
        left
    };
    intervals.iter().copied().flat_map(cut).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn unit(components: [f64; 3]) -> Vector3<f64> {
        Vector3::from(components).normalize()
    }

    prop_compose! {
        fn any_unit()(components in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]
            .prop_filter("too short to have a direction", |c| c.iter().map(|c| c * c).sum::<f64>() > 0.01)
        ) -> Vector3<f64> {
            unit(components)
        }
    }

    prop_compose! {
        fn any_cone()(axis in any_unit(), direction in any_unit(), half_angle in 0.05..3.0_f64) -> ForbiddenCone {
            ForbiddenCone { axis, direction, half_angle }
        }
    }

    prop_compose! {
        fn any_roll()(
            axis in any_unit(),
            range in proptest::option::of((-8.0..8.0_f64, 0.0..6.2_f64)),
        ) -> FreeRoll {
            FreeRoll { axis, range: range.map(|(low, width)| [low, low + width]) }
        }
    }

    proptest! {
        #[test]
        fn a_roll_is_clear_where_every_cone_is(
            free in any_roll(),
            turn in any_unit(),
            cones in proptest::collection::vec(any_cone(), 0..4),
        ) {
            let attitude = Attitude::from_rotation_vector(turn * 2.0);
            let clear = free.clear_of(cones.iter().copied(), &attitude, 0.0);
            prop_assert!(clear.windows(2).all(|pair| pair[0][1] <= pair[1][0]));
            let [low, high] = free.range.unwrap_or([-PI, PI]);
            for step in 0..=200 {
                let roll = low + (high - low) * f64::from(step) / 200.0;
                let rolled = free.rolled(&attitude, roll);
                let depth = cones.iter().map(|cone| cone.depth(&rolled)).fold(-4.0, f64::max);
                let is_clear = clear.iter().any(|[from, to]| (*from..=*to).contains(&roll));
                // A grazing pass is either.
                prop_assert!(is_clear == (depth < 0.0) || depth.abs() < 1e-9, "{roll} {depth} {clear:?}");
                let least = cones.iter().all(|cone| {
                    free.least_depth(cone, &attitude) <= cone.depth(&rolled) + 1e-9
                });
                prop_assert!(least);
            }
        }
    }

    #[test]
    fn a_cone_around_the_axis_is_entered_at_all_rolls_or_none() {
        let axis = Vector3::z();
        let free = FreeRoll { axis, range: None };
        let level = Attitude::identity();
        let cone = |half_angle| ForbiddenCone {
            axis: Vector3::x(),
            direction: axis,
            half_angle,
        };
        assert!(free.clear_of([cone(1.6)], &level, 1e-6).is_empty());
        assert_eq!(free.clear_of([cone(1.5)], &level, 1e-6), [[-PI, PI]]);
        assert!((free.least_depth(&cone(1.6), &level) - (1.6 - 0.5 * PI)).abs() < 1e-12);
    }
}
