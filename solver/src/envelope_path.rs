//! Where a slew goes within the envelopes of its wheels.
//!
//! The RW/CMG thesis draws the momentum and the torque of a slew inside the envelopes (figures 71
//! to 76): a slew about the eigenaxis stays on one ray, a time-optimal one runs along edges and from
//! vertex to vertex. Here are the same paths as data: what the wheels together hold and take up, in
//! body axes, and the shares of the full and of the pseudo-inverse-limited envelope that this is.
//! A share of the latter above 1 is what no pseudo-inverse could have shared out.

use crate::array::{Envelopes, WheelArray};
use crate::eigenaxis::EigenaxisSlew;
use crate::plan::{Control, State};
use crate::problem::Problem;
use crate::spacecraft::Spacecraft;
use nalgebra::Vector3;

/// A vector within the envelopes of an array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvelopePoint {
    /// What the wheels together hold (N m s) or take up (N m), body axes; the body has the opposite.
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
    /// Begin of the interval, s.
    pub start_s: f64,
    /// Length of the interval, s.
    pub duration_s: f64,
    /// Torque of the motors on the enabled wheels, N m.
    pub torque: EnvelopePoint,
}

/// The way of a slew through the envelopes of its wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopePath {
    /// The momentum, in order of time.
    pub momentum: Vec<MomentumSample>,
    /// The torque, in order of time.
    pub torque: Vec<TorqueStep>,
}

/// The wheels of a spacecraft with their envelopes, to look up where slews go.
#[derive(Debug, Clone)]
pub struct EnvelopeMap {
    torque: (WheelArray, Envelopes),
    momentum: (WheelArray, Envelopes),
}

impl EnvelopeMap {
    /// The envelopes of a spacecraft at its full limits.
    ///
    /// # Errors
    ///
    /// Every enabled wheel without a speed limit: the momentum envelope would have no end.
    pub fn of(spacecraft: &Spacecraft) -> Result<Self, Vec<Problem>> {
        let with_envelopes = |array: WheelArray| {
            let envelopes = array.envelopes();
            (array, envelopes)
        };
        Ok(Self {
            torque: with_envelopes(WheelArray::torque(spacecraft, 1.0)?),
            momentum: with_envelopes(WheelArray::momentum(spacecraft, 1.0)?),
        })
    }

    /// The envelopes of the torques, N m.
    #[must_use]
    pub fn torque(&self) -> &Envelopes {
        &self.torque.1
    }

    /// The envelopes of the momenta, N m s.
    #[must_use]
    pub fn momentum(&self) -> &Envelopes {
        &self.momentum.1
    }

    /// The way of a flight: its states and its controls, with one speed or torque per wheel.
    #[must_use]
    pub fn path(
        &self,
        spacecraft: &Spacecraft,
        states: &[State],
        controls: &[Control],
    ) -> EnvelopePath {
        let held = |state: &State| {
            let spins = spacecraft.wheels().iter().zip(&state.wheel_speed_rad_s);
            spins
                .map(|(wheel, speed)| wheel.inertia * speed)
                .collect::<Vec<_>>()
        };
        EnvelopePath {
            momentum: states
                .iter()
                .map(|state| MomentumSample {
                    time_s: state.time_s,
                    momentum: point(&self.momentum.1, self.momentum.0.sum(&held(state))),
                })
                .collect(),
            torque: controls
                .iter()
                .map(|control| TorqueStep {
                    start_s: control.start_s,
                    duration_s: control.duration_s,
                    torque: point(&self.torque.1, self.torque.0.sum(&control.wheel_torque_nm)),
                })
                .collect(),
        }
    }

    /// The way of a slew about the eigenaxis from rest to rest: its corners, since it is straight
    /// between them.
    #[must_use]
    pub fn eigenaxis_path(&self, slew: &EigenaxisSlew) -> EnvelopePath {
        let (duration, ramp) = (slew.course.duration(), slew.course.ramp());
        let momentum = |time_s: f64, share: f64| MomentumSample {
            time_s,
            momentum: point(&self.momentum.1, slew.peak_momentum * share),
        };
        let torque = |start_s: f64, duration_s: f64, share: f64| TorqueStep {
            start_s,
            duration_s,
            torque: point(&self.torque.1, slew.ramp_torque * share),
        };
        EnvelopePath {
            momentum: vec![
                momentum(0.0, 0.0),
                momentum(ramp, 1.0),
                momentum(duration - ramp, 1.0),
                momentum(duration, 0.0),
            ],
            torque: vec![
                torque(0.0, ramp, 1.0),
                torque(ramp, duration - 2.0 * ramp, 0.0),
                torque(duration - ramp, ramp, -1.0),
            ],
        }
    }
}

fn point(envelopes: &Envelopes, vector: Vector3<f64>) -> EnvelopePoint {
    EnvelopePoint {
        vector,
        full_share: envelopes.full.share(&vector),
        pseudo_inverse_share: envelopes.pseudo_inverse.share(&vector),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::Attitude;
    use crate::eigenaxis::{Baselines, Limit};
    use crate::spec::{SpacecraftSpec, WheelSpec};

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
    fn a_minor_vertex_is_beyond_the_pseudo_inverse() {
        let spacecraft = pyramid();
        let map = EnvelopeMap::of(&spacecraft).unwrap();
        let state = State {
            time_s: 2.0,
            attitude: Attitude::identity(),
            body_rate_rad_s: Vector3::zeros(),
            // The locked wheel's speed has no part in it.
            wheel_speed_rad_s: vec![100.0, 77.0, 100.0, -100.0, 100.0],
        };
        let control = Control {
            start_s: 0.0,
            duration_s: 2.0,
            wheel_torque_nm: vec![0.05, 0.0, 0.05, 0.05, 0.05],
        };
        let path = map.path(&spacecraft, &[state], &[control]);
        let vertex = Vector3::new(2.0 * S, 0.0, 2.0 * C);
        assert!((path.momentum[0].momentum.vector - vertex).norm() < 1e-12);
        assert_shares(&path.momentum[0].momentum, 1.0, 1.5);
        // On the pyramid's axis both envelopes have the same vertex.
        assert_shares(&path.torque[0].torque, 0.5, 0.5);
        assert!((map.momentum().full.figures().greatest_radius - 4.0 * C).abs() < 1e-12);
        assert!((map.torque().full.figures().greatest_radius - 0.4 * C).abs() < 1e-12);
    }

    #[test]
    fn slews_about_the_eigenaxis_go_to_the_surface_that_limits_them() {
        let spacecraft = pyramid();
        let map = EnvelopeMap::of(&spacecraft).unwrap();
        let turn = Vector3::new(1.2, 0.5, -0.8);
        let slews = Baselines::of(&spacecraft, 1.0, 1.0)
            .unwrap()
            .slews(&turn)
            .unwrap();
        for slew in slews {
            let path = map.eigenaxis_path(&slew);
            let (momentum, torque) = (&path.momentum[1].momentum, &path.torque[0].torque);
            match slew.limit {
                Limit::PseudoInverse => {
                    assert!((momentum.pseudo_inverse_share - 1.0).abs() < 1e-12);
                    assert!((torque.pseudo_inverse_share - 1.0).abs() < 1e-12);
                }
                Limit::Full => {
                    assert!((momentum.full_share - 1.0).abs() < 1e-12);
                    assert!((torque.full_share - 1.0).abs() < 1e-12);
                }
                Limit::PseudoInverseSphere | Limit::FullSphere => {
                    assert!(momentum.full_share < 1.0 && torque.full_share < 1.0);
                }
            }
            let end = path.torque.last().unwrap();
            assert!((end.start_s + end.duration_s - slew.course.duration()).abs() < 1e-12);
            assert!((end.torque.vector + torque.vector).norm() < 1e-15);
        }
    }
}
