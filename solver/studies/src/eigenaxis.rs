//! Slews about the eigenaxis from rest to rest, the usual kind of attitude control.
//!
//! The body accelerates about the fixed axis `e` of the whole turn, coasts, and brakes. Without stored
//! momentum the gyroscopic terms vanish, and during the slew
//!
//! ```text
//!   A h = -J e w,      A u = -J_eff e w'            (h, u: momenta and torques of the wheels)
//! ```
//!
//! so that the rate is limited by the reach of the momentum envelope along `J e`, the acceleration by
//! the reach of the torque envelope along `J_eff e`. Which envelope counts depends on the allocation,
//! and on whether only the sphere inside it is used ([`EnvelopeLimit`]; RW/CMG thesis, chapter IV,
//! sections E to G).
//!
//! ```text
//!   T = angle / w + w / w'    where the rate is reached, else    T = 2 sqrt(angle / w')
//! ```

use nalgebra::Vector3;
use slewplan_solver::math::bang_coast_bang::BangCoastBang;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::spacecraft::Spacecraft;
use slewplan_solver::wheels::array::{Envelopes, Polytope, SpacecraftEnvelopes};

/// The set of momenta and torques within which a slew about the eigenaxis stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum EnvelopeLimit {
    /// The sphere inside the pseudo-inverse envelope.
    PseudoInverseSphere,
    /// The pseudo-inverse envelope.
    PseudoInverse,
    /// The sphere inside the full envelope.
    FullSphere,
    /// The full envelope.
    Full,
}

impl EnvelopeLimit {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::PseudoInverseSphere,
        Self::PseudoInverse,
        Self::FullSphere,
        Self::Full,
    ];

    /// Greatest multiple of a demand within the limit.
    fn multiple(self, envelopes: &Envelopes, demand: &Vector3<f64>) -> f64 {
        let sphere = |polytope: &Polytope| polytope.size().inscribed_radius / demand.norm();
        match self {
            Self::PseudoInverseSphere => sphere(&envelopes.pseudo_inverse),
            Self::PseudoInverse => 1.0 / envelopes.pseudo_inverse.share(demand),
            Self::FullSphere => sphere(&envelopes.full),
            Self::Full => 1.0 / envelopes.full.share(demand),
        }
    }
}

/// A slew about the eigenaxis under one limit.
#[derive(Debug, Clone, Copy)]
pub struct EigenaxisBaseline {
    /// The limit on its momenta and torques.
    pub limit: EnvelopeLimit,
    /// Its axis, unit, body axes.
    pub axis: Vector3<f64>,
    /// Rate and duration of its phases.
    pub course: BangCoastBang,
    /// Sum of the wheels' momenta at the greatest rate, `A h`, body axes, N m s.
    pub peak_momentum: Vector3<f64>,
    /// Sum of the wheels' torques while the body accelerates, `A u`, body axes, N m; the opposite while
    /// it brakes.
    pub ramp_torque: Vector3<f64>,
}

/// Slews about the eigenaxis of a spacecraft without stored momentum.
#[derive(Debug, Clone)]
pub struct Baselines {
    spacecraft: Spacecraft,
    envelopes: SpacecraftEnvelopes,
}

impl Baselines {
    /// For a spacecraft and the usable shares of its torque and speed limits. With a wheel without a
    /// speed limit the momentum is unlimited too.
    ///
    /// # Errors
    ///
    /// An authority that is not in (0, 1]; pointers are those of a scenario's options.
    pub fn of(
        spacecraft: &Spacecraft,
        torque_authority: f64,
        momentum_authority: f64,
    ) -> Result<Self, Vec<Problem>> {
        Ok(Self {
            envelopes: SpacecraftEnvelopes::of(spacecraft, torque_authority, momentum_authority)?,
            spacecraft: spacecraft.clone(),
        })
    }

    /// The envelopes within which the slews stay.
    #[must_use]
    pub fn envelopes(&self) -> &SpacecraftEnvelopes {
        &self.envelopes
    }

    /// The fastest slew by a rotation vector (axis times angle, body axes, rad) under each limit.
    /// `None` for a turn of zero angle.
    #[must_use]
    pub fn slews(&self, turn: &Vector3<f64>) -> Option<[EigenaxisBaseline; 4]> {
        let axis = turn.try_normalize(0.0)?;
        Some(EnvelopeLimit::ALL.map(|limit| self.slew(axis, turn.norm(), limit)))
    }

    fn slew(&self, axis: Vector3<f64>, angle: f64, limit: EnvelopeLimit) -> EigenaxisBaseline {
        // Sums of the wheels' momenta and torques per unit of rate and acceleration.
        let held = -(self.spacecraft.inertia() * axis);
        let taken = -(self.spacecraft.effective_inertia() * axis);
        let momentum = self.envelopes.momentum.as_ref();
        let by_wheels = momentum.map(|momentum| limit.multiple(&momentum.envelopes, &held));
        let per_axis = axis
            .abs()
            .zip_map(&self.spacecraft.max_rate(), |share, most| most / share);
        let rate = by_wheels
            .unwrap_or(f64::INFINITY)
            .min(per_axis.min())
            .min(self.spacecraft.max_rate_norm());
        // With uneven torque limits both ramps have the smaller acceleration.
        let torque = &self.envelopes.torque.envelopes;
        let speeding = limit.multiple(torque, &taken);
        let braking = limit.multiple(torque, &-taken);
        let course = BangCoastBang::fastest(angle, speeding.min(braking), rate);
        EigenaxisBaseline {
            limit,
            axis,
            course,
            peak_momentum: held * course.rate(),
            ramp_torque: taken * course.acceleration(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::attitude::Attitude;
    use slewplan_solver::model::plan::Outcome;
    use slewplan_solver::model::scenario::Scenario;
    use slewplan_solver::model::spec::{
        AttitudeSpec, ScenarioSpec, SpacecraftSpec, TargetSpec, WheelSpec,
    };
    use slewplan_solver::run::pool::SolverPool;
    use slewplan_solver::run::progress::Silent;
    use slewplan_solver::run::stop::StopSignal;
    use slewplan_solver::tour::legs::NoStore;
    use slewplan_solver::tour::planner::{Run, solve};

    const S: f64 = 0.816_496_580_927_726;
    const C: f64 = 0.577_350_269_189_625_8;

    /// The thesis's spacecraft: 25.4 kg m² about every axis, wheels of 1 N m s and 85.7 mN m.
    fn thesis() -> SpacecraftSpec {
        let max_speed = 3000.0 * std::f64::consts::TAU / 60.0;
        let wheel = |axis| WheelSpec {
            axis,
            normalize_axis: true,
            inertia_kg_m2: 1.0 / max_speed,
            max_torque_nm: 0.0857,
            min_torque_nm: None,
            max_speed_rad_s: Some(max_speed),
            enabled: true,
        };
        SpacecraftSpec {
            inertia_kg_m2: [[25.4, 0.0, 0.0], [0.0, 25.4, 0.0], [0.0, 0.0, 25.4]],
            wheels: [[S, 0.0, C], [0.0, S, C], [-S, 0.0, C], [0.0, -S, C]]
                .map(wheel)
                .into(),
            ..SpacecraftSpec::default()
        }
    }

    fn slews(spec: &SpacecraftSpec, turn: Vector3<f64>) -> [EigenaxisBaseline; 4] {
        let spacecraft = Spacecraft::try_new(spec, "").unwrap();
        Baselines::of(&spacecraft, 1.0, 1.0)
            .unwrap()
            .slews(&turn)
            .unwrap()
    }

    #[test]
    fn the_published_slew_takes_51_6_seconds() {
        let turn = Vector3::new(S, 0.0, C) * 120.0_f64.to_radians();
        let [sphere, simple, full_sphere, full] = slews(&thesis(), turn);
        // The thesis prints 51.8 s of a simulation; its formula gives 51.57 s.
        assert!(
            (simple.course.duration() - 51.6).abs() < 0.05,
            "{:?}",
            simple.course
        );
        // The axis is that of a minor vertex, where the pseudo-inverse has only its sphere.
        assert!((sphere.course.duration() - simple.course.duration()).abs() < 1e-9);
        assert!((simple.peak_momentum.norm() - 4.0 / 3.0).abs() < 1e-12);
        assert!((full_sphere.peak_momentum.norm() - 1.633).abs() < 5e-4);
        assert!((full.peak_momentum.norm() - 2.0).abs() < 1e-12);
        let by_formula = |momentum: f64, torque: f64| {
            let (rate, effective) = (momentum / 25.4, 25.4 - 4.0 / 3.0 / 314.159_265);
            turn.norm() / rate + rate * effective / torque
        };
        assert!((full.course.duration() - by_formula(2.0, 2.0 * 0.0857)).abs() < 1e-6);
        assert!((simple.course.duration() - by_formula(4.0 / 3.0, 0.0857 / 0.75)).abs() < 1e-6);
    }

    #[test]
    fn the_planner_finds_the_same_slew() {
        let (pool, stop) = (SolverPool::new(None).unwrap(), StopSignal::new());
        let run = Run {
            pool: &pool,
            stop: &stop,
            observer: &Silent,
            legs: &NoStore,
            segments: &NoStore,
        };
        let mut spacecraft = thesis();
        spacecraft.inertia_kg_m2 = [[25.4, 1.0, -2.0], [1.0, 31.0, 0.5], [-2.0, 0.5, 18.0]];
        spacecraft.max_body_rate_rad_s = [None, Some(0.03), None];
        for turn in [[1.0, 0.3, -0.2], [0.1, -0.05, 0.02], [-0.4, 2.0, 1.0]] {
            let turn = Vector3::from(turn);
            let spec = ScenarioSpec {
                spacecraft: spacecraft.clone(),
                targets: vec![TargetSpec {
                    id: "t".into(),
                    attitude: AttitudeSpec::Quaternion(Attitude::from_rotation_vector(turn).xyzw()),
                    ..TargetSpec::default()
                }],
                ..ScenarioSpec::default()
            };
            let Outcome::Planned(plan) = solve(&Scenario::try_new(&spec).unwrap().scenario, run)
            else {
                panic!("{turn}")
            };
            let duration = slews(&spacecraft, turn)[1].course.duration();
            let planned = plan.legs[0].eigenaxis_duration_s.unwrap();
            assert!((duration / planned - 1.0).abs() < 1e-9, "{turn}");
        }
    }

    #[test]
    fn a_larger_limit_never_gives_a_longer_slew() {
        for turn in [[1.0, 0.0, 0.0], [0.2, -0.7, 1.3], [0.0, 0.0, 0.01]] {
            let [sphere, simple, full_sphere, full] =
                slews(&thesis(), Vector3::from(turn)).map(|slew| slew.course.duration());
            let slack = 1.0 + 1e-12;
            assert!(simple <= sphere * slack && full <= simple * slack);
            assert!(full_sphere <= sphere * slack && full <= full_sphere * slack);
        }
    }

    #[test]
    fn a_zero_turn_has_no_slew_and_authorities_must_be_in_zero_to_one() {
        let spacecraft = Spacecraft::try_new(&thesis(), "").unwrap();
        let baselines = Baselines::of(&spacecraft, 1.0, 1.0).unwrap();
        assert!(baselines.slews(&Vector3::zeros()).is_none());
        let problems = Baselines::of(&spacecraft, 0.0, 1.5).unwrap_err();
        let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
        assert_eq!(
            pointers,
            ["/options/torque_authority", "/options/momentum_authority"]
        );
    }

    #[test]
    fn without_a_wheel_speed_limit_the_body_rate_limit_counts() {
        let mut spec = thesis();
        spec.wheels[2].max_speed_rad_s = None;
        let turn = Vector3::new(3.0, 0.0, 0.0);
        let free = slews(&spec, turn)[1].course;
        assert!((free.duration() - 2.0 * free.ramp()).abs() < 1e-9);
        spec.max_body_rate_norm_rad_s = Some(0.01);
        assert!((slews(&spec, turn)[1].course.rate() - 0.01).abs() < 1e-15);
    }
}
