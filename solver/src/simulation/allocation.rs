//! Allocation of a torque on the body to the wheels.

use crate::math::cone;
use crate::model::drive::Drive;
use crate::model::spacecraft::Wheel;
use crate::model::wheel_axes::pseudo_inverse;
use nalgebra::Vector3;

/// The pseudo-inverse of the wheel axes. Of all wheel torques with the same torque on the body it gives
/// those with the least sum of squares (RW/CMG thesis, equation 158).
#[derive(Debug, Clone)]
pub(super) struct TorqueAllocation {
    /// Rows of `A^T (A A^T)^-1`, one per wheel; zero for wheels that take no commands.
    rows: Vec<Vector3<f64>>,
}

impl TorqueAllocation {
    /// `None` when the wheels that take commands do not span space.
    pub(super) fn new(wheels: &[Wheel], drives: &[Drive]) -> Option<Self> {
        let commanded =
            |(wheel, drive): &(&Wheel, &Drive)| wheel.enabled && drive.speed_law.is_none();
        let axes: Vec<_> = wheels
            .iter()
            .zip(drives)
            .filter(commanded)
            .map(|(wheel, _)| wheel.axis)
            .collect();
        let inverse = pseudo_inverse(&axes)?;
        let mut commanded_rows = inverse.row_iter();
        let rows = wheels.iter().zip(drives).map(|pair| {
            let row = commanded(&pair).then(|| commanded_rows.next()).flatten();
            row.map_or_else(Vector3::zeros, |row| Vector3::new(row[0], row[1], row[2]))
        });
        Some(Self {
            rows: rows.collect(),
        })
    }

    /// Torque of a wheel, N m, for a torque on the body, N m: the body gets the reaction.
    pub(super) fn wheel_torque(&self, wheel: usize, on_body: &Vector3<f64>) -> f64 {
        -self.rows[wheel].dot(on_body)
    }

    /// The change of the torque on the body, N m, nearest to `change` that demands no more of any wheel
    /// at a limit. Of `missing`, one entry per wheel, only zero or the sign counts.
    pub(super) fn relieved(&self, change: &Vector3<f64>, missing: &[f64]) -> Vector3<f64> {
        let wheels = self.rows.iter().zip(missing);
        let at_limits =
            wheels.filter(|(row, missing)| **missing != 0.0 && **row != Vector3::zeros());
        let asking: Vec<_> = at_limits
            .map(|(row, missing)| row * missing.signum())
            .collect();
        // A point minus its projection on a cone is its projection on the polar cone (Moreau).
        change - cone::nearest(&asking, change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wheel(axis: [f64; 3], enabled: bool) -> Wheel {
        Wheel {
            axis: Vector3::from(axis),
            inertia: 1e-3,
            min_torque: -1.0,
            max_torque: 1.0,
            max_speed: f64::INFINITY,
            enabled,
        }
    }

    #[test]
    fn allocated_torques_add_up_without_a_null_space_component() {
        let wheels = [
            wheel([0.8, 0.0, 0.6], true),
            wheel([0.0, 0.8, 0.6], true),
            wheel([-0.8, 0.0, 0.6], true),
            wheel([0.0, -0.8, 0.6], true),
            wheel([1.0, 0.0, 0.0], false),
        ];
        let allocation = TorqueAllocation::new(&wheels, &[Drive::IDEAL; 5]).unwrap();
        let wanted = Vector3::new(0.3, -0.2, 0.5);
        let torques: Vec<f64> = (0..5)
            .map(|wheel| allocation.wheel_torque(wheel, &wanted))
            .collect();
        let made: Vector3<f64> = wheels.iter().zip(&torques).map(|(w, u)| -w.axis * *u).sum();
        assert!((made - wanted).norm() < 1e-15, "{made}");
        // Nothing along the null space (1, -1, 1, -1) of the pyramid, nothing for a locked wheel.
        assert!((torques[0] - torques[1] + torques[2] - torques[3]).abs() < 1e-15);
        assert!(torques[4].abs() <= 0.0);
    }

    #[test]
    fn a_relieved_change_demands_no_more_of_wheels_at_limits() {
        let wheels = [
            wheel([0.8, 0.0, 0.6], true),
            wheel([0.0, 0.8, 0.6], true),
            wheel([-0.8, 0.0, 0.6], true),
            wheel([0.0, -0.8, 0.6], true),
        ];
        let allocation = TorqueAllocation::new(&wheels, &[Drive::IDEAL; 4]).unwrap();
        let change = Vector3::new(0.3, -0.2, 0.5);
        let more = |change: &Vector3<f64>, wheel| -allocation.wheel_torque(wheel, change);
        let relieved = |missing: [f64; 4]| allocation.relieved(&change, &missing);
        assert_eq!(relieved([0.0; 4]), change);
        // The change demands more torque of the first wheel, so that only one sign of its limit matters.
        assert!(more(&change, 0) > 0.0);
        assert_eq!(relieved([-1e-3, 0.0, 0.0, 0.0]), change);
        let one = relieved([1e-3, 0.0, 0.0, 0.0]);
        assert!(more(&one, 0).abs() < 1e-15 && one.y.abs() > 0.19, "{one}");
        let both = relieved([1e-3, 0.0, -1e-3, 0.0]);
        assert!(more(&both, 0) < 1e-15 && more(&both, 2) > -1e-15, "{both}");
        // Opposite wheels at opposite limits turn about x only, and that is what is left out.
        let about_x = allocation.relieved(&Vector3::x(), &[1.0, 0.0, -1.0, 0.0]);
        assert!(about_x.norm() < 1e-15, "{about_x}");
    }

    #[test]
    fn axes_in_a_plane_are_refused() {
        let wheels = [
            wheel([1.0, 0.0, 0.0], true),
            wheel([0.0, 1.0, 0.0], true),
            wheel([1.0, 1.0, 0.0], true),
        ];
        assert!(TorqueAllocation::new(&wheels, &[Drive::IDEAL; 3]).is_none());
    }
}
