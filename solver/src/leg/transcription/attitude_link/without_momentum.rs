//! Derivatives of a link without stored momentum, by the closed form of the turn.
//!
//! With the wheels' rates `b = offset + gain h` and `g = gain m`, the integral of the rate over the
//! interval and its change, times the length, are
//!
//! ```text
//!   u = -tau (b + g / 2),   v = -tau g
//! ```
//!
//! so that `h` moves `u` alone, and `m` moves `u` half as much as `v`.

use super::relative_attitude;
use crate::leg::kinematics::{BentTurn, TurnMap};
use crate::leg::transcription::Transcription;
use crate::leg::transcription::rows::add_attitude_block;
use crate::math::quaternion::{Quat, conjugate, dot4, imaginary, product, quat};
use crate::nlp::{Link, LinkModel};
use nalgebra::{Matrix3, Vector3};

/// The turn of one link, and how the variables of its interval move it.
struct Terms {
    tau: f64,
    /// Slopes of `u` and `v` by the length.
    by_length: [Vector3<f64>; 2],
    turn: BentTurn,
    /// Slopes of the gap by `u` and `v`.
    slopes: [Matrix3<f64>; 2],
    /// Mixed second derivatives: rows an attitude step, columns `u` or `v`.
    mixed: [Matrix3<f64>; 2],
}

/// `gain`, a row for every axis.
type Gains<const WHEELS: usize> = [[f64; WHEELS]; 3];

impl Transcription {
    /// Writes the attitude rows of the link Jacobian and the link's share of the Hessian, where the
    /// turn has the closed form and the number of wheels is one that is compiled; false elsewhere.
    pub(super) fn writes_closed_form(
        &self,
        link: &Link<'_>,
        lambda: &[f64],
        out: &mut LinkModel,
    ) -> bool {
        // Compiled for states without a clock.
        if self.has_clock || !matches!(self.turn_map, TurnMap::Magnus) {
            return false;
        }
        match self.wheels() {
            3 => self.write_closed_form::<3>(link, lambda, out),
            4 => self.write_closed_form::<4>(link, lambda, out),
            5 => self.write_closed_form::<5>(link, lambda, out),
            6 => self.write_closed_form::<6>(link, lambda, out),
            _ => return false,
        }
        true
    }

    fn write_closed_form<const WHEELS: usize>(
        &self,
        link: &Link<'_>,
        lambda: &[f64],
        out: &mut LinkModel,
    ) {
        let angle = self.scales.angle;
        let relative = relative_attitude(link);
        let covector = Vector3::new(lambda[0], lambda[1], lambda[2]) * (2.0 / angle);
        let mu = product(&conjugate(&relative), &quat(&covector, 0.0));
        let correction = &self.corrections[link.node];
        // mu . (d p e) = (mu e*) . (d p)
        let pulled = product(&mu, &conjugate(correction));
        let terms = self.closed_terms(link, (&relative, &pulled), correction);
        let turned = product(&terms.turn.turn, correction);
        // The unit of the step cancels the unit of the gap.
        let by_attitude: [Quat; 3] =
            std::array::from_fn(|axis| product(&beside_unit(&relative, axis), &turned));
        let gains: Gains<WHEELS> =
            std::array::from_fn(|axis| std::array::from_fn(|i| self.rate_gain[i][axis]));
        write_slopes(&terms, &by_attitude, &gains, out);
        add_curvature(&terms, &gains, out);
        let bend = -0.25 * angle * angle * dot4(&mu, &turned);
        add_attitude_block(out, &Matrix3::from_diagonal_element(bend));
    }

    fn closed_terms(
        &self,
        link: &Link<'_>,
        (relative, mu): (&Quat, &Quat),
        correction: &Quat,
    ) -> Terms {
        let angle = self.scales.angle;
        let tau = link.control[self.wheels()];
        let begin = self.wheel_rate(&link.point[4..]);
        let mut change = Vector3::zeros();
        for (gain, m) in self.rate_gain.iter().zip(link.control) {
            change += gain * *m;
        }
        let by_length = [-(begin + change * 0.5), -change];
        let turn = BentTurn::of(&(by_length[0] * tau), &(by_length[1] * tau), mu);
        let [by_u, by_v] = &turn.rotation;
        // Slopes of the gap by the rotation vector: r (x) dp (x) e.
        let units: [Quat; 3] = std::array::from_fn(|axis| beside_unit(relative, axis));
        let slopes = turn.along(
            |axis| imaginary(&product(&units[axis], correction)),
            |radial| imaginary(&product(&product(relative, radial), correction)),
        ) * (2.0 / angle);
        // (d / 2) (x) p, weighted: the columns are covectors on attitude steps.
        let steps: [Quat; 3] =
            std::array::from_fn(|axis| unit_beside(axis, mu).map(|c| -0.5 * angle * c));
        let mixed = turn.along(
            |axis| Vector3::from_fn(|row, _| steps[row][axis]),
            |radial| Vector3::from_fn(|row, _| dot4(&steps[row], radial)),
        );
        Terms {
            tau,
            by_length,
            slopes: [slopes * by_u, slopes * by_v],
            mixed: [mixed * by_u, mixed * by_v],
            turn,
        }
    }
}

/// Writes the attitude rows of the link Jacobian.
fn write_slopes<const WHEELS: usize>(
    terms: &Terms,
    by_attitude: &[Quat; 3],
    gains: &Gains<WHEELS>,
    out: &mut LinkModel,
) {
    let [by_u, by_v] = &terms.slopes;
    let by_start = image(&(by_u * -terms.tau), gains);
    let by_change = image(&((by_u * 0.5 + by_v) * -terms.tau), gains);
    let [u, v] = &terms.by_length;
    let by_length = by_u * u + by_v * v;
    for (row, line) in out
        .link_jacobian
        .chunks_exact_mut(out.vars)
        .take(3)
        .enumerate()
    {
        add(line, &by_attitude.map(|moved| moved[row]));
        add(&mut line[3..], &by_start[row]);
        add(&mut line[3 + WHEELS..], &by_change[row]);
        add(&mut line[3 + 2 * WHEELS..], &[by_length[row]]);
    }
}

/// Adds the second derivatives by wheel momenta, their changes, the length and attitude steps, but
/// for those by attitude steps alone.
fn add_curvature<const WHEELS: usize>(terms: &Terms, gains: &Gains<WHEELS>, out: &mut LinkModel) {
    let (vars, tau) = (out.vars, terms.tau);
    let [uu, uv, vv] = &terms.turn.curvature;
    let vu = uv.transpose();
    // By h and by m, whose (u, v) are (1, 0) and (1/2, 1).
    let start_change = uu * 0.5 + uv;
    let change_change = (start_change + vu) * 0.5 + vv;
    let [u, v] = &terms.by_length;
    let (along_u, along_v) = (uu * u + uv * v, vu * u + vv * v);
    let [slope_u, slope_v] = &terms.turn.gradient;
    let length_h = -(along_u * tau + slope_u);
    let length_m = length_h * 0.5 - (along_v * tau + slope_v);
    let [mixed_h, mixed_v] = &terms.mixed;
    let mixed_m = mixed_h * 0.5 + mixed_v;
    let squared = tau * tau;
    let (of_h, of_m) = (
        image(&(mixed_h * -tau), gains),
        image(&(mixed_m * -tau), gains),
    );
    // Both triangles, of which the upper one is not read.
    let hh = products(gains, &image(&(uu * squared), gains));
    let hm = products(&image(&(start_change * squared), gains), gains);
    let mm = products(gains, &image(&(change_change * squared), gains));
    let rows = out.hessian.chunks_exact_mut(vars).skip(3);
    for (i, row) in rows.enumerate().take(2 * WHEELS + 1) {
        if i < WHEELS {
            add(row, &of_h.map(|line| line[i]));
            add(&mut row[3..], &hh[i]);
        } else if i < 2 * WHEELS {
            let i = i - WHEELS;
            add(row, &of_m.map(|line| line[i]));
            add(&mut row[3..], &hm[i]);
            add(&mut row[3 + WHEELS..], &mm[i]);
        } else {
            add(row, (mixed_h * u + mixed_v * v).as_ref());
            add(&mut row[3..], &along(&length_h, gains));
            add(&mut row[3 + WHEELS..], &along(&length_m, gains));
            add(
                &mut row[3 + 2 * WHEELS..],
                &[u.dot(&along_u) + v.dot(&along_v)],
            );
        }
    }
}

/// Adds to the first entries.
fn add<const LENGTH: usize>(out: &mut [f64], values: &[f64; LENGTH]) {
    if let Some(out) = out.first_chunk_mut::<LENGTH>() {
        for i in 0..LENGTH {
            out[i] += values[i];
        }
    }
}

/// A covector along every gain.
fn along<const WHEELS: usize>(covector: &Vector3<f64>, gains: &Gains<WHEELS>) -> [f64; WHEELS] {
    std::array::from_fn(|i| {
        covector[0] * gains[0][i] + covector[1] * gains[1][i] + covector[2] * gains[2][i]
    })
}

/// `matrix gains`.
fn image<const WHEELS: usize>(matrix: &Matrix3<f64>, gains: &Gains<WHEELS>) -> Gains<WHEELS> {
    std::array::from_fn(|row| {
        let covector = Vector3::new(matrix[(row, 0)], matrix[(row, 1)], matrix[(row, 2)]);
        along(&covector, gains)
    })
}

/// `one^T other`.
fn products<const WHEELS: usize>(
    one: &Gains<WHEELS>,
    other: &Gains<WHEELS>,
) -> [[f64; WHEELS]; WHEELS] {
    std::array::from_fn(|i| along(&Vector3::new(one[0][i], one[1][i], one[2][i]), other))
}

/// `q (x) [e_axis, 0]`.
fn beside_unit(q: &Quat, axis: usize) -> Quat {
    match axis {
        0 => [q[3], q[2], -q[1], -q[0]],
        1 => [-q[2], q[3], q[0], -q[1]],
        _ => [q[1], -q[0], q[3], -q[2]],
    }
}

/// `[e_axis, 0] (x) q`.
fn unit_beside(axis: usize, q: &Quat) -> Quat {
    match axis {
        0 => [q[3], -q[2], q[1], -q[0]],
        1 => [q[2], q[3], -q[0], -q[1]],
        _ => [-q[1], q[0], q[3], -q[2]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_with_units_are_products() {
        let q = [0.3, -0.5, 0.7, 0.2];
        for axis in 0..3 {
            let unit = quat(&Vector3::ith(axis, 1.0), 0.0);
            for (got, want) in [
                (beside_unit(&q, axis), product(&q, &unit)),
                (unit_beside(axis, &q), product(&unit, &q)),
            ] {
                assert!(
                    got.iter()
                        .zip(want)
                        .all(|(got, want)| (got - want).abs() < 1e-15)
                );
            }
        }
    }
}
