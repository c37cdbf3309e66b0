//! Paths of slews within the envelopes of the wheels.
//!
//! The RW/CMG thesis draws the momentum and the torque of a slew inside the envelopes (figures 71 to
//! 76): a slew about the eigenaxis stays on one ray, a time-optimal one runs along edges and from
//! vertex to vertex. Here the same paths are data: the sums of the wheels' momenta and torques in body
//! axes, as shares of the full and of the pseudo-inverse-limited envelope. A share of the latter above
//! 1 is beyond the reach of the pseudo-inverse.

use crate::eigenaxis::EigenaxisBaseline;
use nalgebra::Vector3;
use slewplan_solver::model::plan::{Control, State};
use slewplan_solver::model::spacecraft::Spacecraft;
use slewplan_solver::wheels::array::{EnvelopedArray, SpacecraftEnvelopes};

/// A vector within the envelopes of an array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvelopePoint {
    /// Sum of the wheels' momenta (N m s) or torques (N m), body axes; the body has the opposite.
    pub vector: Vector3<f64>,
    /// Share of the full envelope: 1 on its surface.
    pub full_share: f64,
    /// Share of the pseudo-inverse-limited envelope.
    pub pseudo_inverse_share: f64,
}

/// Momentum at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentumSample {
    /// Time, s.
    pub time_s: f64,
    /// Momentum of the enabled wheels relative to the body, N m s.
    pub momentum: EnvelopePoint,
}

/// Torque on one interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueStep {
    /// Beginning of the interval, s.
    pub start_s: f64,
    /// Length of the interval, s.
    pub duration_s: f64,
    /// Torque of the motors on the enabled wheels, N m.
    pub torque: EnvelopePoint,
}

/// The path of a slew within the envelopes of its wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopePath {
    /// The momentum, in order of time; empty when the momentum envelope is unbounded.
    pub momentum: Vec<MomentumSample>,
    /// The torque, in order of time.
    pub torque: Vec<TorqueStep>,
}

impl EnvelopePath {
    /// The path of a flight, given by its states and controls with one speed or torque per wheel of the
    /// spacecraft to which the envelopes belong.
    ///
    /// # Panics
    ///
    /// When a list has fewer entries than the spacecraft has wheels.
    #[must_use]
    pub fn of_flight(
        envelopes: &SpacecraftEnvelopes,
        spacecraft: &Spacecraft,
        states: &[State],
        controls: &[Control],
    ) -> Self {
        let held = |state: &State| {
            let spins = spacecraft.wheels().iter().zip(&state.wheel_speed_rad_s);
            spins
                .map(|(wheel, speed)| wheel.inertia * speed)
                .collect::<Vec<_>>()
        };
        let momentum = envelopes.momentum.iter().flat_map(|within| {
            states.iter().map(|state| MomentumSample {
                time_s: state.time_s,
                momentum: point(within, within.array.sum(&held(state))),
            })
        });
        let torque = controls.iter().map(|control| TorqueStep {
            start_s: control.start_s,
            duration_s: control.duration_s,
            torque: point(
                &envelopes.torque,
                envelopes.torque.array.sum(&control.wheel_torque_nm),
            ),
        });
        Self {
            momentum: momentum.collect(),
            torque: torque.collect(),
        }
    }

    /// The path of a slew about the eigenaxis from rest to rest: its corners, between which it is
    /// straight.
    #[must_use]
    pub fn of_eigenaxis_slew(envelopes: &SpacecraftEnvelopes, slew: &EigenaxisBaseline) -> Self {
        let (duration, ramp) = (slew.course.duration(), slew.course.ramp());
        let corners = [
            (0.0, 0.0),
            (ramp, 1.0),
            (duration - ramp, 1.0),
            (duration, 0.0),
        ];
        let momentum = envelopes.momentum.iter().flat_map(|within| {
            corners.map(|(time_s, share)| MomentumSample {
                time_s,
                momentum: point(within, slew.peak_momentum * share),
            })
        });
        let steps = [
            (0.0, ramp, 1.0),
            (ramp, duration - 2.0 * ramp, 0.0),
            (duration - ramp, ramp, -1.0),
        ];
        Self {
            momentum: momentum.collect(),
            torque: steps
                .map(|(start_s, duration_s, share)| TorqueStep {
                    start_s,
                    duration_s,
                    torque: point(&envelopes.torque, slew.ramp_torque * share),
                })
                .into(),
        }
    }
}

fn point(within: &EnvelopedArray, vector: Vector3<f64>) -> EnvelopePoint {
    EnvelopePoint {
        vector,
        full_share: within.envelopes.full.share(&vector),
        pseudo_inverse_share: within.envelopes.pseudo_inverse.share(&vector),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eigenaxis::{Baselines, EnvelopeLimit};
    use slewplan_solver::model::attitude::Attitude;
    use slewplan_solver::model::spec::{SpacecraftSpec, WheelSpec};

    const S: f64 = 0.816_496_580_927_726;
    const C: f64 = 0.577_350_269_189_625_8;

    /// Wheels of 1 N m s and 0.1 N m on the square pyramid, and a locked one.
    fn pyramid() -> Spacecraft {
        let wheel = |axis: [f64; 3]| WheelSpec {
            axis,
            normalize_axis: true,
            inertia_kg_m2: 0.01,
            max_torque_nm: 0.1,
            min_torque_nm: None,
            max_speed_rad_s: Some(100.0),
            enabled: axis[1] < 1.0,
        };
        let axes = [
            [S, 0.0, C],
            [0.0, 1.0, 0.0],
            [0.0, S, C],
            [-S, 0.0, C],
            [0.0, -S, C],
        ];
        let spec = SpacecraftSpec {
            inertia_kg_m2: [[25.4, 0.0, 0.0], [0.0, 25.4, 0.0], [0.0, 0.0, 25.4]],
            wheels: axes.map(wheel).into(),
            ..SpacecraftSpec::default()
        };
        Spacecraft::try_new(&spec, "").unwrap()
    }

    fn assert_shares(point: &EnvelopePoint, full: f64, pseudo_inverse: f64) {
        assert!((point.full_share - full).abs() < 1e-12, "{point:?}");
        assert!(
            (point.pseudo_inverse_share - pseudo_inverse).abs() < 1e-12,
            "{point:?}"
        );
    }

    #[test]
    fn the_share_of_a_minor_vertex_exceeds_one_for_the_pseudo_inverse() {
        let spacecraft = pyramid();
        let envelopes = SpacecraftEnvelopes::of(&spacecraft, 1.0, 1.0).unwrap();
        let state = State {
            time_s: 2.0,
            attitude: Attitude::identity(),
            body_rate_rad_s: Vector3::zeros(),
            // The speed of the locked wheel does not count.
            wheel_speed_rad_s: vec![100.0, 77.0, 100.0, -100.0, 100.0],
        };
        let control = Control {
            start_s: 0.0,
            duration_s: 2.0,
            wheel_torque_nm: vec![0.05, 0.0, 0.05, 0.05, 0.05],
        };
        let path = EnvelopePath::of_flight(&envelopes, &spacecraft, &[state], &[control]);
        let vertex = Vector3::new(2.0 * S, 0.0, 2.0 * C);
        assert!((path.momentum[0].momentum.vector - vertex).norm() < 1e-12);
        assert_shares(&path.momentum[0].momentum, 1.0, 1.5);
        // On the pyramid's axis both envelopes have the same vertex.
        assert_shares(&path.torque[0].torque, 0.5, 0.5);
        let reach = |of: &EnvelopedArray| of.envelopes.full.size().greatest_radius;
        let momentum = envelopes.momentum.unwrap();
        assert!((reach(&momentum) - 4.0 * C).abs() < 1e-12);
        assert!((reach(&envelopes.torque) - 0.4 * C).abs() < 1e-12);
    }

    #[test]
    fn slews_about_the_eigenaxis_reach_the_surface_of_the_envelope_that_limits_them() {
        let spacecraft = pyramid();
        let turn = Vector3::new(1.2, 0.5, -0.8);
        let baselines = Baselines::of(&spacecraft, 1.0, 1.0).unwrap();
        for slew in baselines.slews(&turn).unwrap() {
            let path = EnvelopePath::of_eigenaxis_slew(baselines.envelopes(), &slew);
            let (momentum, torque) = (&path.momentum[1].momentum, &path.torque[0].torque);
            match slew.limit {
                EnvelopeLimit::PseudoInverse => {
                    assert!((momentum.pseudo_inverse_share - 1.0).abs() < 1e-12);
                    assert!((torque.pseudo_inverse_share - 1.0).abs() < 1e-12);
                }
                EnvelopeLimit::Full => {
                    assert!((momentum.full_share - 1.0).abs() < 1e-12);
                    assert!((torque.full_share - 1.0).abs() < 1e-12);
                }
                EnvelopeLimit::PseudoInverseSphere | EnvelopeLimit::FullSphere => {
                    assert!(momentum.full_share < 1.0 && torque.full_share < 1.0);
                }
            }
            let end = path.torque.last().unwrap();
            assert!((end.start_s + end.duration_s - slew.course.duration()).abs() < 1e-12);
            assert!((end.torque.vector + torque.vector).norm() < 1e-15);
        }
    }
}
