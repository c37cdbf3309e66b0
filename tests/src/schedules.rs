//! Random schedules: many targets for the published spacecraft, in any number.
//!
//! Two kinds of places to be, each under two kinds of conditions on the rates there. A seed repeats
//! a schedule exactly, and the targets of a shorter one are the first of a longer one.

use crate::experiment_a_spec;
use crate::random::Generator;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec};

/// Where the targets are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// Anywhere: attitudes without preference.
    Sphere,
    /// A strip on the ground below an orbit: clusters of places within 50 degrees before and behind
    /// and 25 degrees to the sides, the camera's axis turned at will by up to 10 degrees.
    Strip,
}

/// What the rates must be at a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rates {
    /// No turning at all.
    AllZero,
    /// None about the camera's axis, z.
    ZeroAboutZ,
}

/// Targets of a cluster, and how far they are from its middle, degrees.
const CLUSTER: usize = 5;
const CLUSTER_RADIUS_DEG: f64 = 6.0;

/// So many targets for the published spacecraft, from the identity at rest and back there.
#[must_use]
pub fn schedule(region: Region, rates: Rates, targets: usize, seed: u64) -> ScenarioSpec {
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
                zero_rate_axes: (rates == Rates::ZeroAboutZ).then_some([false, false, true]),
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
