//! The motion of an upper bound: its arcs, corrected to reach the target.

use super::RateBox;
use super::search::Candidate;
use super::sequences::{FIRST, InteriorArc, corner};
use super::terminal_arcs::{IMAGES, image_of};
use super::turns::{about, best_axis_sequence, dot, eigenaxis_time, rotation_vector};
use crate::math::quaternion::{Quat, conjugate, product, rotate_back};
use nalgebra::{Matrix3, Vector3};

/// Newton steps that correct a sequence.
const NEWTON_STEPS: usize = 6;
/// A miss that is not corrected, rad.
const REACHED: f64 = 1e-12;
/// Damping of the Newton steps, for sequences whose arcs do not span all directions: the misses
/// left by a search, 1e-7 rad, then change no duration by more than 1e-3.
const DAMPING: f64 = 1e-9;
/// Arcs shorter than this are omitted, rad.
const NO_ARC: f64 = 1e-13;

/// Arcs at constant rate, normalised: rate vector and duration.
pub(super) type TimedArcs = Vec<([f64; 3], f64)>;

/// The arcs of the best motion that a search found. A last arc about the eigenaxis corrects the
/// miss that Newton's method leaves, so that the target is always reached.
pub(super) fn arcs(table: &RateBox, q: &Quat, best: Candidate) -> TimedArcs {
    let c = &table.levels.c;
    let mut arcs = match best {
        Candidate::Eigenaxis => Vec::new(),
        Candidate::Axes => best_axis_sequence(q, c)
            .1
            .into_iter()
            .map(|(axis, angle)| {
                let rate = [0, 1, 2].map(|i| if i == axis { c[i].copysign(angle) } else { 0.0 });
                (rate, angle.abs() / c[axis])
            })
            .collect(),
        Candidate::ClosedForm {
            sequence,
            image,
            terminal,
            parameter,
        } => {
            let sequence = &table.closed_forms[sequence];
            let steps = CandidateSequence {
                first: sequence.first,
                last: sequence.last,
                steps: sequence.steps.clone(),
            };
            steps.polished(c, q, image, terminal, parameter)
        }
        Candidate::Family {
            family,
            first,
            flips,
            image,
            terminal,
            parameter,
        } => {
            let family = &table.families[family];
            let steps = family.steps(c, first, flips);
            CandidateSequence {
                first,
                last: family.octant(first, flips),
                steps,
            }
            .polished(c, q, image, terminal, parameter)
        }
    };
    let miss = product(&conjugate(&turn_of(&arcs)), q);
    let vector = rotation_vector(&miss);
    if dot(&vector, &vector).sqrt() > REACHED {
        let time = eigenaxis_time(&miss, c);
        arcs.push((vector.map(|x| x / time), time));
    }
    arcs.retain(|(_, duration)| *duration > NO_ARC);
    arcs
}

/// The product of the turns of some arcs.
pub(super) fn turn_of(arcs: &[([f64; 3], f64)]) -> Quat {
    arcs.iter()
        .fold([0.0, 0.0, 0.0, 1.0], |all, (rate, duration)| {
            let speed = dot(rate, rate).sqrt();
            product(&all, &about(&rate.map(|r| r / speed), speed * duration))
        })
}

/// An arc sequence without its durations.
struct CandidateSequence {
    first: usize,
    last: usize,
    steps: Vec<InteriorArc>,
}

impl CandidateSequence {
    /// Its arcs after Newton steps from the given durations: those of the iterate that is fastest
    /// when the remaining miss is corrected about the eigenaxis.
    fn polished(
        &self,
        c: &[f64; 3],
        q: &Quat,
        image: usize,
        terminal: [f64; 2],
        parameter: f64,
    ) -> TimedArcs {
        let target = image_of(q, image);
        let mut best = (f64::INFINITY, Vec::new());
        let mut durations = Vector3::new(terminal[0], parameter, terminal[1]);
        for _ in 0..NEWTON_STEPS {
            let arcs = self.arcs(c, &durations);
            let missing = product(&conjugate(&turn_of(&arcs)), &target);
            let miss = rotation_vector(&missing);
            let time = arcs.iter().map(|arc| arc.1).sum::<f64>() + eigenaxis_time(&missing, c);
            let slopes = self.slopes(&arcs);
            if time < best.0 {
                best = (time, arcs);
            }
            if dot(&miss, &miss).sqrt() < REACHED {
                break;
            }
            let square = slopes * slopes.transpose() + Matrix3::identity() * DAMPING;
            let Some(inverse) = square.try_inverse() else {
                break;
            };
            durations += slopes.transpose() * (inverse * Vector3::from(miss));
            durations = durations.map(|d| d.max(0.0));
        }
        // Back from the image: a half turn about a body axis changes two signs.
        let signs = IMAGES[image];
        for (rate, _) in &mut best.1 {
            *rate = [0, 1, 2].map(|i| rate[i] * signs[i]);
        }
        best.1
    }

    fn arcs(&self, c: &[f64; 3], durations: &Vector3<f64>) -> TimedArcs {
        let interior = self
            .steps
            .iter()
            .map(|step| (step.rate, step.duration.unwrap_or(durations[1])));
        std::iter::once((corner(c, FIRST[self.first]), durations[0]))
            .chain(interior)
            .chain(std::iter::once((corner(c, self.last), durations[2])))
            .collect()
    }

    /// Derivative of the final attitude, as a rotation vector in final body axes, by the three
    /// durations.
    fn slopes(&self, arcs: &[([f64; 3], f64)]) -> Matrix3<f64> {
        let mut slopes = Matrix3::zeros();
        let mut rest: Quat = [0.0, 0.0, 0.0, 1.0];
        for (at, arc) in arcs.iter().enumerate().rev() {
            let column = if at == 0 {
                Some(0)
            } else if at == arcs.len() - 1 {
                Some(2)
            } else {
                self.steps[at - 1].duration.is_none().then_some(1)
            };
            if let Some(column) = column {
                let velocity = rotate_back(&rest, &Vector3::from(arc.0));
                let sum = slopes.column(column) + velocity;
                slopes.set_column(column, &sum);
            }
            rest = product(&turn_of(std::slice::from_ref(arc)), &rest);
        }
        slopes
    }
}
