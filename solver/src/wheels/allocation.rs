//! Allocation of a torque or a momentum to the wheels.
//!
//! With more than three wheels `A x = y` has many solutions (see [`crate::wheels::array`]). Three are
//! common:
//!
//! * the pseudo-inverse `x = A^+ y`, of the least sum of squares (RW/CMG thesis, equation 87);
//! * the same in proportion, when a wheel would exceed its limit: all amounts are divided by the
//!   largest load, which keeps the direction (equation 93);
//! * the least load: a linear program minimises the largest share of a limit. It reaches the whole
//!   full envelope, the pseudo-inverse does not.
//!
//! In the thesis's example (equations 90 to 94) the pyramid's wheels could give `(1, 1, -1, 1)`, and
//! the pseudo-inverse in proportion gives two thirds of that.

use crate::math::convex::{ConvexProgram, Ending};
use crate::wheels::array::WheelArray;
use nalgebra::{DMatrix, DVector, Vector3};

/// The amounts of a demand that each wheel takes.
#[derive(Debug, Clone, PartialEq)]
pub struct DemandAllocation {
    /// One amount per wheel of the spacecraft, in the unit of the demand; zero for locked wheels.
    pub wheels: Vec<f64>,
    /// The largest share of a wheel's limit; above 1 the demand is outside of the limits.
    pub load: f64,
}

impl DemandAllocation {
    fn of(array: &WheelArray, amounts: &DVector<f64>) -> Self {
        Self {
            wheels: array.spread(amounts),
            load: array.load(amounts),
        }
    }

    /// The allocation within the limits: unchanged, or with all amounts reduced in proportion.
    #[must_use]
    pub fn in_proportion(&self) -> Self {
        let excess = self.load.max(1.0);
        Self {
            wheels: self.wheels.iter().map(|x| x / excess).collect(),
            load: self.load.min(1.0),
        }
    }
}

/// The allocation of the least sum of squares.
///
/// `demand` is `y`, body axes, in the unit of the array's limits.
#[must_use]
pub fn pseudo_inverse(array: &WheelArray, demand: &Vector3<f64>) -> DemandAllocation {
    let demand = DVector::from_column_slice(demand.as_slice());
    DemandAllocation::of(array, &(array.pseudo_inverse() * demand))
}

/// The allocation of the least load.
///
/// `demand` is `y`, body axes, in the unit of the array's limits. `None` when the linear program
/// could not be solved for numerical reasons.
#[must_use]
pub fn least_load(array: &WheelArray, demand: &Vector3<f64>) -> Option<DemandAllocation> {
    let scale = demand.amax();
    if scale == 0.0 {
        return Some(pseudo_inverse(array, demand));
    }
    // Loads relative to the weakest limit, so that the program's numbers are of order one.
    let ranges = array.ranges();
    let sides = || ranges.iter().map(|range| range.most.min(-range.least));
    let weakest = sides().fold(f64::INFINITY, f64::min);
    let weights: Vec<[f64; 2]> = ranges
        .iter()
        .map(|range| [weakest / range.most, -weakest / range.least])
        .collect();
    let shares = least_loaded(&array.axes(), &weights, *demand / scale)?;
    Some(DemandAllocation::of(array, &(shares * scale)))
}

/// Amounts along axes (columns, 3 x K) that sum to a demand with the least largest weighted size;
/// each has a weight above zero and one below.
pub(crate) fn least_loaded(
    axes: &DMatrix<f64>,
    weights: &[[f64; 2]],
    demand: Vector3<f64>,
) -> Option<DVector<f64>> {
    let count = weights.len();
    // Unknowns: the amounts, then the largest weighted size, which is the cost.
    let program = ConvexProgram {
        quadratic: None,
        cost: DVector::from_fn(count + 1, |i, _| if i == count { 1.0 } else { 0.0 }),
        equal: axes.clone().insert_column(count, 0.0),
        equal_to: DVector::from_column_slice(demand.as_slice()),
        below: DMatrix::from_fn(2 * count, count + 1, |row, column| {
            let weight = if row < count {
                weights[row][0]
            } else {
                -weights[row - count][1]
            };
            match column {
                column if column == count => -1.0,
                column if column == row % count => weight,
                _ => 0.0,
            }
        }),
        at_most: DVector::zeros(2 * count),
    };
    match program.minimise() {
        Ending::Solved(minimum) => {
            let amounts = minimum.unknowns.rows(0, count).into_owned();
            // The equations hold to solver accuracy only; the correction of least norm makes them exact.
            let residual = &program.equal_to - axes * &amounts;
            let correction = axes.clone().svd(true, true).solve(&residual, f64::EPSILON);
            Some(amounts + correction.ok()?)
        }
        Ending::Infeasible | Ending::Failed(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wheels::array::WheelRange;

    /// The square pyramid, each wheel giving up to one.
    fn pyramid() -> WheelArray {
        let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
        let axes = [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]];
        let ranges = axes.map(|axis| WheelRange::symmetric(axis.into(), 1.0));
        WheelArray::try_new(&ranges, "").unwrap()
    }

    fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        for (x, y) in found.iter().zip(expected) {
            assert!((x - y).abs() <= tolerance, "{found:?} is not {expected:?}");
        }
    }

    #[test]
    fn the_pseudo_inverse_gives_two_thirds_of_a_minor_vertex() {
        let array = pyramid();
        let demand = array.sum(&[1.0, 1.0, -1.0, 1.0]);
        assert_near(demand.as_slice(), &[1.633, 0.0, 1.155], 5e-4);
        let asked = pseudo_inverse(&array, &demand);
        assert_near(&asked.wheels, &[1.5, 0.5, -0.5, 0.5], 1e-14);
        assert!((asked.load - 1.5).abs() < 1e-14);
        let given = asked.in_proportion();
        let third = 1.0 / 3.0;
        assert_near(&given.wheels, &[1.0, third, -third, third], 1e-14);
        let reached = array.sum(&given.wheels);
        assert_near(reached.as_slice(), &[1.089, 0.0, 0.770], 5e-4);
        assert!((reached - demand * (2.0 / 3.0)).norm() < 1e-14);
    }

    #[test]
    fn the_least_load_reaches_the_minor_vertex() {
        let array = pyramid();
        let best = least_load(&array, &array.sum(&[1.0, 1.0, -1.0, 1.0])).unwrap();
        assert_near(&best.wheels, &[1.0, 1.0, -1.0, 1.0], 1e-7);
        assert!((best.load - 1.0).abs() < 1e-7);
        assert!(best.in_proportion().load <= 1.0);
    }

    #[test]
    fn loads_of_both_allocations_are_the_shares_of_their_envelopes() {
        let (s, c) = (0.6, 0.8);
        let axes = [
            [s, 0.0, c],
            [0.0, s, c],
            [-s, 0.1, c],
            [0.0, -s, c],
            [1.0, 0.2, 0.0],
        ];
        let ranges = [
            (-1.0, 1.0),
            (-0.5, 1.5),
            (-2.0, 0.7),
            (-1.0, 3.0),
            (-0.2, 0.3),
        ];
        let ranges: Vec<_> = axes
            .iter()
            .zip(ranges)
            .map(|(&axis, (least, most))| WheelRange {
                axis: axis.into(),
                least,
                most,
            })
            .collect();
        let array = WheelArray::try_new(&ranges, "").unwrap();
        let envelopes = array.envelopes();
        for demand in [
            [1.0, 0.0, 0.0],
            [-0.3, 0.2, 0.9],
            [0.4, -1.0, -2.0],
            [0.0, 0.0, -1.0],
        ] {
            let demand = Vector3::from(demand);
            let best = least_load(&array, &demand).unwrap();
            assert!((array.sum(&best.wheels) - demand).norm() < 1e-12);
            let share = envelopes.full.share(&demand);
            assert!(
                (best.load - share).abs() < 1e-7,
                "{} is not {share}",
                best.load
            );
            let simple = pseudo_inverse(&array, &demand);
            let share = envelopes.pseudo_inverse.share(&demand);
            assert!(
                (simple.load - share).abs() < 1e-12,
                "{} is not {share}",
                simple.load
            );
            assert!(best.load < simple.load + 1e-7);
        }
    }

    #[test]
    fn a_demand_of_zero_is_allocated_as_zeros() {
        let best = least_load(&pyramid(), &Vector3::zeros()).unwrap();
        assert_eq!(best.wheels, [0.0; 4]);
        assert!(best.load.total_cmp(&0.0).is_eq());
    }
}
