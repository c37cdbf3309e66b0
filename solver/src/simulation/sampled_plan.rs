//! A plan on the time grid of on-board computer and wheel loop; all simulated flights share it.
//!
//! Between two samples of the on-board computer lie the cycles of the wheel loop. At arrivals, at the
//! end of the plan and, with time-tagged torques, at their switches, a cycle is cut in two.

use super::controller::Desired;
use super::settings::SimulationSettings;
use super::spec::FeedForwardMode;
use crate::checker::PropagatedMotion;
use crate::model::plan::{Control, Flight};
use crate::model::scenario::Scenario;
use nalgebra::Vector3;
use std::ops::Range;

/// Share of a sample by which times may differ as rounding.
const ROUNDING: f64 = 1e-9;

/// A plan as samples of the on-board computer and parts of wheel-loop cycles.
#[derive(Debug)]
pub(super) struct SampledPlan {
    pub(super) samples: Vec<ControlSample>,
    pub(super) parts: Vec<CyclePart>,
    /// Times at which errors are recorded, in order.
    pub(super) marks: Vec<ErrorMark>,
    /// Torques fed forward, N m: one row per sample or control, each with one entry per wheel.
    torques: Vec<f64>,
    wheels: usize,
}

/// A sample of the on-board computer.
#[derive(Debug)]
pub(super) struct ControlSample {
    pub(super) time_s: f64,
    pub(super) desired: Desired,
    pub(super) parts: Range<usize>,
}

/// A cycle of the wheel loop, or a part of one.
#[derive(Debug)]
pub(super) struct CyclePart {
    pub(super) end_s: f64,
    pub(super) seconds: f64,
    pub(super) steps: usize,
    row: usize,
}

/// A time at which the error is recorded.
#[derive(Debug)]
pub(super) struct ErrorMark {
    pub(super) time_s: f64,
    pub(super) event: MarkEvent,
    /// The plan's state, also where the controller follows a step input.
    pub(super) planned: Desired,
}

/// The event of the plan at such a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MarkEvent {
    /// Arrival at the passage with this index.
    Arrival(usize),
    /// The end of the plan.
    PlanEnd,
    /// The end of the flight.
    End,
}

impl SampledPlan {
    /// Puts a plan with its propagated motion on the time grid.
    ///
    /// `None` when the motion has no state at some time.
    pub(super) fn new(
        scenario: &Scenario,
        flight: &Flight,
        motion: &PropagatedMotion,
        settings: &SimulationSettings,
    ) -> Option<Self> {
        let plan = PlanMotion {
            scenario,
            flight,
            motion,
        };
        let wheels = scenario.spacecraft().wheels().len();
        let marks = plan.marks(settings)?;
        let intervals = plan.intervals();
        let mut sampled_plan = Self {
            samples: Vec::new(),
            parts: Vec::new(),
            marks,
            torques: Vec::new(),
            wheels,
        };
        let end_s = flight.total_time_s + settings.settle_s;
        let cuts = sampled_plan.cuts(&intervals, settings);
        sampled_plan.lay(&plan, &intervals, &cuts, end_s, settings)?;
        Some(sampled_plan)
    }

    /// Torques fed forward during a part, N m, one per wheel.
    pub(super) fn torques(&self, part: &CyclePart) -> &[f64] {
        let begin = part.row * self.wheels;
        &self.torques[begin..begin + self.wheels]
    }

    /// Times at which cycles are cut, sorted.
    fn cuts(&self, intervals: &[TorqueInterval<'_>], settings: &SimulationSettings) -> Vec<f64> {
        let mut cuts: Vec<f64> = self.marks.iter().map(|mark| mark.time_s).collect();
        if settings.feed_forward == FeedForwardMode::TimeTagged {
            cuts.extend(intervals.iter().map(|interval| interval.end_s));
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }

    fn lay(
        &mut self,
        plan: &PlanMotion<'_>,
        intervals: &[TorqueInterval<'_>],
        cuts: &[f64],
        end_s: f64,
        settings: &SimulationSettings,
    ) -> Option<()> {
        let mut begin_s = 0.0;
        let mut done = 0;
        while begin_s < end_s {
            // Products, not sums, so that long flights do not drift off the grid.
            let next = (self.samples.len() + 1) as f64 * settings.sample_s;
            let last = next + ROUNDING * settings.sample_s >= end_s;
            let until = if last { end_s } else { next };
            while done < intervals.len() && intervals[done].end_s <= begin_s {
                done += 1;
            }
            let ahead = &intervals[done..];
            let first_piece = self.parts.len();
            self.cut(ahead, cuts, begin_s, until, settings);
            self.samples.push(ControlSample {
                time_s: begin_s,
                desired: if settings.step_input {
                    plan.at_rest()?
                } else {
                    plan.desired(begin_s)?
                },
                parts: first_piece..self.parts.len(),
            });
            begin_s = until;
        }
        Some(())
    }

    /// Adds the parts of one sample.
    fn cut(
        &mut self,
        ahead: &[TorqueInterval<'_>],
        cuts: &[f64],
        begin_s: f64,
        until: f64,
        settings: &SimulationSettings,
    ) {
        let cycle = settings.sample_s / settings.cycles as f64;
        let first = cuts.partition_point(|cut| *cut <= begin_s);
        let inside = cuts[first..].iter().take_while(|cut| **cut < until);
        let cycles = (1..settings.cycles).map(|index| begin_s + index as f64 * cycle);
        let mut ends: Vec<f64> = cycles.filter(|end| *end < until).collect();
        ends.extend(inside);
        ends.push(until);
        ends.sort_by(f64::total_cmp);
        let averaged = settings.feed_forward == FeedForwardMode::Averaged || settings.step_input;
        if averaged {
            self.average(ahead, begin_s, until, settings);
        }
        let mut from = begin_s;
        for end_s in ends {
            let seconds = end_s - from;
            if seconds <= 0.0 {
                continue;
            }
            if !averaged {
                self.copy(ahead, from + 0.5 * seconds);
            }
            self.parts.push(CyclePart {
                end_s,
                seconds,
                steps: steps(seconds, settings.max_step_s),
                row: self.torques.len() / self.wheels - 1,
            });
            from = end_s;
        }
    }

    /// Adds a row with the mean torques from one time to another; zero with a step input.
    fn average(
        &mut self,
        ahead: &[TorqueInterval<'_>],
        begin_s: f64,
        until: f64,
        settings: &SimulationSettings,
    ) {
        let begin = self.torques.len();
        self.torques.resize(begin + self.wheels, 0.0);
        if settings.step_input {
            return;
        }
        let row = &mut self.torques[begin..];
        for interval in ahead.iter().take_while(|i| i.begin_s < until) {
            let overlap = interval.end_s.min(until) - interval.begin_s.max(begin_s);
            let share = overlap.max(0.0) / (until - begin_s);
            for (mean, torque) in row.iter_mut().zip(&interval.control.wheel_torque_nm) {
                *mean += share * torque;
            }
        }
    }

    /// Adds a row with the torques at a time.
    fn copy(&mut self, ahead: &[TorqueInterval<'_>], time_s: f64) {
        let at = ahead.iter().find(|interval| time_s < interval.end_s);
        match at {
            Some(interval) => self
                .torques
                .extend_from_slice(&interval.control.wheel_torque_nm),
            None => self.torques.resize(self.torques.len() + self.wheels, 0.0),
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the number of steps of a flight is limited before"
)]
fn steps(seconds: f64, longest: f64) -> usize {
    (seconds / longest - ROUNDING).ceil().max(1.0) as usize
}

/// A control of the plan with its beginning and end.
struct TorqueInterval<'a> {
    begin_s: f64,
    end_s: f64,
    control: &'a Control,
}

/// A plan with its propagated motion.
struct PlanMotion<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
    motion: &'a PropagatedMotion,
}

impl<'a> PlanMotion<'a> {
    /// From the beginning of one control to that of the next, as the checker integrates them.
    fn intervals(&self) -> Vec<TorqueInterval<'a>> {
        let controls = &self.flight.controls;
        let total = self.flight.total_time_s;
        let ends = controls
            .iter()
            .skip(1)
            .map(|next| next.start_s)
            .chain([total]);
        let mut begin_s = 0.0;
        controls
            .iter()
            .zip(ends)
            .map(|(control, end)| {
                let end_s = end.clamp(begin_s, total);
                let interval = TorqueInterval {
                    begin_s,
                    end_s,
                    control,
                };
                begin_s = end_s;
                interval
            })
            .collect()
    }

    fn marks(&self, settings: &SimulationSettings) -> Option<Vec<ErrorMark>> {
        let total = self.flight.total_time_s;
        let mut marks = Vec::new();
        for (index, passage) in self.flight.passages.iter().enumerate() {
            let time_s = passage.time_s.clamp(0.0, total);
            marks.push(ErrorMark {
                time_s,
                event: MarkEvent::Arrival(index),
                planned: self.desired(time_s)?,
            });
        }
        let end_s = total + settings.settle_s;
        for (time_s, event) in [(total, MarkEvent::PlanEnd), (end_s, MarkEvent::End)] {
            marks.push(ErrorMark {
                time_s,
                event,
                planned: self.desired(time_s)?,
            });
        }
        marks.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        Some(marks)
    }

    /// The plan's state at a time, s; after its end, its final attitude at rest.
    fn desired(&self, time_s: f64) -> Option<Desired> {
        if time_s > self.flight.total_time_s {
            return self.at_rest();
        }
        let state = self.motion.state(time_s)?;
        let rate = state.body_rate_rad_s;
        let craft = self.scenario.spacecraft();
        let momentum = craft.body_momentum(rate, &state.wheel_speed_rad_s);
        Some(Desired {
            attitude: state.attitude,
            rate,
            gyroscopic: rate.cross(&momentum),
        })
    }

    /// The plan's final attitude at rest.
    fn at_rest(&self) -> Option<Desired> {
        let state = self.motion.state(self.flight.total_time_s)?;
        Some(Desired {
            attitude: state.attitude,
            rate: Vector3::zeros(),
            gyroscopic: Vector3::zeros(),
        })
    }
}
