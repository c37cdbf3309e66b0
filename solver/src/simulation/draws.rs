//! Drawing a true spacecraft and an initial state.

use super::settings::{ErrorModel, SimulationSettings};
use super::truth::{TrueSpacecraft, TrueState, TrueWheel, effective_inertia};
use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use crate::model::scenario::Scenario;
use nalgebra::{Matrix3, Quaternion, Vector3};

/// Number of draws of an inertia with the full deviation, and of further draws with half the deviation of
/// the one before: near a plate or a rod most perturbed matrices are the inertia of no body.
const FULL_DRAWS: i32 = 20;
const SHRINKING_DRAWS: i32 = 40;
/// Relative excess over the triangle inequality that counts as rounding, as of a flat plate.
const TRIANGLE_TOLERANCE: f64 = 1e-6;

/// True spacecraft, initial state and sensor noise of one simulated flight.
#[derive(Debug)]
pub(super) struct DrawnFlight {
    pub(super) truth: TrueSpacecraft,
    pub(super) start: TrueState,
    pub(super) noise: SplitMix,
}

/// Draws for one flight; the result depends on seed and number only.
pub(super) fn draw(
    scenario: &Scenario,
    settings: &SimulationSettings,
    nominal: &TrueSpacecraft,
    number: u64,
) -> DrawnFlight {
    let errors = &settings.errors;
    let mut random = SplitMix::member(settings.seed, number);
    // Separate generators, so that the number of draws of one does not affect the others.
    let (mut body, mut friction) = (random.split(), random.split());
    let (mut initial, noise) = (random.split(), random.split());
    let (inertia, mut rotors) = any_body(scenario, errors, &nominal.rotors, &mut body);
    for rotor in &mut rotors {
        let share = (1.0 + errors.friction * friction.normal()).max(0.0);
        rotor.viscous *= share;
        rotor.coulomb *= share;
    }
    let begin = scenario.start();
    let truth = TrueSpacecraft::new(&inertia, rotors, &begin.wheel_speed, errors.disturbance)
        .unwrap_or_else(|| nominal.clone());
    let off = normals(&mut initial) * errors.initial_attitude;
    let start = truth.state(
        quaternion(&begin.attitude.retract(off)),
        begin.rate,
        &begin.wheel_speed,
    );
    DrawnFlight {
        truth,
        start,
        noise,
    }
}

/// Three independent numbers of the normal distribution.
pub(super) fn normals(random: &mut SplitMix) -> Vector3<f64> {
    let (x, y, z) = (random.normal(), random.normal(), random.normal());
    Vector3::new(x, y, z)
}

/// An attitude as nalgebra's quaternion.
pub(super) fn quaternion(attitude: &Attitude) -> Quaternion<f64> {
    let [x, y, z, w] = attitude.xyzw();
    Quaternion::new(w, x, y, z)
}

/// Perturbed inertia and wheels that are physically possible; the nominal ones if no draw is.
fn any_body(
    scenario: &Scenario,
    errors: &ErrorModel,
    nominal: &[TrueWheel],
    random: &mut SplitMix,
) -> (Matrix3<f64>, Vec<TrueWheel>) {
    let inertia = scenario.spacecraft().inertia();
    for draw in 0..FULL_DRAWS + SHRINKING_DRAWS {
        let size = 0.5_f64.powi((draw - FULL_DRAWS + 1).max(0));
        let candidate = perturbed(inertia, size * errors.inertia, random);
        let rotors: Vec<TrueWheel> = nominal
            .iter()
            .map(|rotor| tilted(rotor, size * errors.alignment, random))
            .collect();
        if is_body(&candidate) && is_positive(&effective_inertia(&candidate, &rotors)) {
            return (candidate, rotors);
        }
    }
    (*inertia, nominal.to_vec())
}

/// `S (1 + E) S` with `S^2` the inertia and `E` symmetric and normal, off the diagonal with a deviation
/// smaller by the square root of two. Its distribution is the same in all axes, so that the moment of
/// inertia about every axis has the same relative deviation.
fn perturbed(inertia: &Matrix3<f64>, deviation: f64, random: &mut SplitMix) -> Matrix3<f64> {
    let mut error = Matrix3::zeros();
    for row in 0..3 {
        error[(row, row)] = deviation * random.normal();
        for column in 0..row {
            let entry = deviation * random.normal() / std::f64::consts::SQRT_2;
            error[(row, column)] = entry;
            error[(column, row)] = entry;
        }
    }
    let axes = inertia.symmetric_eigen();
    let roots = Matrix3::from_diagonal(&axes.eigenvalues.map(f64::sqrt));
    let root = axes.eigenvectors * roots * axes.eigenvectors.transpose();
    inertia + root * error * root
}

/// A wheel whose axis is tilted by small angles about two perpendicular axes, at unchanged length.
fn tilted(rotor: &TrueWheel, deviation: f64, random: &mut SplitMix) -> TrueWheel {
    let (first, second) = (random.normal(), random.normal());
    let across = rotor.axis.cross(&Vector3::ith(rotor.axis.iamin(), 1.0));
    let along = rotor.axis.norm();
    let (a, b) = (across.normalize(), rotor.axis.cross(&across).normalize());
    let off = rotor.axis + (a * first + b * second) * (along * deviation);
    TrueWheel {
        axis: off * (along / off.norm()),
        ..rotor.clone()
    }
}

/// Whether a symmetric matrix is the inertia of some body.
fn is_body(inertia: &Matrix3<f64>) -> bool {
    let moments = inertia.symmetric_eigenvalues();
    moments.min() > 0.0 && 2.0 * moments.max() <= moments.sum() * (1.0 + TRIANGLE_TOLERANCE)
}

fn is_positive(matrix: &Matrix3<f64>) -> bool {
    matrix.symmetric_eigenvalues().min() > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_inertia_about_all_axes_have_the_same_relative_deviation() {
        let inertia = Matrix3::new(6.63, 0.3, -0.2, 0.3, 8.9, 0.1, -0.2, 0.1, 9.63);
        let mut random = SplitMix::new(3);
        let axes = [
            Vector3::x(),
            Vector3::z(),
            Vector3::new(0.5, -0.7, 0.3).normalize(),
        ];
        let mut squares = [0.0; 3];
        let draws = 20_000;
        for _ in 0..draws {
            let other = perturbed(&inertia, 0.01, &mut random);
            assert!((other - other.transpose()).amax() < 1e-14);
            for (square, axis) in squares.iter_mut().zip(&axes) {
                let moment = |j: &Matrix3<f64>| (axis.transpose() * j * axis).x;
                *square += (moment(&other) / moment(&inertia) - 1.0).powi(2);
            }
        }
        for square in squares {
            let deviation = (square / f64::from(draws)).sqrt();
            assert!((deviation - 0.01).abs() < 3e-4, "{deviation}");
        }
    }

    #[test]
    fn tilted_axes_have_the_given_deviation_and_unchanged_length() {
        let rotor = TrueWheel {
            axis: Vector3::new(0.5, 0.5, 0.5),
            inertia: 1e-3,
            viscous: 0.0,
            coulomb: 0.0,
            band: 0.0,
            driven: true,
        };
        let mut random = SplitMix::new(4);
        let mut square = 0.0;
        for _ in 0..20_000 {
            let other = tilted(&rotor, 0.01, &mut random);
            assert!((other.axis.norm() - rotor.axis.norm()).abs() < 1e-14);
            square += rotor.axis.angle(&other.axis).powi(2);
        }
        // Two directions.
        let deviation = (square / 40_000.0).sqrt();
        assert!((deviation - 0.01).abs() < 3e-4, "{deviation}");
    }
}
