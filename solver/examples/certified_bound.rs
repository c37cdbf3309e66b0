//! Bounds the time of a slew from below, without solving it, and proves the bound a second time.

use nalgebra::Vector3;
use slewplan_solver::bounds::certify;
use slewplan_solver::bounds::kinematic::limits::{EndRates, SlewLimits};
use slewplan_solver::bounds::kinematic::ramps::SlewBound;
use slewplan_solver::model::attitude::Attitude;

/// Relative tolerance of the search for the least time of the turn.
const TOLERANCE: f64 = 1e-4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let limits = SlewLimits {
        rates_rad_s: Vector3::new(0.018, 0.013, 0.012),
        accelerations_rad_s2: Vector3::new(0.0015, 0.0011, 0.001),
    };
    let bound = SlewBound::new(limits, EndRates::at_rest()).ok_or("limits must be positive")?;
    for degrees in [15.0_f64, 45.0, 90.0, 180.0] {
        let axis = Vector3::new(1.0, 1.0, 1.0).normalize();
        let turn = Attitude::from_rotation_vector(axis * degrees.to_radians());
        let mut certificate = bound.certificate(&[turn], TOLERANCE);
        println!(
            "{degrees:5} degrees: no less than {:.3} s",
            certificate.duration_s
        );
        // The second proof, in intervals and from another list of the extremals.
        certify::verify(&certificate).map_err(|rejection| format!("{rejection:?}"))?;
        // A bound that is too large by a thousandth is not confirmed.
        certificate.duration_s *= 1.001;
        assert!(certify::verify(&certificate).is_err());
    }
    Ok(())
}
