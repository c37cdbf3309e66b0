//! Rigid-body dynamics with the momentum eliminated.
//!
//! Without external torque the total momentum `H` is constant in the reference frame, so with
//! `h_i = I_i (W_i + a_i . w)`, the momentum of enabled wheel `i` about its axis,
//!
//! ```text
//!   J_eff w = R(q)^T H - h_locked - A h,      h_i' = u_i,      q' = 1/2 q (x) [w, 0]
//! ```
//!
//! The state is `(q, h)`: three plus `K` numbers, of which `h` is a plain integral of the torque.
//! Speed limits become limits on `h_i / I_i - a_i . w`. Torque and speed limits are multiplied here
//! by the shares that a plan may use ([`Authority`]), and nowhere else.

pub(crate) mod facets;

use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use crate::model::scenario::Start;
use crate::model::spacecraft::Spacecraft;
use crate::model::spec::OptionsSpec;
use crate::model::wheel_axes::greatest_share;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX, Vector3};

/// An enabled wheel with the limits that a plan may use.
#[derive(Debug, Clone)]
pub(crate) struct Actuator {
    /// Position among all wheels of the spacecraft.
    pub(crate) index: usize,
    /// `a_i`.
    pub(crate) axis: Vector3<f64>,
    /// `I_i`, kg m².
    pub(crate) inertia: f64,
    /// Least torque, N m.
    pub(crate) min_torque: f64,
    /// Greatest torque, N m.
    pub(crate) max_torque: f64,
    /// Speed limit, rad/s; may be infinite.
    pub(crate) max_speed: f64,
}

/// Shares of the wheels' limits that a plan may use, in `(0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Authority {
    /// Of every torque limit.
    pub(crate) torque: f64,
    /// Of every speed limit.
    pub(crate) momentum: f64,
}

impl Authority {
    /// The shares that options of a solve allow.
    pub(crate) fn of(options: &OptionsSpec) -> Self {
        Self {
            torque: options.torque_authority,
            momentum: options.momentum_authority,
        }
    }
}

/// The dynamics of one spacecraft with its momentum.
#[derive(Debug, Clone)]
pub(crate) struct Dynamics {
    /// The enabled wheels.
    pub(crate) actuators: Vec<Actuator>,
    /// `A`: their axes as columns.
    pub(crate) axes: Matrix3xX<f64>,
    /// Pseudo-inverse of `A`.
    pub(crate) axes_inverse: DMatrix<f64>,
    /// Orthonormal columns that span the null space of `A`.
    pub(crate) null_space: DMatrix<f64>,
    /// `J_eff`, kg m².
    pub(crate) inertia: Matrix3<f64>,
    /// Its inverse.
    pub(crate) inertia_inverse: Matrix3<f64>,
    /// `J^-1`, wheels locked, 1/(kg m²).
    locked_inertia_inverse: Matrix3<f64>,
    /// Momentum of the locked wheels relative to the body, body axes, N m s.
    pub(crate) locked_momentum: Vector3<f64>,
    /// Total momentum in the reference frame, N m s.
    pub(crate) momentum: Vector3<f64>,
    /// Rate limit per axis, rad/s; may be infinite.
    pub(crate) max_rate: Vector3<f64>,
    /// Limit of the rate's norm, rad/s; may be infinite.
    pub(crate) max_rate_norm: f64,
    /// Cones, in the reference frame, that limit the attitude.
    pub(crate) cones: Vec<ForbiddenCone>,
}

/// Total momentum below this fraction of the sum of its terms counts as zero, so that rounding in
/// the caller's numbers does not prevent the simpler dynamics.
const NEGLIGIBLE_MOMENTUM: f64 = 1e-13;

/// A function of directions in the body, evaluated along each of three axes, given as columns.
pub(crate) fn along(axes: &Matrix3<f64>, quantity: impl Fn(&Vector3<f64>) -> f64) -> Vector3<f64> {
    Vector3::from_fn(|i, _| quantity(&axes.column(i).into_owned()))
}

/// Largest component along a direction of vectors whose components have these largest sizes.
pub(crate) fn component(direction: &Vector3<f64>, limits: &Vector3<f64>) -> f64 {
    let parts = direction.iter().zip(limits);
    // A component orthogonal to the direction does not contribute, even if it is infinite.
    parts.fold(0.0, |sum, (share, limit)| {
        sum + if *share == 0.0 {
            0.0
        } else {
            share.abs() * limit
        }
    })
}

impl Dynamics {
    /// The dynamics of a spacecraft with the momentum of a state, within the shares of its limits
    /// that a plan may use.
    pub(crate) fn of(spacecraft: &Spacecraft, start: &Start, authority: Authority) -> Self {
        let actuators: Vec<Actuator> = spacecraft
            .enabled_wheels()
            .map(|(index, wheel)| Actuator {
                index,
                axis: wheel.axis,
                inertia: wheel.inertia,
                min_torque: wheel.min_torque * authority.torque,
                max_torque: wheel.max_torque * authority.torque,
                max_speed: wheel.max_speed * authority.momentum,
            })
            .collect();
        let columns: Vec<_> = actuators.iter().map(|wheel| wheel.axis).collect();
        let axes = Matrix3xX::from_columns(&columns);
        let axes_inverse = spacecraft.axes_inverse().clone();
        let null_space = null_space(&axes, &axes_inverse);
        let spins = spacecraft.wheels().iter().zip(&start.wheel_speed);
        let (mut locked_momentum, mut turnover) = (Vector3::zeros(), 0.0);
        for (wheel, speed) in spins {
            let spin = wheel.axis * (wheel.inertia * speed);
            turnover += spin.norm();
            if !wheel.enabled {
                locked_momentum += spin;
            }
        }
        turnover += (spacecraft.inertia() * start.rate).norm();
        let mut momentum = start.momentum(spacecraft);
        if momentum.norm() <= NEGLIGIBLE_MOMENTUM * turnover {
            momentum = Vector3::zeros();
        }
        Self {
            actuators,
            axes,
            axes_inverse,
            null_space,
            inertia: *spacecraft.effective_inertia(),
            inertia_inverse: *spacecraft.effective_inertia_inverse(),
            locked_inertia_inverse: *spacecraft.inertia_inverse(),
            locked_momentum,
            momentum,
            max_rate: spacecraft.max_rate(),
            max_rate_norm: spacecraft.max_rate_norm(),
            cones: Vec::new(),
        }
    }

    /// The same with these cones instead of its own.
    pub(crate) fn with_cones(&self, cones: Vec<ForbiddenCone>) -> Self {
        Self {
            cones,
            ..self.clone()
        }
    }

    /// Number of enabled wheels.
    pub(crate) fn wheel_count(&self) -> usize {
        self.actuators.len()
    }

    /// Whether total momentum is present; without it legs depend on relative attitudes only.
    pub(crate) fn has_momentum(&self) -> bool {
        self.momentum != Vector3::zeros()
    }

    /// The middle between the extreme eigenvalues of `J^-1`, 1/(kg m²).
    pub(crate) fn mean_inverse_inertia(&self) -> f64 {
        let values = self.locked_inertia_inverse.symmetric_eigenvalues();
        0.5 * (values.min() + values.max())
    }

    /// Greatest component of the body rate along a direction in body axes, rad/s times its length,
    /// that wheel speeds within their limits allow at any attitude, to either side:
    /// `J w = R(q)^T H - h_locked - sum a_i I_i W_i` with `J = J_eff + sum I_i a_i a_i^T`, so
    /// `d . w` is largest with every wheel at the limit of the sign that increases it.
    pub(crate) fn reachable_rate(&self, direction: &Vector3<f64>) -> f64 {
        self.reachable_relative_rate(direction, 0.0)
    }

    /// Largest component of the rate along a direction that the rate limits allow, rad/s.
    pub(crate) fn allowed_rate(&self, direction: &Vector3<f64>) -> f64 {
        component(direction, &self.max_rate).min(self.max_rate_norm * direction.norm())
    }

    /// Greatest component of the body rate along a direction, rad/s times its length, that the wheels
    /// can reach at any attitude and the rate limits allow.
    pub(crate) fn greatest_rate(&self, direction: &Vector3<f64>) -> f64 {
        self.reachable_rate(direction)
            .min(self.allowed_rate(direction))
    }

    /// The same of the rate relative to axes that turn in space with a share of the momentum, in
    /// 1/(kg m²): of `w - share R(q)^T H`.
    pub(crate) fn reachable_relative_rate(&self, direction: &Vector3<f64>, share: f64) -> f64 {
        let lever = self.locked_inertia_inverse.tr_mul(direction);
        let held = lever.dot(&self.locked_momentum).abs();
        let turned = (lever - direction * share).norm() * self.momentum.norm();
        self.actuators.iter().fold(held + turned, |sum, wheel| {
            let share = lever.dot(&wheel.axis).abs() * wheel.inertia;
            // Zero times an infinite speed limit would be NaN.
            sum + if share > 0.0 {
                share * wheel.max_speed
            } else {
                0.0
            }
        })
    }

    /// Greatest component along a direction in body axes of `(J_eff^-1 - share) (w x R^T H)`,
    /// rad/s² times its length: the acceleration by the stored momentum, relative to axes that turn
    /// with a share of it. By the rules of triple products it is at most
    /// `|H| |(J_eff^-1 d - share d) x w|`, convex in `w`, so at most its largest value at a corner
    /// of the box of rates.
    pub(crate) fn gyroscopic_acceleration(&self, direction: &Vector3<f64>, share: f64) -> f64 {
        let lever = self.inertia_inverse.tr_mul(direction) - direction * share;
        if !self.has_momentum() || lever == Vector3::zeros() {
            return 0.0;
        }
        let rates = self.reachable_rates().inf(&self.max_rate);
        let by_norm = lever.norm() * self.max_rate_norm;
        let by_corner = if rates.iter().all(|rate| rate.is_finite()) {
            let half = [
                [1.0, 1.0, 1.0],
                [1.0, 1.0, -1.0],
                [1.0, -1.0, 1.0],
                [-1.0, 1.0, 1.0],
            ];
            half.iter().fold(0.0, |most, signs| {
                let corner = rates.component_mul(&Vector3::from(*signs));
                f64::max(most, lever.cross(&corner).norm())
            })
        } else {
            f64::INFINITY
        };
        by_norm.min(by_corner) * self.momentum.norm()
    }

    /// How far a rate on its limit strays from it under constant torque while the body turns by a
    /// small angle, relative to the limit and per eighth of the angle's square: the stored momentum
    /// turns in body axes. The largest of all limits that can be reached; zero where there is none.
    pub(crate) fn straying(&self) -> f64 {
        if !self.has_momentum() {
            return 0.0;
        }
        let reachable = self.reachable_rates();
        let by_axis = (0..3).filter(|axis| self.max_rate[*axis] <= reachable[*axis]);
        let by_axis =
            by_axis.map(|axis| self.inertia_inverse.row(axis).norm() / self.max_rate[axis]);
        let by_norm = self.inertia_inverse.norm() / self.max_rate_norm;
        by_axis.fold(by_norm, f64::max) * self.momentum.norm()
    }

    /// Greatest rate about each body axis, rad/s, see [`Self::reachable_rate`].
    pub(crate) fn reachable_rates(&self) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.reachable_rate(&Vector3::ith(axis, 1.0)))
    }

    /// Greatest acceleration about each body axis, rad/s², see [`Self::reachable_acceleration`].
    pub(crate) fn reachable_accelerations(&self) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.reachable_acceleration(&Vector3::ith(axis, 1.0)))
    }

    /// Greatest component of the acceleration along a direction in body axes, rad/s² times its
    /// length, by wheel torques within their limits without momentum, to either side:
    /// `J_eff w' = -A u`, so every torque is at the limit of the sign that increases it.
    pub(crate) fn reachable_acceleration(&self, direction: &Vector3<f64>) -> f64 {
        let lever = self.inertia_inverse.tr_mul(direction);
        let (back, forth) = self
            .actuators
            .iter()
            .fold((0.0, 0.0), |(back, forth), wheel| {
                let share = lever.dot(&wheel.axis);
                let ends = [share * wheel.min_torque, share * wheel.max_torque];
                (back - ends[0].min(ends[1]), forth + ends[0].max(ends[1]))
            });
        f64::max(back, forth)
    }

    /// Orthonormal axes, as columns, for boxes of rates: the body axes when their rates have
    /// limits, else those of [`Self::wheel_axes`].
    pub(crate) fn natural_axes(&self) -> Matrix3<f64> {
        if self.max_rate.iter().any(|limit| limit.is_finite()) {
            Matrix3::identity()
        } else {
            self.wheel_axes()
        }
    }

    /// Orthonormal axes, as columns, nearest to the axes of the three wheels that span the largest
    /// volume. They do not depend on the choice of body axes.
    pub(crate) fn wheel_axes(&self) -> Matrix3<f64> {
        let (mut widest, mut largest) = (Matrix3::identity(), 0.0);
        for (i, first) in self.actuators.iter().enumerate() {
            for (j, second) in self.actuators.iter().enumerate().skip(i + 1) {
                for third in &self.actuators[j + 1..] {
                    let axes = [first, second, third].map(|wheel| wheel.axis.normalize());
                    let triple = Matrix3::from_columns(&axes);
                    let volume = triple.determinant().abs();
                    // The first of triples whose volumes are equal up to rounding.
                    if volume > largest + 1e-6 {
                        (widest, largest) = (triple, volume);
                    }
                }
            }
        }
        // The orthogonal factor of the polar decomposition is the nearest orthogonal matrix.
        let decomposition = widest.svd(true, true);
        let mut axes = match (decomposition.u, decomposition.v_t) {
            (Some(u), Some(v_t)) => u * v_t,
            _ => Matrix3::identity(),
        };
        if axes.determinant() < 0.0 {
            axes.column_mut(2).neg_mut();
        }
        axes
    }

    /// Body rate, rad/s, of an attitude and wheel momenta.
    pub(crate) fn rate(&self, attitude: &Attitude, wheels: &DVector<f64>) -> Vector3<f64> {
        let body = attitude.to_body(self.momentum) - self.locked_momentum - &self.axes * wheels;
        self.inertia_inverse * body
    }

    /// Sum of the wheel momenta, N m s, at an attitude and body rate.
    pub(crate) fn demanded(&self, attitude: &Attitude, rate: &Vector3<f64>) -> Vector3<f64> {
        attitude.to_body(self.momentum) - self.locked_momentum - self.inertia * rate
    }

    /// Wheel momenta, N m s, at an attitude and rate with a given null-space component.
    pub(crate) fn wheels_at(
        &self,
        attitude: &Attitude,
        rate: &Vector3<f64>,
        null: &DVector<f64>,
    ) -> DVector<f64> {
        &self.axes_inverse * self.demanded(attitude, rate) + &self.null_space * null
    }

    /// Wheel momenta, N m s, of a body rate and the speeds of all wheels.
    pub(crate) fn wheels_of_speeds(&self, rate: &Vector3<f64>, speeds: &[f64]) -> DVector<f64> {
        DVector::from_iterator(
            self.wheel_count(),
            self.actuators
                .iter()
                .map(|wheel| wheel.inertia * (speeds[wheel.index] + wheel.axis.dot(rate))),
        )
    }

    /// Null-space component of wheel momenta.
    pub(crate) fn null_component(&self, wheels: &DVector<f64>) -> DVector<f64> {
        self.null_space.tr_mul(wheels)
    }

    /// Shares of their limits that wheel speeds, rate components and the norm of the rate have,
    /// with their signs, in this order; zero where nothing is limited.
    pub(crate) fn limit_shares<'a>(
        &'a self,
        rate: &'a Vector3<f64>,
        wheels: &'a DVector<f64>,
    ) -> impl Iterator<Item = f64> + 'a {
        let spin = self
            .actuators
            .iter()
            .zip(wheels.iter())
            .map(|(wheel, h)| (h / wheel.inertia - wheel.axis.dot(rate)) / wheel.max_speed);
        let per_axis = rate.iter().zip(&self.max_rate).map(|(w, limit)| w / limit);
        spin.chain(per_axis)
            .chain(std::iter::once(rate.norm() / self.max_rate_norm))
    }

    /// Greatest share of its limit that any wheel speed or body rate has; 0 when nothing is
    /// limited, never infinite.
    pub(crate) fn speed_usage(&self, rate: &Vector3<f64>, wheels: &DVector<f64>) -> f64 {
        self.limit_shares(rate, wheels)
            .fold(0.0, |worst, share| worst.max(share.abs()))
    }

    /// Greatest share of its limit that any wheel torque has.
    pub(crate) fn torque_usage(&self, torque: &DVector<f64>) -> f64 {
        let limits = self.actuators.iter();
        greatest_share(
            limits.map(|wheel| (wheel.min_torque, wheel.max_torque)),
            torque,
        )
    }
}

/// Orthonormal columns that span the null space of axes with this pseudo-inverse.
fn null_space(axes: &Matrix3xX<f64>, inverse: &DMatrix<f64>) -> DMatrix<f64> {
    let count = axes.ncols();
    // The projector onto the null space has eigenvalues one (kept) and zero.
    let dense_axes = DMatrix::from_iterator(3, count, axes.iter().copied());
    let projector = DMatrix::identity(count, count) - inverse * dense_axes;
    let eigen = ((&projector + projector.transpose()) * 0.5).symmetric_eigen();
    let columns: Vec<_> = (0..count)
        .filter(|&i| eigen.eigenvalues[i] > 0.5)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    if columns.is_empty() {
        DMatrix::zeros(count, 0)
    } else {
        DMatrix::from_columns(&columns)
    }
}

#[cfg(test)]
mod tests;
