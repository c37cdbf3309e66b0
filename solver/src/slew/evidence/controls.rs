//! The controls over which the minimum principle minimises, and how close the torques are to the
//! minimum.
//!
//! Where every torque is chosen by itself, each is a control within its own range. Torques allocated by
//! the pseudo-inverse are `u = B v` with `B = A^+` and three controls, the torque `v = A u` on all wheels
//! together in body axes, within the polytope given by the ranges of all wheels. The switching function
//! is the Hamiltonian's derivative by the controls,
//!
//! ```text
//!   dH/du   = r + dl/du                          every torque by itself
//!   dH/dv   = B^T (r + dl/du)                    torques allocated by the pseudo-inverse
//! ```
//!
//! and at a minimum minus the switching function is a non-negative combination of the outward normals
//! of the active limits,
//!
//! ```text
//!   dH/dv + sum of mu_i s_i b_i = 0,   mu_i >= 0        b_i: row i of B, s_i = 1 at the upper limit
//! ```
//!
//! which for torques chosen by themselves says that the switching function of a torque at its upper
//! limit is not positive and that at its lower limit not negative. The torque of a wheel at a speed
//! limit is determined by the limit: the multiplier of its row has either sign.

use super::cost::RunningCost;
use super::costate::Costate;
use crate::math::cone;
use crate::slew::flow::MotionSample;
use crate::slew::spec::WheelAllocation;
use nalgebra::{Matrix3, Vector3};

/// Torques tried for a lower Hamiltonian: over a wheel's range, or on a line to a corner.
const TRIALS: usize = 64;
/// Rounds of line searches towards all corners.
const ROUNDS: usize = 3;
/// Relative excess over a range that counts as rounding.
const ROUNDING: f64 = 1e-9;
/// Squared share of a direction outside a span below which it counts as lying in it.
const SPANNED: f64 = 1e-18;

/// The controls of a slew.
pub(super) enum Controls {
    /// The torque of every wheel.
    Wheels,
    /// The torque on all wheels together, body axes.
    Shared(SharedControls),
}

/// The wheels' torques as functions of three controls, by the pseudo-inverse.
pub(super) struct SharedControls {
    /// Rows `b_i` of the pseudo-inverse.
    rows: Vec<Vector3<f64>>,
    /// Triples of wheels whose torques determine the controls, each with the matrix that maps them.
    triples: Vec<([usize; 3], Matrix3<f64>)>,
}

impl Controls {
    pub(super) fn new(allocation: WheelAllocation, running: &RunningCost<'_>) -> Self {
        match allocation {
            WheelAllocation::Free => Self::Wheels,
            WheelAllocation::PseudoInverse => {
                let inverse = &running.dynamics().axes_inverse;
                let rows = inverse.row_iter();
                let rows = rows.map(|row| Vector3::new(row[0], row[1], row[2]));
                Self::Shared(SharedControls::new(rows.collect()))
            }
        }
    }

    /// Derivatives by the controls, given those by the wheels' torques.
    pub(super) fn onto_controls(&self, wheels: impl Iterator<Item = f64>) -> Vec<f64> {
        match self {
            Self::Wheels => wheels.collect(),
            Self::Shared(shared) => shared.onto_controls(wheels).as_slice().to_vec(),
        }
    }

    /// The derivatives of the Hamiltonian by the controls.
    pub(super) fn switching(
        &self,
        p: &Costate,
        at: &MotionSample,
        running: &RunningCost<'_>,
    ) -> Vec<f64> {
        self.onto_controls(by_torques(p, at, running))
    }

    /// Difference of the Hamiltonian from its minimum over the torques; wheels at a speed limit keep
    /// theirs.
    pub(super) fn gap(&self, p: &Costate, at: &MotionSample, running: &RunningCost<'_>) -> f64 {
        let held = running.held(at);
        let cost = |wheel: usize, torque: f64| {
            running.of_wheel(wheel, torque, at) + p.momenta[wheel] * torque
        };
        match self {
            Self::Wheels => {
                let free = (0..held.len()).filter(|wheel| !held[*wheel]);
                free.map(|wheel| {
                    let [least, most] = running.range(wheel, at);
                    let trials = (0..=TRIALS).map(|i| least + (most - least) * share(i));
                    let best = trials.map(|u| cost(wheel, u)).fold(f64::INFINITY, f64::min);
                    (cost(wheel, at.torques[wheel]) - best).max(0.0)
                })
                .sum()
            }
            Self::Shared(shared) => {
                let range = |wheel: usize| match (held[wheel], at.torques[wheel]) {
                    (true, torque) => [torque; 2],
                    (false, _) => running.range(wheel, at),
                };
                let ranges: Vec<_> = (0..held.len()).map(range).collect();
                let from = &running.dynamics().axes * &at.torques;
                shared.gap(from, &ranges, cost)
            }
        }
    }

    /// Size of the switching function of torques at limits, and of its part with the sign that the
    /// minimum principle prescribes.
    pub(super) fn limited(
        &self,
        p: &Costate,
        at: &MotionSample,
        running: &RunningCost<'_>,
    ) -> [f64; 2] {
        let held = running.held(at);
        let sides = (0..held.len()).map(|wheel| running.side(wheel, at).filter(|_| !held[wheel]));
        let pulls = by_torques(p, at, running);
        match self {
            Self::Wheels => sides
                .zip(pulls)
                .fold([0.0; 2], |[all, right], (side, pull)| {
                    let size = side.map_or(0.0, |_| pull.abs());
                    let agrees = side.is_some_and(|side| side * pull <= 0.0);
                    [all + size, right + if agrees { size } else { 0.0 }]
                }),
            Self::Shared(shared) => {
                let sides: Vec<_> = sides.collect();
                shared.limited(&shared.onto_controls(pulls), &sides, &held)
            }
        }
    }
}

/// `r + dl/du` of every wheel.
fn by_torques(
    p: &Costate,
    at: &MotionSample,
    running: &RunningCost<'_>,
) -> impl Iterator<Item = f64> {
    (0..at.speeds.len()).map(|wheel| p.momenta[wheel] + running.by_torque(wheel, at))
}

fn share(trial: usize) -> f64 {
    trial as f64 / TRIALS as f64
}

impl SharedControls {
    fn new(rows: Vec<Vector3<f64>>) -> Self {
        let mut triples = Vec::new();
        for (i, a) in rows.iter().enumerate() {
            for (j, b) in rows.iter().enumerate().skip(i + 1) {
                for (k, c) in rows.iter().enumerate().skip(j + 1) {
                    let three = Matrix3::from_columns(&[*a, *b, *c]).transpose();
                    let size: f64 = [a, b, c].map(Vector3::norm_squared).iter().product();
                    let inverse = (three.determinant().powi(2) > SPANNED * size)
                        .then(|| three.try_inverse())
                        .flatten();
                    triples.extend(inverse.map(|inverse| ([i, j, k], inverse)));
                }
            }
        }
        Self { rows, triples }
    }

    fn onto_controls(&self, wheels: impl Iterator<Item = f64>) -> Vector3<f64> {
        self.rows.iter().zip(wheels).map(|(row, x)| row * x).sum()
    }

    /// Corners of the polytope given by the ranges of all torques: three torques are at limits, and no
    /// other is beyond.
    fn corners(&self, ranges: &[[f64; 2]]) -> Vec<Vector3<f64>> {
        let within = |control: &Vector3<f64>| {
            self.rows.iter().zip(ranges).all(|(row, [least, most])| {
                let (torque, rounding) = (row.dot(control), ROUNDING * (most.abs() + least.abs()));
                torque >= least - rounding && torque <= most + rounding
            })
        };
        let ends = self.triples.iter().flat_map(|(wheels, inverse)| {
            (0..8_usize).map(move |choice| {
                let end = |i: usize| ranges[wheels[i]][(choice >> i) & 1];
                inverse * Vector3::new(end(0), end(1), end(2))
            })
        });
        ends.filter(within).collect()
    }

    /// Difference of a convex cost of the wheels from its minimum within the ranges.
    fn gap(
        &self,
        from: Vector3<f64>,
        ranges: &[[f64; 2]],
        cost: impl Fn(usize, f64) -> f64,
    ) -> f64 {
        let value = |control: &Vector3<f64>| -> f64 {
            let torques = self.rows.iter().map(|row| row.dot(control)).enumerate();
            torques.map(|(wheel, torque)| cost(wheel, torque)).sum()
        };
        let corners = self.corners(ranges);
        let now = value(&from);
        let (mut best, mut at) = (now, from);
        for _ in 0..ROUNDS {
            let begin = at;
            for corner in &corners {
                for trial in 1..=TRIALS {
                    let control = begin + (corner - begin) * share(trial);
                    let found = value(&control);
                    if found < best {
                        (best, at) = (found, control);
                    }
                }
            }
        }
        now - best
    }

    /// See [`Controls::limited`]: `pull` is the switching function.
    fn limited(&self, pull: &Vector3<f64>, sides: &[Option<f64>], held: &[bool]) -> [f64; 2] {
        let holding: Vec<_> = self
            .rows
            .iter()
            .zip(held)
            .filter(|(_, held)| **held)
            .collect();
        let span: Vec<_> = holding
            .iter()
            .flat_map(|(row, _)| [**row, -**row])
            .collect();
        // The part of the switching function in the span of the held wheels' rows is compensated by
        // their multipliers, which have either sign.
        let beside = |v: &Vector3<f64>| {
            let rest = v - cone::nearest(&span, v);
            if rest.norm_squared() > SPANNED * v.norm_squared() {
                rest
            } else {
                Vector3::zeros()
            }
        };
        let pull = beside(pull);
        let normals = self.rows.iter().zip(sides);
        let inwards: Vec<_> = normals
            .filter_map(|(row, side)| side.map(|side| -beside(row) * side))
            .filter(|normal| *normal != Vector3::zeros())
            .collect();
        let either: Vec<_> = inwards
            .iter()
            .flat_map(|normal| [*normal, -normal])
            .collect();
        let belongs = cone::nearest(&either, &pull);
        let wrong = (belongs - cone::nearest(&inwards, &belongs)).norm();
        let size = belongs.norm();
        [size, (size - wrong).max(0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows of the published pyramid's pseudo-inverse.
    fn pyramid() -> SharedControls {
        let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
        let rows = [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]];
        // A A^T = 4/3.
        SharedControls::new(rows.map(|axis| Vector3::from(axis) * 0.75).to_vec())
    }

    #[test]
    fn corners_of_the_pyramid_are_those_of_an_octahedron() {
        // u_0 + u_2 = u_1 + u_3 cuts the cube of four torques at the six corners that lie on it.
        let corners = pyramid().corners(&[[-1.0, 1.0]; 4]);
        let mut distinct: Vec<Vector3<f64>> = Vec::new();
        for corner in corners {
            if distinct.iter().all(|known| (known - corner).norm() > 1e-9) {
                distinct.push(corner);
            }
        }
        assert_eq!(distinct.len(), 6, "{distinct:?}");
    }

    #[test]
    fn the_gap_of_a_cost_is_its_distance_from_the_minimum() {
        let shared = pyramid();
        let ranges = [[-1.0, 1.0]; 4];
        let linear = [0.3, -0.2, 0.1, 0.05];
        let cost = |wheel: usize, torque: f64| linear[wheel] * torque;
        let corners = shared.corners(&ranges);
        let value = |v: &Vector3<f64>| {
            let torques = shared.rows.iter().map(|row| row.dot(v));
            torques.zip(linear).map(|(u, c)| u * c).sum::<f64>()
        };
        let best = corners.iter().map(value).fold(f64::INFINITY, f64::min);
        let from = Vector3::new(0.1, -0.2, 0.05);
        let gap = shared.gap(from, &ranges, cost);
        assert!((gap - (value(&from) - best)).abs() < 1e-12);
        let lowest = corners.iter().find(|v| value(v) <= best + 1e-12);
        assert!(shared.gap(*lowest.expect("a corner"), &ranges, cost) < 1e-12);
        // What is curved has its minimum inside: at v = (0.2, 0, 0).
        let wanted: Vec<f64> = shared.rows.iter().map(|row| row.x * 0.2).collect();
        let bowl = |wheel: usize, torque: f64| (torque - wanted[wheel]).powi(2);
        assert!(shared.gap(Vector3::x() * 0.2, &ranges, bowl) < 1e-15);
        assert!(shared.gap(Vector3::x() * -0.5, &ranges, bowl) > 0.9 * 0.49 * 0.75);
    }

    #[test]
    fn a_switching_function_along_normals_of_active_limits_agrees_with_the_principle() {
        let shared = pyramid();
        let rows = &shared.rows;
        let none = [false; 4];
        let sides = [Some(1.0), Some(-1.0), None, None];
        let right = -rows[0] * 0.4 + rows[1] * 0.3;
        let [size, agrees] = shared.limited(&right, &sides, &none);
        assert!((size - right.norm()).abs() < 1e-12 && (agrees - size).abs() < 1e-12);
        let [size, agrees] = shared.limited(&-right, &sides, &none);
        assert!(size > 0.1 && agrees < 1e-12);
        // A part along the row of a held wheel is compensated, whatever its sign.
        let held = [false, false, true, false];
        for along in [-2.0, 2.0] {
            let [size, agrees] = shared.limited(&(right + rows[2] * along), &sides, &held);
            assert!(size > 0.1 && (agrees - size).abs() < 1e-9);
        }
        let [size, _] = shared.limited(&rows[2], &[None; 4], &held);
        assert!(size < 1e-12);
    }
}
