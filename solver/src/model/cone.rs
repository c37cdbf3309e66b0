//! Cones that bound where boresights point.

use super::attitude::Attitude;
pub use super::spec::Applies;
use nalgebra::Vector3;

/// On which side of its cone a boresight has to stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Outside, as a camera of the Sun.
    Out,
    /// Inside, as a solar panel's normal.
    In,
}

impl Side {
    /// The name of the scenario's list of such cones.
    #[must_use]
    pub fn list(self) -> &'static str {
        match self {
            Self::Out => "keep_out",
            Self::In => "keep_in",
        }
    }
}

/// A cone that bounds where a boresight points.
#[derive(Debug, Clone, PartialEq)]
pub struct Cone {
    /// On which side the boresight has to stay.
    pub side: Side,
    /// Position among the scenario's cones of the same side.
    pub index: usize,
    /// Name of the boresight.
    pub boresight: String,
    /// Unit direction of the boresight in body axes.
    pub axis: Vector3<f64>,
    /// Unit direction of the cone's axis in the reference frame.
    pub direction: Vector3<f64>,
    /// Half angle, rad.
    pub half_angle: f64,
    /// When it is enforced.
    pub applies: Applies,
}

impl Cone {
    /// The JSON pointer of the cone in its scenario.
    #[must_use]
    pub fn pointer(&self) -> String {
        format!("/{}/{}", self.side.list(), self.index)
    }

    /// Whether a plan has to keep it, always or at targets.
    #[must_use]
    pub fn is_enforced(&self) -> bool {
        self.applies != Applies::Report
    }

    /// Whether a plan has to keep it at a place that it passes, a target or another one.
    #[must_use]
    pub fn is_enforced_at(&self, is_target: bool) -> bool {
        match self.applies {
            Applies::Always => true,
            Applies::AtTargets => is_target,
            Applies::Report => false,
        }
    }

    /// Angle between the boresight and the cone's surface at an attitude, rad; negative on the wrong
    /// side.
    #[must_use]
    pub fn clearance(&self, attitude: &Attitude) -> f64 {
        -self.forbidden().depth(attitude)
    }

    /// The cone that the boresight has to stay out of: what is inside a cone is outside the one around
    /// the opposite direction with the supplementary angle.
    #[must_use]
    pub fn forbidden(&self) -> ForbiddenCone {
        let (direction, half_angle) = match self.side {
            Side::Out => (self.direction, self.half_angle),
            Side::In => (-self.direction, std::f64::consts::PI - self.half_angle),
        };
        ForbiddenCone {
            axis: self.axis,
            direction,
            half_angle,
        }
    }
}

/// What boresights have to stay out of along the whole flight.
pub(crate) fn forbidden_always(cones: &[Cone]) -> Vec<ForbiddenCone> {
    let enforced = cones.iter().filter(|cone| cone.applies == Applies::Always);
    enforced.map(Cone::forbidden).collect()
}

/// A cone that a direction of the body has to stay out of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForbiddenCone {
    /// Unit direction in body axes.
    pub axis: Vector3<f64>,
    /// Unit direction of the cone's axis in the reference frame.
    pub direction: Vector3<f64>,
    /// Half angle, rad.
    pub half_angle: f64,
}

impl ForbiddenCone {
    /// By how much an attitude is inside, rad; negative outside.
    #[must_use]
    pub fn depth(&self, attitude: &Attitude) -> f64 {
        let boresight = attitude.to_reference(self.axis);
        let sine = boresight.cross(&self.direction).norm();
        self.half_angle - sine.atan2(boresight.dot(&self.direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inside_a_cone_is_outside_the_opposite_one() {
        let cone = Cone {
            side: Side::In,
            index: 2,
            boresight: "panel".into(),
            axis: Vector3::z(),
            direction: Vector3::z(),
            half_angle: 0.5,
            applies: Applies::Always,
        };
        let opposite = cone.forbidden();
        for angle in [0.0, 0.3, 0.5, 0.7, 3.0] {
            let attitude = Attitude::identity().retract(Vector3::x() * angle);
            let clearance = cone.clearance(&attitude);
            assert!((clearance - (0.5 - angle)).abs() < 1e-12, "{angle}");
            assert!((opposite.depth(&attitude) + clearance).abs() < 1e-12);
        }
        assert_eq!(cone.pointer(), "/keep_in/2");
    }
}
