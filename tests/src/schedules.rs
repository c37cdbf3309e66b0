//! Random schedules: any number of targets for the published spacecraft.
//!
//! There are two regions of targets, each with two kinds of rate conditions. A seed gives the same
//! schedule every time, and the targets of a shorter schedule are the first of a longer one.

use crate::experiment_a_spec;
use crate::random::Generator;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec, WindowSpec};

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

/// Targets with windows and values in a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// Rate conditions at the targets.
    pub rates: RateConditions,
    /// Number of targets.
    pub targets: usize,
    /// When the schedule ends at the latest, s.
    pub duration_s: f64,
    /// What the random numbers follow from.
    pub seed: u64,
}

/// Targets on a strip, each with a window of 60 to 120 s somewhere in the pass and a value of 1 to 9.
#[must_use]
pub fn pass(pass: Pass) -> ScenarioSpec {
    let mut spec = schedule(Region::Strip, pass.rates, pass.targets, pass.seed);
    let mut generator = Generator::new(pass.seed + 1000);
    spec.latest_end_s = Some(pass.duration_s);
    for target in &mut spec.targets {
        let length = generator.between(60.0, 120.0);
        let from = generator.between(0.0, pass.duration_s - length);
        target.windows = Some(vec![WindowSpec {
            from_s: Some(from),
            to_s: Some(from + length),
            ..WindowSpec::default()
        }]);
        target.value = Some(1.0 + generator.below(9) as f64);
    }
    spec
}

/// Roll and pitch near the middle of a cluster, some yaw, degrees.
fn near(middle: [f64; 2], generator: &mut Generator) -> AttitudeSpec {
    let [roll, pitch] =
        middle.map(|angle| angle + generator.between(-CLUSTER_RADIUS_DEG, CLUSTER_RADIUS_DEG));
    AttitudeSpec::RollPitchYawDeg([roll, pitch, generator.between(-10.0, 10.0)])
}
