//! The multi-phase problem: fly through waypoints in a fixed order in minimum time.
//!
//! A leg is the case of two waypoints, a tour that of many. Rate components and wheel momenta that
//! a waypoint leaves free are continuous across it, which couples neighbouring legs.

mod between_nodes;

use crate::attitude::Attitude;
use crate::dynamics::Dynamics;
use crate::kinematics::TurnMap;
use crate::nlp::{InteriorPoint, Iterate, NlpStatus, Settings};
use crate::profile::Profile;
use crate::transcription::{Scales, Transcription, Waypoint};
use between_nodes::excess_between_nodes;
use nalgebra::DVector;

/// Turn per substep, rad, up to which the integration error stays below 3e-7 rad, also where
/// stored momentum and torque at the limits bend the motion within an interval.
const LARGEST_SUBSTEP: f64 = 0.25;
/// Rounds of refining the substeps and the reserve at limits.
const MAX_ROUNDS: usize = 6;
/// Barrier parameter of a round that only integrates more finely: the iterate is nearly optimal.
const WARM_BARRIER: f64 = 1e-7;
/// Relative excess over a limit between nodes that is not worth another round; the checker's
/// tolerance is ten times this.
const LIMIT_TOLERANCE: f64 = 1e-7;

/// A solved flight.
#[derive(Debug, Clone)]
pub(crate) struct Flown {
    /// How the NLP ended.
    pub(crate) status: NlpStatus,
    /// The motion; of use only when converged.
    pub(crate) profile: Profile,
    /// Interior-point iterations.
    pub(crate) iterations: usize,
    /// Largest violation of any condition at the end, scaled.
    pub(crate) infeasibility: f64,
}

impl Flown {
    /// Duration, s, when the NLP converged.
    pub(crate) fn duration(&self) -> Option<f64> {
        (self.status == NlpStatus::Converged).then(|| self.profile.duration())
    }

    /// Whether it beats another flight: converged ones beat all others, ties go to the other.
    pub(crate) fn improves(&self, other: &Flown) -> bool {
        match (self.duration(), other.duration()) {
            (Some(new), Some(old)) => new < old * (1.0 - SAME_DURATION),
            (Some(_), None) => true,
            (None, _) => false,
        }
    }
}

/// Relative difference below which two durations are the same.
const SAME_DURATION: f64 = 1e-9;

/// Flies through waypoints from a guess whose nodes are split into legs by `intervals`.
pub(crate) fn fly(
    dynamics: &Dynamics,
    waypoints: &[Waypoint],
    intervals: &[usize],
    guess: &Profile,
    stop: &dyn Fn() -> bool,
) -> Flown {
    let scales = Scales::for_angle(dynamics, typical_angle(waypoints));
    let mut settings = Settings::default();
    let reference = guess.duration() / guess.intervals().max(1) as f64 / scales.time;
    let (inverse, with_momentum) = (dynamics.inertia_inverse, dynamics.has_momentum());
    let mut substeps = 0;
    let mut turn_map = TurnMap::fast(inverse, with_momentum);
    let mut reserve = 0.0;
    let mut iterate = scaled(guess, &scales);
    let mut flown = Flown {
        status: NlpStatus::IterationLimit,
        profile: guess.clone(),
        iterations: 0,
        infeasibility: f64::MAX,
    };
    for _ in 0..MAX_ROUNDS {
        let chain = Transcription::new(dynamics, scales, waypoints, intervals, turn_map)
            .with_reserve(reserve)
            .with_reference_length(reference);
        let mut engine = InteriorPoint::new(&chain, settings);
        let report = engine.solve(&chain, &mut iterate, stop);
        flown = Flown {
            status: report.status,
            profile: physical(&iterate, &scales, dynamics.wheel_count()),
            iterations: flown.iterations + report.iterations,
            infeasibility: report.infeasibility,
        };
        if report.status != NlpStatus::Converged {
            return flown;
        }
        let needed = substeps_for(&flown.profile);
        let excess = excess_between_nodes(dynamics, &flown.profile);
        if needed <= substeps && excess <= LIMIT_TOLERANCE {
            return flown;
        }
        substeps = substeps.max(needed);
        turn_map = TurnMap::exact(inverse, with_momentum, substeps);
        if excess > LIMIT_TOLERANCE {
            // Slacks belong to the old limits: begin again from the primal point alone.
            reserve += 1.2 * excess;
            iterate = scaled(&flown.profile, &scales);
            settings = Settings::default();
        } else {
            settings.initial_barrier = WARM_BARRIER;
        }
    }
    // Converged at the nodes, and yet not to be flown: more rounds would be needed.
    Flown {
        status: NlpStatus::IterationLimit,
        ..flown
    }
}

/// The middle one of the legs' turns, rad.
fn typical_angle(waypoints: &[Waypoint]) -> f64 {
    let mut angles: Vec<f64> = waypoints
        .windows(2)
        .map(|pair| pair[0].attitude.signed_turn_to(&pair[1].attitude).norm())
        .collect();
    angles.sort_by(f64::total_cmp);
    angles.get(angles.len() / 2).copied().unwrap_or(1.0)
}

fn scaled(profile: &Profile, scales: &Scales) -> Iterate {
    let mut points = Vec::new();
    for (attitude, wheels) in profile.attitudes.iter().zip(&profile.wheels) {
        points.extend_from_slice(&attitude.xyzw());
        points.extend(wheels.iter().map(|h| h / scales.momentum));
    }
    let mut controls = Vec::new();
    for (pair, length) in profile.wheels.windows(2).zip(&profile.lengths) {
        controls.extend(
            pair[1]
                .iter()
                .zip(pair[0].iter())
                .map(|(b, a)| (b - a) / scales.momentum),
        );
        controls.push(length / scales.time);
    }
    Iterate::cold(points, controls)
}

fn physical(iterate: &Iterate, scales: &Scales, wheels: usize) -> Profile {
    let mut profile = Profile::empty();
    for point in iterate.points.chunks_exact(4 + wheels) {
        let components = [point[0], point[1], point[2], point[3]];
        // Retraction keeps quaternions at unit length.
        profile
            .attitudes
            .push(Attitude::from_xyzw(components).unwrap_or_else(Attitude::identity));
        let momenta = point[4..].iter().map(|h| h * scales.momentum);
        profile.wheels.push(DVector::from_iterator(wheels, momenta));
    }
    for control in iterate.controls.chunks_exact(wheels + 1) {
        profile.lengths.push(control[wheels] * scales.time);
    }
    profile
}

fn substeps_for(profile: &Profile) -> usize {
    let largest = profile
        .attitudes
        .windows(2)
        .map(|pair| pair[0].angle_to(&pair[1]))
        .fold(0.0, f64::max);
    // An interval turns by half a revolution at the very most.
    (1..10_u8)
        .find(|count| largest <= LARGEST_SUBSTEP * f64::from(*count))
        .map_or(10, usize::from)
}
