//! Verification of solved, stored and imported legs by the independent checker.

use super::canonical::CanonicalLeg;
use super::places::Places;
use super::torques::{MIN_PIECE_SHARE, torques};
use crate::checker::{ATTITUDE_TOLERANCE, LegEnd, leg_faults};
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use crate::model::plan::{Control, Flight, State};
use crate::model::scenario::RateCondition;
use nalgebra::{DVector, Vector3};

/// Whether the checker integrates a solved leg from its begin to the attitude and rates of its end
/// within all limits.
pub(super) fn is_feasible(places: &Places<'_>, leg: &CanonicalLeg, profile: &Profile) -> bool {
    flight_faults(places, leg, profile).is_empty()
}

/// The checker's objections to a leg: limits exceeded, or an end missed.
pub(super) fn flight_faults(
    places: &Places<'_>,
    leg: &CanonicalLeg,
    profile: &Profile,
) -> Vec<String> {
    let (Some(begin), Some(last)) = (begin(places, leg, profile), profile.attitudes.last()) else {
        return vec!["there is no motion".into()];
    };
    let target = leg.to.rolled_towards(last).attitude;
    let target = leg.arrival.signed(&target, last);
    let arrival = LegEnd {
        quaternion: target.xyzw(),
        rate: leg.to.rate.map(|condition| match condition {
            RateCondition::Fixed(rate) => Some(rate),
            RateCondition::Free | RateCondition::Within(..) => None,
        }),
    };
    let flight = flight(places, profile);
    leg_faults(
        places.scenario,
        &begin,
        &flight,
        &arrival,
        &leg.dynamics.cones,
    )
}

/// Intervals whose end node is not reached from their begin node under the leg's torques: every
/// interval is integrated on its own.
pub(super) fn node_faults(
    places: &Places<'_>,
    leg: &CanonicalLeg,
    profile: &Profile,
) -> Vec<String> {
    let shortest = MIN_PIECE_SHARE * profile.duration();
    let mut faults = Vec::new();
    for k in 0..profile.intervals() {
        let part = profile.part(k..k + 1);
        let next = &part.attitudes[1];
        if part.duration() <= shortest {
            if part.attitudes[0].signed_turn_to(next).norm() > ATTITUDE_TOLERANCE {
                faults.push(format!("between nodes {k} and {} it jumps", k + 1));
            }
            continue;
        }
        let rate = |node: usize| leg.dynamics.rate(&part.attitudes[node], &part.wheels[node]);
        let begin = state(places, leg, &part.attitudes[0], &part.wheels[0], rate(0));
        let end = rate(1);
        let arrival = LegEnd {
            quaternion: next.xyzw(),
            rate: [end.x, end.y, end.z].map(Some),
        };
        let found = leg_faults(
            places.scenario,
            &begin,
            &flight(places, &part),
            &arrival,
            &leg.dynamics.cones,
        );
        let located = |fault: String| format!("between nodes {k} and {}: {fault}", k + 1);
        faults.extend(found.into_iter().map(located));
    }
    faults
}

/// The state at the beginning: prescribed rates as prescribed, the others from the motion.
fn begin(places: &Places<'_>, leg: &CanonicalLeg, profile: &Profile) -> Option<State> {
    let (attitude, wheels) = (profile.attitudes.first()?, profile.wheels.first()?);
    let found = leg.dynamics.rate(attitude, wheels);
    let rate = Vector3::from_fn(|axis, _| match leg.from.rate[axis] {
        RateCondition::Fixed(rate) => rate,
        RateCondition::Free | RateCondition::Within(..) => found[axis],
    });
    Some(state(places, leg, attitude, wheels, rate))
}

/// A state with the speeds of all wheels, from the momenta of the enabled ones.
fn state(
    places: &Places<'_>,
    leg: &CanonicalLeg,
    attitude: &Attitude,
    wheels: &DVector<f64>,
    rate: Vector3<f64>,
) -> State {
    let mut speeds = places.scenario.start().wheel_speed.clone();
    for (actuator, momentum) in leg.dynamics.actuators.iter().zip(wheels.iter()) {
        speeds[actuator.index] = momentum / actuator.inertia - actuator.axis.dot(&rate);
    }
    State {
        time_s: 0.0,
        attitude: *attitude,
        body_rate_rad_s: rate,
        wheel_speed_rad_s: speeds,
    }
}

/// The torques of a motion as a flight that the checker can integrate.
fn flight(places: &Places<'_>, profile: &Profile) -> Flight {
    let mut clock = 0.0;
    let mut controls = Vec::with_capacity(profile.intervals());
    let shortest = MIN_PIECE_SHARE * profile.duration();
    for (duration, torque) in torques(profile, 0..profile.intervals(), shortest) {
        controls.push(Control {
            start_s: clock,
            duration_s: duration,
            wheel_torque_nm: places.all_torques(torque.iter().copied()),
        });
        clock += duration;
    }
    Flight {
        total_time_s: clock,
        passages: Vec::new(),
        controls,
    }
}
