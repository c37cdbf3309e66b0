//! Legs are flown by the checker before anyone relies on them.

use super::canonical::CanonicalLeg;
use super::places::Places;
use super::torques::{SHORTEST, torques};
use crate::checker::{Arrival, leg_faults};
use crate::plan::{Control, Flight, State};
use crate::profile::Profile;
use crate::scenario::RateCondition;
use nalgebra::Vector3;

/// Whether a solved leg flies as it says: from where it begins to the attitude and the rates where
/// it is to end, within all limits.
pub(super) fn flies(places: &Places<'_>, leg: &CanonicalLeg, profile: &Profile) -> bool {
    let (Some(begin), Some(last)) = (begin(places, leg, profile), profile.attitudes.last()) else {
        return false;
    };
    let target = leg.arrival.signed(&leg.to.attitude, last);
    let arrival = Arrival {
        quaternion: target.xyzw(),
        rate: leg.to.rate.map(|condition| match condition {
            RateCondition::Fixed(rate) => Some(rate),
            RateCondition::Free | RateCondition::Within(..) => None,
        }),
    };
    let flight = flight(places, profile);
    leg_faults(places.scenario, &begin, &flight, &arrival).is_empty()
}

/// The state at the beginning: given rates as given, the others as the motion has them.
fn begin(places: &Places<'_>, leg: &CanonicalLeg, profile: &Profile) -> Option<State> {
    let (attitude, wheels) = (profile.attitudes.first()?, profile.wheels.first()?);
    let flown = leg.dynamics.rate(attitude, wheels);
    let rate = Vector3::from_fn(|axis, _| match leg.from.rate[axis] {
        RateCondition::Fixed(rate) => rate,
        RateCondition::Free | RateCondition::Within(..) => flown[axis],
    });
    let mut speeds = places.scenario.start().wheel_speed.clone();
    for (actuator, momentum) in leg.dynamics.actuators.iter().zip(wheels.iter()) {
        speeds[actuator.index] = momentum / actuator.inertia - actuator.axis.dot(&rate);
    }
    Some(State {
        time_s: 0.0,
        attitude: *attitude,
        body_rate_rad_s: rate,
        wheel_speed_rad_s: speeds,
    })
}

fn flight(places: &Places<'_>, profile: &Profile) -> Flight {
    let mut clock = 0.0;
    let mut controls = Vec::with_capacity(profile.intervals());
    let shortest = SHORTEST * profile.duration();
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
