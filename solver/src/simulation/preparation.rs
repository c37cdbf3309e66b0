//! The motion of a plan, whether it can be simulated, and the nominal wheels.

use super::settings::SimulationSettings;
use super::truth::TrueWheel;
use crate::checker::PropagatedMotion;
use crate::model::findings::Findings;
use crate::model::plan::Flight;
use crate::model::problem::Code;
use crate::model::scenario::Scenario;

/// Greatest number of integration steps of one simulated flight: five hours at 100 Hz.
const MAX_STEPS: f64 = 2e6;
/// Greatest rate at the end of a plan, rad/s, at which its end can be held.
const REST: f64 = 1e-6;
/// Greatest decay of a wheel's speed by viscous friction in one step, relative: larger ones are not
/// integrated accurately.
const MAX_DECAY: f64 = 0.5;

/// The motion of the plan; a plan that cannot be propagated is refused.
pub(super) fn motion(
    scenario: &Scenario,
    flight: &Flight,
    findings: &mut Findings,
) -> Option<PropagatedMotion> {
    let total = flight.total_time_s;
    let slack = crate::checker::TIME_TOLERANCE * total;
    let mut arrivals = true;
    for passage in &flight.passages {
        // Written so that what is not a number is refused.
        if !(passage.time_s >= -slack && passage.time_s <= total + slack) {
            arrivals = false;
            let (name, time) = (&passage.target, passage.time_s);
            refuse_flight(
                findings,
                &format!("target \"{name}\" is reached at {time} s, outside of the flight"),
            );
        }
    }
    let motion = PropagatedMotion::of(scenario, flight);
    let motion = motion.map_err(|sentences| {
        for sentence in sentences {
            refuse_flight(findings, &sentence);
        }
    });
    motion.ok().filter(|_| arrivals)
}

/// Whether a flight is short enough, and ends at rest if its end is to be held.
pub(super) fn fits(
    flight: &Flight,
    motion: &PropagatedMotion,
    settings: &SimulationSettings,
    pointer: &str,
    findings: &mut Findings,
) -> bool {
    let seconds = flight.total_time_s + settings.settle_s;
    let step = (settings.sample_s / settings.cycles as f64).min(settings.max_step_s);
    let short = seconds / step <= MAX_STEPS;
    if !short {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!("{seconds:.0} s in steps of {step:.3e} s are more than {MAX_STEPS:.0e} steps"),
            "lower wheel_loop_rate_hz, settle_s or viscous_friction_nms, or raise max_step_s",
        );
    }
    let rate = motion
        .state(flight.total_time_s)
        .map_or(0.0, |state| state.body_rate_rad_s.norm());
    let held = settings.settle_s <= 0.0 || rate <= REST;
    if !held {
        findings.refuse(
            format!("{pointer}/settle_s"),
            Code::ConflictingFields,
            format!("the plan ends with a rate of {rate:.3e} rad/s and cannot be held there"),
            "leave settle_s out, or let the scenario end at rest",
        );
    }
    short && held
}

pub(super) fn refuse_flight(findings: &mut Findings, sentence: &str) {
    findings.refuse(
        "/plan",
        Code::VerificationFailed,
        sentence,
        "give a plan of this scenario, with controls from 0 s to its end",
    );
}

/// The step of the integration, s: short enough for the decay of wheel speeds by viscous friction too.
pub(super) fn longest_step(scenario: &Scenario, settings: &SimulationSettings) -> f64 {
    let wheels = scenario.spacecraft().wheels().iter().zip(&settings.drives);
    wheels.fold(settings.max_step_s, |step, (wheel, drive)| {
        if drive.viscous_friction > 0.0 {
            step.min(MAX_DECAY * wheel.inertia / drive.viscous_friction)
        } else {
            step
        }
    })
}

/// The nominal wheels: axes of the scenario, friction of the drives.
pub(super) fn rotors(scenario: &Scenario, settings: &SimulationSettings) -> Vec<TrueWheel> {
    let wheels = scenario.spacecraft().wheels().iter().zip(&settings.drives);
    wheels
        .map(|(wheel, drive)| TrueWheel {
            axis: wheel.axis,
            inertia: wheel.inertia,
            viscous: drive.viscous_friction,
            coulomb: drive.coulomb_friction,
            band: TrueWheel::band(drive.coulomb_friction, wheel.inertia, settings.max_step_s),
            driven: wheel.enabled,
        })
        .collect()
}
