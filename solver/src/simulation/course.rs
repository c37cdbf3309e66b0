//! A plan laid out in time for the computers that fly it: the same for every flight of it.
//!
//! Between two samples of the on-board computer lie the cycles of the loop at the wheels; at arrivals,
//! at the end of the plan and, with time-tagged torques, at their switches, a cycle is cut in two.

use super::controller::Desired;
use super::settings::Settings;
use super::spec::FeedForward;
use crate::checker::PropagatedMotion;
use crate::model::plan::{Control, Flight};
use crate::model::scenario::Scenario;
use nalgebra::Vector3;
use std::ops::Range;

/// Part of a sample below which the last one is rounding.
const ROUNDING: f64 = 1e-9;

/// A plan in samples and pieces.
#[derive(Debug)]
pub(super) struct Course {
    pub(super) samples: Vec<Sample>,
    pub(super) pieces: Vec<Piece>,
    /// In order of time.
    pub(super) marks: Vec<Mark>,
    /// Torques fed forward, N m: one row per sample or control, each with one entry per wheel.
    torques: Vec<f64>,
    wheels: usize,
}

/// A moment at which the on-board computer acts.
#[derive(Debug)]
pub(super) struct Sample {
    pub(super) time_s: f64,
    pub(super) desired: Desired,
    pub(super) pieces: Range<usize>,
}

/// A cycle of the loop at the wheels, or a part of one.
#[derive(Debug)]
pub(super) struct Piece {
    pub(super) end_s: f64,
    pub(super) seconds: f64,
    pub(super) steps: usize,
    row: usize,
}

/// A moment at which errors are noted.
#[derive(Debug)]
pub(super) struct Mark {
    pub(super) time_s: f64,
    pub(super) event: Event,
    /// By the plan, whatever the controller follows.
    pub(super) planned: Desired,
}

/// Why errors are noted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// The arrival with this index among the passages.
    Arrival(usize),
    /// The end of the plan.
    PlanEnd,
    /// The end of the flight.
    End,
}

impl Course {
    /// Lays out a plan that has been flown.
    ///
    /// `None` when the motion has no state at some time, which it has at all.
    pub(super) fn new(
        scenario: &Scenario,
        flight: &Flight,
        motion: &PropagatedMotion,
        settings: &Settings,
    ) -> Option<Self> {
        let plan = Plan {
            scenario,
            flight,
            motion,
        };
        let wheels = scenario.spacecraft().wheels().len();
        let marks = plan.marks(settings)?;
        let intervals = plan.intervals();
        let mut course = Self {
            samples: Vec::new(),
            pieces: Vec::new(),
            marks,
            torques: Vec::new(),
            wheels,
        };
        let end_s = flight.total_time_s + settings.settle_s;
        let cuts = course.cuts(&intervals, settings);
        course.lay(&plan, (&intervals, &cuts), end_s, settings)?;
        Some(course)
    }

    /// Torques fed forward during a piece, N m, one per wheel.
    pub(super) fn torques(&self, piece: &Piece) -> &[f64] {
        let begin = piece.row * self.wheels;
        &self.torques[begin..begin + self.wheels]
    }

    /// Times at which cycles are cut, sorted.
    fn cuts(&self, intervals: &[Interval<'_>], settings: &Settings) -> Vec<f64> {
        let mut cuts: Vec<f64> = self.marks.iter().map(|mark| mark.time_s).collect();
        if settings.feed_forward == FeedForward::TimeTagged {
            cuts.extend(intervals.iter().map(|interval| interval.end_s));
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    }

    fn lay(
        &mut self,
        plan: &Plan<'_>,
        (intervals, cuts): (&[Interval<'_>], &[f64]),
        end_s: f64,
        settings: &Settings,
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
            let first_piece = self.pieces.len();
            self.cut(ahead, cuts, (begin_s, until), settings);
            self.samples.push(Sample {
                time_s: begin_s,
                desired: if settings.step_input {
                    plan.at_rest()?
                } else {
                    plan.desired(begin_s)?
                },
                pieces: first_piece..self.pieces.len(),
            });
            begin_s = until;
        }
        Some(())
    }

    /// The pieces of one sample.
    fn cut(
        &mut self,
        ahead: &[Interval<'_>],
        cuts: &[f64],
        (begin_s, until): (f64, f64),
        settings: &Settings,
    ) {
        let cycle = settings.sample_s / settings.cycles as f64;
        let first = cuts.partition_point(|cut| *cut <= begin_s);
        let inside = cuts[first..].iter().take_while(|cut| **cut < until);
        let cycles = (1..settings.cycles).map(|index| begin_s + index as f64 * cycle);
        let mut ends: Vec<f64> = cycles.filter(|end| *end < until).collect();
        ends.extend(inside);
        ends.push(until);
        ends.sort_by(f64::total_cmp);
        let averaged = settings.feed_forward == FeedForward::Averaged || settings.step_input;
        if averaged {
            self.average(ahead, (begin_s, until), settings);
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
            self.pieces.push(Piece {
                end_s,
                seconds,
                steps: steps(seconds, settings.max_step_s),
                row: self.torques.len() / self.wheels - 1,
            });
            from = end_s;
        }
    }

    /// Adds a row with the mean torques from one time to another; none of a step input.
    fn average(
        &mut self,
        ahead: &[Interval<'_>],
        (begin_s, until): (f64, f64),
        settings: &Settings,
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
    fn copy(&mut self, ahead: &[Interval<'_>], time_s: f64) {
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

/// Torques from one time to another.
struct Interval<'a> {
    begin_s: f64,
    end_s: f64,
    control: &'a Control,
}

/// A plan with its motion.
struct Plan<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
    motion: &'a PropagatedMotion,
}

impl<'a> Plan<'a> {
    /// From the begin of one control to that of the next, as the verification flies them.
    fn intervals(&self) -> Vec<Interval<'a>> {
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
                let interval = Interval {
                    begin_s,
                    end_s,
                    control,
                };
                begin_s = end_s;
                interval
            })
            .collect()
    }

    fn marks(&self, settings: &Settings) -> Option<Vec<Mark>> {
        let total = self.flight.total_time_s;
        let mut marks = Vec::new();
        for (index, passage) in self.flight.passages.iter().enumerate() {
            let time_s = passage.time_s.clamp(0.0, total);
            marks.push(Mark {
                time_s,
                event: Event::Arrival(index),
                planned: self.desired(time_s)?,
            });
        }
        let end_s = total + settings.settle_s;
        for (time_s, event) in [(total, Event::PlanEnd), (end_s, Event::End)] {
            marks.push(Mark {
                time_s,
                event,
                planned: self.desired(time_s)?,
            });
        }
        marks.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        Some(marks)
    }

    /// The plan at a time; its end at rest after it.
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

    /// The attitude of the end, at rest.
    fn at_rest(&self) -> Option<Desired> {
        let state = self.motion.state(self.flight.total_time_s)?;
        Some(Desired {
            attitude: state.attitude,
            rate: Vector3::zeros(),
            gyroscopic: Vector3::zeros(),
        })
    }
}
