//! Random scenarios that a seed repeats exactly.

use crate::wheel;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec, WheelSpec,
};
use std::f64::consts::TAU;

/// Smallest determinant of the best triple of unit wheel axes: arrays nearer to a plane are not
/// generated, since their infeasible scenarios do not test the solver.
const MIN_SPAN: f64 = 0.3;

/// Marsaglia's xorshift generator with a final multiplication.
#[derive(Debug, Clone)]
pub struct Generator(u64);

impl Generator {
    /// A generator whose numbers follow from the seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        // The state must not be zero, and close seeds must give different numbers.
        let mut generator = Self(seed.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        for _ in 0..8 {
            generator.next();
        }
        generator
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// A number between two bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A positive number between two bounds with a uniform logarithm.
    pub fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Three numbers between two bounds.
    pub fn vector(&mut self, low: f64, high: f64) -> [f64; 3] {
        [(); 3].map(|()| self.between(low, high))
    }

    /// A natural number below a count.
    ///
    /// # Panics
    ///
    /// When the count is zero.
    pub fn below(&mut self, count: usize) -> usize {
        let count = count as u64;
        usize::try_from(self.next() % count).expect("less than a count of things in memory")
    }

    /// True or false with equal probability.
    pub fn coin(&mut self) -> bool {
        self.below(2) == 0
    }

    /// A unit vector, uniform over directions.
    pub fn direction(&mut self) -> [f64; 3] {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.between(0.0, TAU).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        [radius * cos, radius * sin, z]
    }

    /// A unit quaternion, uniform over attitudes.
    pub fn quaternion(&mut self) -> [f64; 4] {
        let share = self.between(0.0, 1.0);
        let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
        let (first, second) = (self.between(0.0, TAU), self.between(0.0, TAU));
        [
            a * first.sin(),
            a * first.cos(),
            b * second.sin(),
            b * second.cos(),
        ]
    }

    /// A target at a random attitude with one of the four kinds of rate conditions: rest, no rate about
    /// z, no condition, and bounds.
    pub fn target(&mut self, id: String, rate_kind: usize) -> TargetSpec {
        let bounds = rate_kind == 3;
        TargetSpec {
            id,
            attitude: AttitudeSpec::Quaternion(self.quaternion()),
            zero_rate_axes: match rate_kind {
                1 => Some([false, false, true]),
                2 => Some([false; 3]),
                _ => None,
            },
            rate_min_rad_s: bounds.then_some([Some(-0.01), Some(0.002), None]),
            rate_max_rad_s: bounds.then_some([Some(0.01), None, Some(0.005)]),
            ..TargetSpec::default()
        }
    }

    /// A random body with 3 to 6 random wheels that hold some momentum; with more than three wheels one
    /// may be locked while it spins.
    pub fn spacecraft(&mut self) -> (SpacecraftSpec, StateSpec) {
        let count = 3 + self.below(4);
        let locked = (count > 3 && self.coin()).then_some(count - 1);
        let enabled = count - usize::from(locked.is_some());
        let mut wheels = self.wheel_array(count, enabled, Self::wheel);
        if let Some(locked) = locked {
            wheels[locked].enabled = false;
        }
        let speeds = wheels.iter().map(|wheel| {
            let limit = wheel.max_speed_rad_s.unwrap_or(500.0);
            self.between(-0.15, 0.15) * limit
        });
        let start = StateSpec {
            wheel_speed_rad_s: Some(speeds.collect()),
            ..StateSpec::default()
        };
        let limits = [(); 3].map(|()| self.coin().then(|| self.between(0.02, 0.1)));
        let spacecraft = SpacecraftSpec {
            inertia_kg_m2: self.inertia(6.5, 12.0, true),
            max_body_rate_rad_s: limits,
            max_body_rate_norm_rad_s: self.coin().then(|| self.between(0.03, 0.1)),
            wheels,
            ..SpacecraftSpec::default()
        };
        (spacecraft, start)
    }

    /// A spacecraft as from [`Self::spacecraft`] with one or two targets, with or without an end.
    pub fn single_slews(&mut self) -> ScenarioSpec {
        let (spacecraft, start) = self.spacecraft();
        let count = 1 + self.below(2);
        ScenarioSpec {
            targets: (0..count)
                .map(|i| {
                    let kind = self.below(2);
                    self.target(format!("t{i}"), kind)
                })
                .collect(),
            end: self.coin().then(|| StateSpec {
                attitude: AttitudeSpec::Quaternion(self.quaternion()),
                ..StateSpec::default()
            }),
            spacecraft,
            start,
            ..ScenarioSpec::default()
        }
    }

    fn wheel(&mut self) -> WheelSpec {
        let inertia = self.between(0.000_3, 0.001);
        let torque = self.between(0.01, 0.04);
        let speed = self.between(400.0, 700.0);
        WheelSpec {
            min_torque_nm: Some(-self.between(0.01, 0.04)),
            max_speed_rad_s: (self.below(8) > 0).then_some(speed),
            ..wheel(self.direction(), inertia, torque, speed)
        }
    }

    /// Wheels of which the first `enabled` span space well.
    pub fn wheel_array(
        &mut self,
        count: usize,
        enabled: usize,
        wheel: impl Fn(&mut Self) -> WheelSpec,
    ) -> Vec<WheelSpec> {
        loop {
            let wheels: Vec<_> = (0..count).map(|_| wheel(self)).collect();
            if widest_span(&wheels[..enabled]) > MIN_SPAN {
                return wheels;
            }
        }
    }

    /// Principal moments between two bounds, kg m² (a body can have them when the upper is at most
    /// twice the lower), about the body axes or about random ones.
    pub fn inertia(&mut self, low: f64, high: f64, turned: bool) -> [[f64; 3]; 3] {
        let moments = self.vector(low, high);
        let turn = if turned {
            Attitude::from_xyzw(self.quaternion()).unwrap_or_else(Attitude::identity)
        } else {
            Attitude::identity()
        };
        let axes = turn.matrix();
        // Mirrored entries are computed in the same way, so that the matrix is exactly symmetric.
        let entry = |i: usize, j: usize| {
            (0..3)
                .map(|k| axes[(i.min(j), k)] * moments[k] * axes[(i.max(j), k)])
                .sum()
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }
}

/// Largest volume between three of the axes.
fn widest_span(wheels: &[WheelSpec]) -> f64 {
    let mut widest: f64 = 0.0;
    for (i, first) in wheels.iter().enumerate() {
        for (j, second) in wheels.iter().enumerate().skip(i + 1) {
            for third in &wheels[j + 1..] {
                widest = widest.max(determinant([first.axis, second.axis, third.axis]).abs());
            }
        }
    }
    widest
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::scenario::Scenario;

    #[test]
    fn equal_seeds_give_equal_scenarios_and_different_seeds_different_ones() {
        let of = |seed| Generator::new(seed).single_slews();
        assert_eq!(of(7), of(7));
        assert_ne!(of(7), of(8));
    }

    #[test]
    fn random_scenarios_are_valid() {
        for seed in 0..200 {
            let spec = Generator::new(seed).single_slews();
            assert!(Scenario::try_new(&spec).is_ok(), "seed {seed}");
        }
    }
}
