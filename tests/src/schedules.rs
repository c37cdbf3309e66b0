//! Random schedules: any number of targets for the published spacecraft.
//!
//! There are two regions of targets, each with two kinds of rate conditions. A seed gives the same
//! schedule every time, and the targets of a shorter schedule are the first of a longer one.

use crate::experiment_a_spec;
use crate::random::Generator;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec};

/// The region of the targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// Attitudes distributed uniformly.
    Sphere,
    /// A strip on the ground below an orbit: clusters within 50 degrees ahead and behind and 25 degrees
    /// to the sides, turned about the camera's axis by up to 10 degrees.
    Strip,
}

/// Rate conditions at a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RateConditions {
    /// All components are zero.
    AllZero,
    /// The component about the camera's axis, z, is zero.
    ZeroAboutZ,
}

/// Number of targets of a cluster, and their greatest distance from its middle, degrees.
const CLUSTER: usize = 5;
const CLUSTER_RADIUS_DEG: f64 = 6.0;

/// A number of targets for the published spacecraft, from the identity at rest and back.
#[must_use]
pub fn schedule(region: Region, rates: RateConditions, targets: usize, seed: u64) -> ScenarioSpec {
    let mut spec = experiment_a_spec();
    let mut generator = Generator::new(seed);
    let mut middle = [0.0; 2];
    spec.name = Some(format!("{region:?}-{rates:?}-{targets}-{seed}").to_lowercase());
    spec.targets = (0..targets)
        .map(|number| {
            if number % CLUSTER == 0 {
                middle = [
                    generator.between(-25.0, 25.0),
                    generator.between(-50.0, 50.0),
                ];
            }
            TargetSpec {
                id: format!("t{number:03}"),
                attitude: match region {
                    Region::Sphere => AttitudeSpec::Quaternion(generator.quaternion()),
                    Region::Strip => near(middle, &mut generator),
                },
                zero_rate_axes: (rates == RateConditions::ZeroAboutZ)
                    .then_some([false, false, true]),
                ..TargetSpec::default()
            }
        })
        .collect();
    spec
}

/// Roll and pitch near the middle of a cluster, some yaw, degrees.
fn near(middle: [f64; 2], generator: &mut Generator) -> AttitudeSpec {
    let [roll, pitch] =
        middle.map(|angle| angle + generator.between(-CLUSTER_RADIUS_DEG, CLUSTER_RADIUS_DEG));
    AttitudeSpec::RollPitchYawDeg([roll, pitch, generator.between(-10.0, 10.0)])
}
