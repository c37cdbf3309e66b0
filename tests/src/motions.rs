//! Motions within a box of body rates, generated independently of the kinematic bound, and other sets of rates.

use crate::random::Generator;
use nalgebra::{UnitQuaternion, Vector3};

/// Arcs at a constant rate: rad/s in body axes, and seconds.
pub type ConstantRateArcs = Vec<(Vector3<f64>, f64)>;

/// How a motion is generated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// Any rates, any times.
    Any,
    /// Rates in corners of the box, any times.
    Corners,
    /// A corner, a rate with a component of zero, a corner.
    Dwell,
    /// An extremal, from any costate.
    Extremal,
    /// An extremal whose costate stays near a body axis: many switches.
    NearAxis,
}

impl MotionKind {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Any,
        Self::Corners,
        Self::Dwell,
        Self::Extremal,
        Self::NearAxis,
    ];

    /// Whether motions obey Pontryagin's principle. Longer ones need not be shortest ones.
    #[must_use]
    pub fn is_extremal(self) -> bool {
        matches!(self, Self::Extremal | Self::NearAxis)
    }
}

/// The attitude at the end of arcs from the identity.
#[must_use]
pub fn end_of(arcs: &[(Vector3<f64>, f64)]) -> UnitQuaternion<f64> {
    let all = arcs.iter().fold(
        UnitQuaternion::identity(),
        |at: UnitQuaternion<f64>, (rate, duration)| {
            at * UnitQuaternion::from_scaled_axis(rate * *duration)
        },
    );
    UnitQuaternion::new_normalize(all.into_inner())
}

/// A motion with `|w_i| <= rates_i` that turns by at most the given angle, rad, at the norm of `rates`;
/// angles above 4.5 give no further shortest motions.
pub fn motion(
    generator: &mut Generator,
    kind: MotionKind,
    rates: Vector3<f64>,
    longest_rad: f64,
) -> ConstantRateArcs {
    let total = generator.between(0.01, 1.0) * longest_rad / rates.norm();
    let corner = |generator: &mut Generator| {
        let signs = Vector3::from(generator.vector(-1.0, 1.0)).map(f64::signum);
        rates.component_mul(&signs)
    };
    match kind {
        MotionKind::Any => (0..4)
            .map(|_| {
                let share = Vector3::from(generator.vector(-1.0, 1.0));
                (rates.component_mul(&share), 0.25 * total)
            })
            .collect(),
        MotionKind::Corners => (0..4)
            .map(|_| (corner(generator), generator.between(0.0, 0.4) * total))
            .collect(),
        MotionKind::Dwell => (0..3)
            .map(|arc| {
                let mut rate = corner(generator);
                if arc == 1 {
                    rate[generator.below(3)] = 0.0;
                }
                (rate, generator.between(0.0, 0.6) * total)
            })
            .collect(),
        MotionKind::Extremal => extremal(rates, generator.vector(-1.0, 1.0).into(), total),
        MotionKind::NearAxis => {
            let axis = Vector3::ith(generator.below(3), 1.0);
            let off = Vector3::from(generator.vector(-0.1, 0.1));
            extremal(rates, axis + off, total)
        }
    }
}

/// Integrates the costate equation `M' = M x w`, `w_i = r_i sign(M_i)`, in small steps with bisection at
/// switches.
fn extremal(rates: Vector3<f64>, mut costate: Vector3<f64>, total: f64) -> ConstantRateArcs {
    let mut arcs = ConstantRateArcs::new();
    let mut left = total;
    let mut signs = costate.map(f64::signum);
    while left > 0.0 {
        let rate = rates.component_mul(&signs);
        let after = |time: f64| {
            UnitQuaternion::from_scaled_axis(rate * time).inverse_transform_vector(&costate)
        };
        let inside = |time: f64| after(time).component_mul(&signs).min() >= -1e-12;
        let step = 0.01 / rate.norm();
        let mut high = step;
        while high < left && inside(high) {
            high += step;
        }
        let duration = if high >= left && inside(left) {
            left
        } else {
            let mut low = high - step;
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if inside(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            high.min(left)
        };
        arcs.push((rate, duration));
        left -= duration;
        costate = after(duration);
        let flipped = costate.component_mul(&signs).imin();
        signs[flipped] = -signs[flipped];
    }
    arcs
}

/// Half-spaces `|f . w| <= 1` of some kind: of arrays of wheels, of weighted norms, or in any directions.
#[must_use]
pub fn half_spaces(number: u64, random: &mut Generator) -> Vec<Vector3<f64>> {
    let direction = |random: &mut Generator| Vector3::from(random.direction());
    let logarithmic =
        |random: &mut Generator| Vector3::from([(); 3].map(|()| random.logarithmic(0.2, 1.0)));
    match number % 3 {
        0 => {
            let wheels: Vec<_> = (0..3 + number % 4).map(|_| direction(random)).collect();
            let pairs = (0..wheels.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
            pairs
                .filter_map(|[i, j]| wheels[i].cross(&wheels[j]).try_normalize(0.1))
                .map(|f| f / wheels.iter().map(|wheel| wheel.dot(&f).abs()).sum::<f64>())
                .collect()
        }
        1 => {
            let weight = random.between(0.1, 0.8);
            let rates = logarithmic(random);
            let mixed = [0, 1].into_iter().flat_map(|axis| {
                [1.0, -1.0].map(|sign| {
                    Vector3::ith(axis, (1.0 - weight) / rates[axis])
                        + Vector3::z() * (sign * weight / rates.z)
                })
            });
            mixed.chain([Vector3::z() / rates.z]).collect()
        }
        _ => {
            let others = 3 + number % 6;
            let any: Vec<_> = (0..others)
                .map(|_| direction(random) * random.between(0.7, 1.3))
                .collect();
            let rates = logarithmic(random);
            let axes = (0..3).map(|i| Vector3::ith(i, 1.0 / rates[i]));
            axes.chain(any).collect()
        }
    }
}
