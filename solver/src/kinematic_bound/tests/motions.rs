//! Motions within a box of rates, made without the words of the search.

use crate::attitude::Attitude;
use nalgebra::Vector3;

type Arcs = Vec<(Vector3<f64>, f64)>;

/// A small generator of uniform numbers.
pub(super) struct Generator(u64);

impl Generator {
    pub(super) fn new(seed: u64) -> Self {
        Self(0x9E37_79B9_7F4A_7C15 ^ seed)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next() as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn axis(&mut self) -> usize {
        self.vector().iamax()
    }

    pub(super) fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-1.0, 1.0))
    }
}

/// Where arcs lead.
pub(super) fn end_of(arcs: &[(Vector3<f64>, f64)]) -> Attitude {
    arcs.iter()
        .fold(Attitude::identity(), |at, (rate, duration)| {
            at.retract(rate * *duration)
        })
}

/// A motion of one of several kinds, and whether it is so short that its extremal is surely one that
/// the search must match in time.
pub(super) fn random_motion(generator: &mut Generator, rates: [f64; 3]) -> (Arcs, bool) {
    let rates = Vector3::from(rates);
    let total = generator.between(0.05, 4.5) / rates.norm();
    match generator.next() % 4 {
        // Any rates, any times.
        0 => {
            let arcs = (0..4).map(|_| (rates.component_mul(&generator.vector()), 0.25 * total));
            (arcs.collect(), false)
        }
        // Rates at their limits.
        1 => {
            let arcs = (0..4).map(|_| {
                let signs = generator.vector().map(f64::signum);
                (
                    rates.component_mul(&signs),
                    generator.between(0.0, 0.4) * total,
                )
            });
            (arcs.collect(), false)
        }
        // Extremals, from any costate and from one near an axis.
        kind => {
            let mut costate = generator.vector();
            if kind == 3 {
                costate = costate * 0.1 + Vector3::ith(generator.axis(), 1.0);
            }
            (extremal(rates, costate, total), true)
        }
    }
}

/// Follows a costate, `M' = M x w`, `w_i = r_i sign(M_i)`, by small steps and bisection.
fn extremal(rates: Vector3<f64>, mut costate: Vector3<f64>, total: f64) -> Arcs {
    let mut arcs = Arcs::new();
    let mut left = total;
    let mut signs = costate.map(f64::signum);
    while left > 0.0 {
        let rate = rates.component_mul(&signs);
        let after = |time: f64| Attitude::from_rotation_vector(rate * time).to_body(costate);
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
