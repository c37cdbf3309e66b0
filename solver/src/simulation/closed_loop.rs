//! One simulated flight: on-board computer, wheel loops and integration in turn.

use super::controller::{FeedbackController, Measured};
use super::draws::{DrawnFlight, draw, normals};
use super::outcome::{FlightLog, SimulatedFlight, SimulatedState, TrackingError};
use super::sampled_plan::ControlSample;
use super::stop_poll::StopPoll;
use super::truth::{IntegratorScratch, TrueSpacecraft, TrueState};
use super::{Simulation, wheel_loop};

use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;

impl Simulation<'_> {
    /// Simulates the plan with the errors drawn for one number. The result depends on seed and number
    /// only, not on other simulated flights.
    ///
    /// States are kept at every `keep_every`-th sample of the on-board computer, if it is given.
    /// `should_stop` is called first and then every few hundred steps of the integration; when it
    /// returns `true` the answer is `None`.
    #[must_use]
    pub fn simulate(
        &self,
        number: u64,
        keep_every: Option<usize>,
        should_stop: &dyn Fn() -> bool,
    ) -> Option<SimulatedFlight> {
        let mut stop_poll = StopPoll::new(should_stop)?;
        let wheels = self.scenario.spacecraft().wheels().len();
        let DrawnFlight {
            truth,
            start,
            noise,
        } = draw(self.scenario, &self.settings, &self.nominal, number);
        let mut craft = SimulatedSpacecraft::new(&truth, start, wheels);
        let mut computer = self.on_board_computer(noise);
        let mut log = FlightLog::open(self.scenario, self.flight);
        log.reach(
            &self.sampled_plan,
            0.0,
            craft.pose().as_ref().map(|p| (&p.0, &p.1)),
        );
        for (index, sample) in self.sampled_plan.samples.iter().enumerate() {
            let Some((attitude, rate)) = craft.pose() else {
                log.break_off(sample.time_s);
                break;
            };
            craft.read_speeds();
            self.compute(&mut computer, attitude, rate, sample, &craft);
            // Very large gains overflow.
            if !computer.feedback.iter().all(|torque| torque.is_finite()) {
                log.break_off(sample.time_s);
                break;
            }
            let error = TrackingError::of(&attitude, &rate, &sample.desired);
            log.sample(sample.time_s, &attitude, error);
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
            self.advance(
                &mut craft,
                sample,
                &computer.feedback,
                &mut stop_poll,
                &mut log,
            )?;
        }
        Some(log.close())
    }

    fn on_board_computer(&self, noise: SplitMix) -> OnBoardComputer<'_> {
        let spacecraft = self.scenario.spacecraft();
        OnBoardComputer {
            controller: FeedbackController::new(&self.settings, spacecraft),
            noise,
            feedback: vec![0.0; spacecraft.wheels().len()],
        }
    }

    /// One sample of the on-board computer: sensors, control law, allocation.
    fn compute(
        &self,
        computer: &mut OnBoardComputer<'_>,
        attitude: Attitude,
        rate: Vector3<f64>,
        sample: &ControlSample,
        craft: &SimulatedSpacecraft<'_>,
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

    /// Integrates until the next sample; `None` when the simulation is to stop.
    fn advance(
        &self,
        craft: &mut SimulatedSpacecraft<'_>,
        sample: &ControlSample,
        feedback: &[f64],
        stop_poll: &mut StopPoll<'_>,
        log: &mut FlightLog<'_>,
    ) -> Option<()> {
        let wheels = self.scenario.spacecraft().wheels();
        craft.missing.fill(0.0);
        for part in &self.sampled_plan.parts[sample.parts.clone()] {
            craft.read_speeds();
            let forward = self.sampled_plan.torques(part);
            for (index, wheel) in wheels.iter().enumerate().filter(|(_, w)| w.enabled) {
                let wanted = forward[index] + feedback[index];
                let (command, cut) = wheel_loop::commandable(wheel, wanted);
                let drive = &self.settings.drives[index];
                let mut cycle =
                    wheel_loop::cycle(wheel, drive, command, craft.speed[index], part.seconds);
                cycle.torque_limited |= cut;
                craft.motor[index] = cycle.motor_torque;
                let refused = if cut { wanted - command } else { 0.0 };
                craft.missing[index] += (refused + cycle.missing) * part.seconds;
                log.wheel(index, &cycle, part.seconds);
            }
            let step = part.seconds / part.steps as f64;
            let SimulatedSpacecraft {
                truth,
                state,
                motor,
                scratch,
                ..
            } = craft;
            stop_poll.over(part.steps, |steps| {
                truth.advance(state, motor, step, steps, scratch);
            })?;
            let pose = craft.pose();
            let pose = pose.as_ref().map(|(attitude, rate)| (attitude, rate));
            log.reach(&self.sampled_plan, part.end_s, pose);
        }
        Some(())
    }

    /// Commanded torques at a sample, N m, before the limits.
    fn commanded(&self, sample: &ControlSample, feedback: &[f64]) -> Vec<f64> {
        let part = self.sampled_plan.parts.get(sample.parts.start);
        let forward = part.map_or(&[][..], |part| self.sampled_plan.torques(part));
        forward.iter().zip(feedback).map(|(a, b)| a + b).collect()
    }
}

/// The spacecraft during the simulation.
struct SimulatedSpacecraft<'a> {
    truth: &'a TrueSpacecraft,
    state: TrueState,
    /// Speed of every wheel relative to the body, rad/s.
    speed: Vec<f64>,
    /// Torque of every motor, N m.
    motor: Vec<f64>,
    /// Integral of each wheel's commanded torque beyond its limits since the last sample, N m s.
    missing: Vec<f64>,
    scratch: IntegratorScratch,
}

impl<'a> SimulatedSpacecraft<'a> {
    fn new(truth: &'a TrueSpacecraft, start: TrueState, wheels: usize) -> Self {
        Self {
            scratch: IntegratorScratch::new(&start),
            state: start,
            truth,
            speed: vec![0.0; wheels],
            motor: vec![0.0; wheels],
            missing: vec![0.0; wheels],
        }
    }

    fn read_speeds(&mut self) {
        for (wheel, speed) in self.speed.iter_mut().enumerate() {
            *speed = self.truth.speed(&self.state, wheel);
        }
    }

    /// Attitude and rate; `None` when they are not finite.
    fn pose(&self) -> Option<(Attitude, Vector3<f64>)> {
        let q = &self.state.attitude;
        let attitude = Attitude::from_xyzw([q.i, q.j, q.k, q.w])?;
        let rate = self.state.rate;
        rate.norm().is_finite().then_some((attitude, rate))
    }
}

/// The on-board computer.
struct OnBoardComputer<'a> {
    controller: FeedbackController<'a>,
    noise: SplitMix,
    /// Torque that feedback adds to each wheel, N m.
    feedback: Vec<f64>,
}
