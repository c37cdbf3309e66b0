//! Plans flown in closed loop, with a truth that differs from what is believed.
//!
//! A plan's torques are the feed-forward; a [control law](ControllerSpec) on the on-board computer
//! adds feedback through the pseudo-inverse of the wheel axes; a faster loop at each wheel makes up
//! for friction and keeps torque and speed within the limits of the hardware. The body that is flown
//! has an inertia, wheel axes and friction of its own, and all its 7 + K states are integrated.
//! Whatever a plan holds back of the wheels ([`torque_authority`] and [`momentum_authority`]) is what
//! feedback has to work with.
//!
//! Everything random follows from a seed and the number of the flight, so that flights can be
//! repeated one by one and do not depend on the number of threads.
//!
//! The plan's motion comes from the [`checker`](crate::checker); neither it nor anything of the
//! optimiser is used in the loop.
//!
//! [`torque_authority`]: crate::model::spec::OptionsSpec::torque_authority
//! [`momentum_authority`]: crate::model::spec::OptionsSpec::momentum_authority

mod allocation;
mod controller;
mod course;
mod draws;
mod gains;
mod lookout;
mod monte_carlo;
mod outcome;
mod settings;
mod spec;
mod truth;
mod wheel_loop;

pub use gains::Gains;
pub use monte_carlo::{PassageSpread, Percentiles, SaturationSpread, Spread};
pub use outcome::{PassageError, Saturation, SimulatedFlight, SimulatedState, TrackingError};
pub use spec::{ControllerSpec, ErrorsSpec, FeedForward, GainsSpec, PidGainsSpec, SimulationSpec};

use crate::checker::PropagatedMotion;
use crate::model::attitude::Attitude;
use crate::model::findings::Findings;
use crate::model::plan::Flight;
use crate::model::problem::{Code, Problem};
use crate::model::scenario::Scenario;
use crate::model::spacecraft::Spacecraft;
use controller::{Controller, Measured};
use course::{Course, Sample};
use draws::{Drawn, draw, normals};
use lookout::Lookout;
use nalgebra::Vector3;
use outcome::Log;
use settings::Settings;
use truth::{Rotor, Scratch, State, Truth};

/// Most steps of integration of one flight: five hours at 100 Hz.
const MAX_STEPS: f64 = 2e6;
/// Rate at the end of a plan, rad/s, up to which it can be held there.
const REST: f64 = 1e-6;
/// Decay of a wheel's speed by viscous friction in one step that the integration follows closely.
const MAX_DECAY: f64 = 0.5;

/// A plan ready to be flown any number of times.
#[derive(Debug)]
pub struct Simulation<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
    settings: Settings,
    course: Course,
    /// As believed, but for the disturbance torque.
    nominal: Truth,
}

impl<'a> Simulation<'a> {
    /// Validates how a flight of a scenario is to be simulated and collects every problem; `pointer`
    /// is the JSON pointer of the description.
    ///
    /// # Errors
    ///
    /// All problems at once. Those of the flight itself, which may come from anyone, have the code
    /// [`Code::VerificationFailed`] and the pointer `/plan`.
    pub fn try_new(
        scenario: &'a Scenario,
        flight: &'a Flight,
        spec: &SimulationSpec,
        pointer: &str,
    ) -> Result<Self, Vec<Problem>> {
        let mut findings = Findings::default();
        let settings = Settings::read(spec, scenario.spacecraft(), pointer, &mut findings);
        let motion = motion(scenario, flight, &mut findings);
        let simulation = settings.zip(motion).and_then(|(mut settings, motion)| {
            settings.max_step_s = longest_step(scenario, &settings);
            fits(flight, &motion, &settings, pointer, &mut findings)
                .then(|| Self::prepare(scenario, flight, settings, &motion, &mut findings))?
        });
        findings
            .conclude(simulation)
            .map(|(simulation, _)| simulation)
    }

    fn prepare(
        scenario: &'a Scenario,
        flight: &'a Flight,
        settings: Settings,
        motion: &PropagatedMotion,
        findings: &mut Findings,
    ) -> Option<Self> {
        let course = Course::new(scenario, flight, motion, &settings);
        let nominal = Truth::new(
            scenario.spacecraft().inertia(),
            rotors(scenario, &settings),
            &scenario.start().wheel_speed,
            settings.errors.disturbance,
        );
        let prepared = course.zip(nominal);
        if prepared.is_none() {
            refuse_flight(
                findings,
                "the motion leaves the numbers that can be computed",
            );
        }
        let (course, nominal) = prepared?;
        Some(Self {
            scenario,
            flight,
            settings,
            course,
            nominal,
        })
    }

    /// Flies the plan with the errors of one flight: the same whatever else is flown.
    ///
    /// States are kept at every `keep_every`-th sample of the on-board computer, if any. `give_up` is
    /// asked before the flight and every few hundred steps of the integration: `None` when it says so,
    /// since half a flight tells nothing.
    #[must_use]
    pub fn fly(
        &self,
        number: u64,
        keep_every: Option<usize>,
        give_up: &dyn Fn() -> bool,
    ) -> Option<SimulatedFlight> {
        let mut lookout = Lookout::new(give_up)?;
        let wheels = self.scenario.spacecraft().wheels().len();
        let Drawn {
            truth,
            start,
            noise,
        } = draw(self.scenario, &self.settings, &self.nominal, number);
        let mut craft = Craft {
            scratch: Scratch::new(&start),
            state: start,
            truth: &truth,
            speed: vec![0.0; wheels],
            motor: vec![0.0; wheels],
            missing: vec![0.0; wheels],
        };
        let mut computer = OnBoard {
            controller: Controller::new(&self.settings, self.scenario.spacecraft()),
            noise,
            feedback: vec![0.0; wheels],
        };
        let mut log = Log::open(self.flight, wheels);
        log.reach(
            &self.course,
            0.0,
            craft.pose().as_ref().map(|p| (&p.0, &p.1)),
        );
        for (index, sample) in self.course.samples.iter().enumerate() {
            let Some((attitude, rate)) = craft.pose() else {
                log.break_off();
                break;
            };
            craft.read_speeds();
            self.compute(&mut computer, (attitude, rate), sample, &craft);
            // Gains beyond all numbers ask for a torque that is none.
            if !computer.feedback.iter().all(|torque| torque.is_finite()) {
                log.break_off();
                break;
            }
            let error = TrackingError::of(&attitude, &rate, &sample.desired);
            log.sample(error);
            if keep_every.is_some_and(|every| index % every.max(1) == 0) {
                log.keep(SimulatedState {
                    time_s: sample.time_s,
                    attitude,
                    body_rate_rad_s: rate,
                    wheel_speed_rad_s: craft.speed.clone(),
                    wheel_torque_nm: self.commanded(sample, &computer.feedback),
                    torque_limited: vec![false; wheels],
                    speed_limited: vec![false; wheels],
                    error,
                });
            }
            let steering = (&*computer.feedback, &mut lookout);
            self.advance(&mut craft, sample, steering, &mut log)?;
        }
        Some(log.close())
    }

    /// Number of samples of the on-board computer.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.course.samples.len()
    }

    /// Time between two samples of the on-board computer, s.
    #[must_use]
    pub fn sample_s(&self) -> f64 {
        self.settings.sample_s
    }

    /// Duration of a flight with the time to settle, s.
    #[must_use]
    pub fn flight_time_s(&self) -> f64 {
        self.flight.total_time_s + self.settings.settle_s
    }

    /// Attitude error at the end up to which a flight counts as a success, rad.
    #[must_use]
    pub fn tolerance_rad(&self) -> f64 {
        self.settings.tolerance
    }

    /// A sample of the on-board computer: sensors, control law, allocation.
    fn compute(
        &self,
        computer: &mut OnBoard<'_>,
        (attitude, rate): (Attitude, Vector3<f64>),
        sample: &Sample,
        craft: &Craft<'_>,
    ) {
        let errors = &self.settings.errors;
        let off = normals(&mut computer.noise) * errors.attitude_noise;
        let rate_off = normals(&mut computer.noise) * errors.rate_noise;
        let measured = Measured {
            attitude: attitude.retract(off),
            rate: rate + rate_off,
            wheel_speed: &craft.speed,
            missing: &craft.missing,
        };
        computer
            .controller
            .sample(&measured, &sample.desired, &mut computer.feedback);
    }

    /// Flies until the next sample; `None` when the flight is given up.
    fn advance(
        &self,
        craft: &mut Craft<'_>,
        sample: &Sample,
        (feedback, lookout): (&[f64], &mut Lookout<'_>),
        log: &mut Log,
    ) -> Option<()> {
        let wheels = self.scenario.spacecraft().wheels();
        craft.missing.fill(0.0);
        for piece in &self.course.pieces[sample.pieces.clone()] {
            craft.read_speeds();
            let forward = self.course.torques(piece);
            for (index, wheel) in wheels.iter().enumerate().filter(|(_, w)| w.enabled) {
                let wanted = forward[index] + feedback[index];
                let (command, cut) = wheel_loop::commandable(wheel, wanted);
                let drive = &self.settings.drives[index];
                let mut cycle =
                    wheel_loop::cycle(wheel, drive, command, craft.speed[index], piece.seconds);
                cycle.torque_limited |= cut;
                craft.motor[index] = cycle.motor_torque;
                let refused = if cut { wanted - command } else { 0.0 };
                craft.missing[index] += (refused + cycle.missing) * piece.seconds;
                log.wheel(index, &cycle, piece.seconds);
            }
            let step = piece.seconds / piece.steps as f64;
            let Craft {
                truth,
                state,
                motor,
                scratch,
                ..
            } = craft;
            lookout.over(piece.steps, |steps| {
                truth.advance(state, motor, (step, steps), scratch);
            })?;
            let pose = craft.pose();
            let pose = pose.as_ref().map(|(attitude, rate)| (attitude, rate));
            log.reach(&self.course, piece.end_s, pose);
        }
        Some(())
    }

    /// Commanded torques at a sample, N m, before the limits.
    fn commanded(&self, sample: &Sample, feedback: &[f64]) -> Vec<f64> {
        let piece = self.course.pieces.get(sample.pieces.start);
        let forward = piece.map_or(&[][..], |piece| self.course.torques(piece));
        forward.iter().zip(feedback).map(|(a, b)| a + b).collect()
    }
}

/// What is wrong with how a spacecraft is to be flown, as far as that does not depend on the plan;
/// `pointer` is the JSON pointer of the description.
#[must_use]
pub fn check(spec: &SimulationSpec, spacecraft: &Spacecraft, pointer: &str) -> Vec<Problem> {
    let mut findings = Findings::default();
    let settings = Settings::read(spec, spacecraft, pointer, &mut findings);
    findings.conclude(settings).err().unwrap_or_default()
}

/// The spacecraft in flight.
struct Craft<'a> {
    truth: &'a Truth,
    state: State,
    /// Of every wheel relative to the body, rad/s.
    speed: Vec<f64>,
    /// Of every motor, N m.
    motor: Vec<f64>,
    /// What each wheel was asked for beyond its limits since the last sample, N m s.
    missing: Vec<f64>,
    scratch: Scratch,
}

impl Craft<'_> {
    fn read_speeds(&mut self) {
        for (wheel, speed) in self.speed.iter_mut().enumerate() {
            *speed = self.truth.speed(&self.state, wheel);
        }
    }

    /// Attitude and rate; `None` when they are no longer numbers.
    fn pose(&self) -> Option<(Attitude, Vector3<f64>)> {
        let q = &self.state.attitude;
        let attitude = Attitude::from_xyzw([q.i, q.j, q.k, q.w])?;
        let rate = self.state.rate;
        rate.norm().is_finite().then_some((attitude, rate))
    }
}

/// The on-board computer.
struct OnBoard<'a> {
    controller: Controller<'a>,
    noise: crate::math::random::SplitMix,
    /// Torques of the wheels that feedback adds, N m.
    feedback: Vec<f64>,
}

/// The plan's own motion; what keeps it from being flown is noted.
fn motion(
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

/// Whether a flight is short enough, and at rest where it is to be held.
fn fits(
    flight: &Flight,
    motion: &PropagatedMotion,
    settings: &Settings,
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

fn refuse_flight(findings: &mut Findings, sentence: &str) {
    findings.refuse(
        "/plan",
        Code::VerificationFailed,
        sentence,
        "give a plan of this scenario, with controls from 0 s to its end",
    );
}

/// The step of the integration, s, that also follows how friction slows down the wheels.
fn longest_step(scenario: &Scenario, settings: &Settings) -> f64 {
    let wheels = scenario.spacecraft().wheels().iter().zip(&settings.drives);
    wheels.fold(settings.max_step_s, |step, (wheel, drive)| {
        if drive.viscous_friction > 0.0 {
            step.min(MAX_DECAY * wheel.inertia / drive.viscous_friction)
        } else {
            step
        }
    })
}

/// The wheels as they are believed to be.
fn rotors(scenario: &Scenario, settings: &Settings) -> Vec<Rotor> {
    let wheels = scenario.spacecraft().wheels().iter().zip(&settings.drives);
    wheels
        .map(|(wheel, drive)| Rotor {
            axis: wheel.axis,
            inertia: wheel.inertia,
            viscous: drive.viscous_friction,
            coulomb: drive.coulomb_friction,
            band: Rotor::band(drive.coulomb_friction, wheel.inertia, settings.max_step_s),
            driven: wheel.enabled,
        })
        .collect()
}

#[cfg(test)]
mod tests;
