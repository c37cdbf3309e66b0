//! A planning problem, valid by construction.
//!
//! [`Scenario::try_new`] reads the parts in the order of the document, each in a file of its own,
//! and continues after a fault. A part that depends on an earlier one takes it as optional, or
//! reads the description instead, so that one run lists all problems.

mod cone_conflicts;
mod cones;
mod directions;
mod labels;
mod limits;
mod options;
mod order;
mod pointing;
mod state;
mod target;
mod unit_slips;
mod windows;

use crate::model::attitude::{Attitude, AttitudeContext};
use crate::model::cone::Cone;
use crate::model::findings::Findings;
use crate::model::order_rules::OrderRules;
use crate::model::problem::{Faults, Problem};
use crate::model::roll::{FreeRoll, Pointing, RollArcs};
use crate::model::spacecraft::Spacecraft;
use crate::model::spec::{OptionsSpec, ReferenceFrame, ScenarioSpec, TimeSystem};
use crate::model::tolerances::TIME_TOLERANCE;
pub(crate) use cone_conflicts::cone_problems;
use directions::Sky;
use jiff::civil::DateTime;
use limits::Limits;
use nalgebra::Vector3;
use pointing::Surroundings;
use state::StartRoll;
use windows::Calendar;

/// The condition on a rate component at a passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RateCondition {
    /// None but the spacecraft's own limits.
    Free,
    /// Exactly this value, rad/s.
    Fixed(f64),
    /// Between these values, rad/s; either may be infinite.
    Within(f64, f64),
}

impl RateCondition {
    /// The least and the greatest rate that meet it, rad/s; infinite where open.
    pub(crate) fn range(self) -> [f64; 2] {
        match self {
            Self::Free => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Fixed(value) => [value; 2],
            Self::Within(low, high) => [low, high],
        }
    }
}

/// The fully known state at time zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Attitude, sign as given; where the roll is free, that of roll 0.
    pub attitude: Attitude,
    /// The admissible rolls, where a slew chooses among them.
    pub roll: Option<FreeRoll>,
    /// The boresight that is pointed, where no attitude is given.
    pub pointing: Option<Pointing>,
    /// Body rate in body axes, rad/s.
    pub rate: Vector3<f64>,
    /// Wheel speeds relative to the body, rad/s, one per wheel.
    pub wheel_speed: Vec<f64>,
}

impl Start {
    /// Total angular momentum of a spacecraft in this state, in the reference frame, N m s.
    pub(crate) fn momentum(&self, spacecraft: &Spacecraft) -> Vector3<f64> {
        let in_body = spacecraft.body_momentum(self.rate, &self.wheel_speed);
        self.attitude.to_reference(in_body)
    }
}

/// The conditions at the end of the tour.
#[derive(Debug, Clone, PartialEq)]
pub struct End {
    /// Attitude, sign as given; where the roll is free, that of roll 0.
    pub attitude: Attitude,
    /// The admissible rolls, unless the attitude or its roll is given.
    pub roll: Option<FreeRoll>,
    /// The boresight that is pointed, where no attitude is given.
    pub pointing: Option<Pointing>,
    /// Body rate in body axes, rad/s.
    pub rate: Vector3<f64>,
    /// Wheel speeds relative to the body, rad/s, one per wheel; `None` leaves them free.
    pub wheel_speed: Option<Vec<f64>>,
}

/// A valid target.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Unique identifier.
    pub id: String,
    /// Attitude, sign as given; where the roll is free, that of roll 0.
    pub attitude: Attitude,
    /// The admissible rolls, unless the attitude or its roll is given.
    pub roll: Option<FreeRoll>,
    /// The boresight that is pointed, where no attitude is given.
    pub pointing: Option<Pointing>,
    /// Condition of each rate component; all are `Fixed(0.0)` when settle or dwell is above zero.
    pub rate: [RateCondition; 3],
    /// Time to settle at rest after arrival, s.
    pub settle: f64,
    /// Time to stay at rest after settling, s.
    pub dwell: f64,
    /// When it may be visited, in order of time and disjoint; `None` at any time.
    pub windows: Option<Vec<Window>>,
    /// What a visit is worth; `None` where it is visited in every plan.
    pub value: Option<f64>,
}

impl Target {
    /// Settle and dwell time, s.
    #[must_use]
    pub fn service(&self) -> f64 {
        self.settle + self.dwell
    }

    /// When a visit after an arrival begins at the earliest, s; `None` where no window is left for it. A
    /// window may be missed by the tolerance of times.
    #[must_use]
    pub fn begin_after(&self, arrival: f64) -> Option<f64> {
        let Some(windows) = &self.windows else {
            return Some(arrival);
        };
        let in_time = arrival * (1.0 - TIME_TOLERANCE);
        let fits = |window: &&Window| in_time.max(window.from) + self.service() <= window.to;
        let next = windows.iter().find(fits)?;
        Some(arrival.max(next.from))
    }

    /// Whether a visit is at rest, so that the body may stay in the attitude before and after it.
    #[must_use]
    pub fn rests(&self) -> bool {
        let is_zero =
            |rate: &RateCondition| matches!(rate, RateCondition::Fixed(value) if *value == 0.0);
        self.rate.iter().all(is_zero)
    }
}

/// A span of time, s from time zero, in which a whole visit may lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Begin, s.
    pub from: f64,
    /// End, s, after the begin.
    pub to: f64,
}

/// A valid planning problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    name: Option<String>,
    epoch: Option<DateTime>,
    time_system: Option<TimeSystem>,
    reference_frame: Option<ReferenceFrame>,
    spacecraft: Spacecraft,
    start: Start,
    end: Option<End>,
    targets: Vec<Target>,
    order_rules: OrderRules,
    latest_end: Option<f64>,
    cones: Vec<Cone>,
    options: OptionsSpec,
}

impl Scenario {
    /// Validates a description and collects every problem.
    ///
    /// # Errors
    ///
    /// All problems at once, in the order of the document.
    pub fn try_new(spec: &ScenarioSpec) -> Result<Validated, Vec<Problem>> {
        Self::examine(spec).map_err(|faults| faults.problems)
    }

    /// Validates a description like [`Scenario::try_new`], and returns the warnings also when it is
    /// refused.
    ///
    /// # Errors
    ///
    /// All problems and warnings at once, both in the order of the document.
    pub fn examine(spec: &ScenarioSpec) -> Result<Validated, Faults> {
        Self::examine_from(spec, StartRoll::Known)
    }

    /// Validates the description of one slew, which may choose the roll at its start.
    ///
    /// # Errors
    ///
    /// All problems at once, in the order of the document.
    pub(crate) fn of_one_slew(spec: &ScenarioSpec) -> Result<Validated, Vec<Problem>> {
        let examined = Self::examine_from(spec, StartRoll::Chosen);
        examined.map_err(|faults| faults.problems)
    }

    fn examine_from(spec: &ScenarioSpec, start_roll: StartRoll) -> Result<Validated, Faults> {
        let mut findings = Findings::default();
        let scenario = Self::read(spec, start_roll, &mut findings);
        if let Some(scenario) = &scenario {
            cone_conflicts::warn_of_reported(scenario, &mut findings);
        }
        let (scenario, warnings) = findings.judge(scenario)?;
        Ok(Validated { scenario, warnings })
    }

    fn read(spec: &ScenarioSpec, start_roll: StartRoll, findings: &mut Findings) -> Option<Self> {
        let context = AttitudeContext {
            equivalence: spec.options.attitude_equivalence,
            boresights: &spec.spacecraft.boresights,
        };
        let epoch = labels::read_epoch(spec, findings);
        labels::check_frame(spec, findings);
        let sky = Sky::of(spec, epoch);
        let surroundings = Surroundings {
            attitudes: context,
            sky,
        };
        let limits = Limits::of(spec);
        let spacecraft = Spacecraft::read(&spec.spacecraft, "/spacecraft", findings);
        let start = state::read_start(&spec.start, surroundings, &limits, findings);
        let start = start.filter(|start| {
            spacecraft.as_ref().is_none_or(|spacecraft| {
                let momentum = spacecraft.body_momentum(start.rate, &start.wheel_speed);
                state::momentum_is_finite(&momentum, "/start", findings)
                    && start_roll.admits(start, spacecraft, findings)
            })
        });
        let end = spec.end.as_ref().map(|end| {
            let end = state::read_end(end, &spec.start, surroundings, &limits, findings)?;
            let known = spacecraft.as_ref().zip(start.as_ref());
            known
                .is_none_or(|(spacecraft, start)| {
                    state::end_conserves_momentum(spacecraft, start, &end, findings)
                })
                .then_some(end)
        });
        let latest_end = spec.latest_end_s;
        let latest_end = latest_end.map(|latest| windows::read_latest_end(latest, findings));
        let calendar = Calendar::of(spec, epoch);
        let targets = target::read_all(spec, surroundings, (&limits, calendar), findings);
        let order_rules = order::read(spec, findings);
        let cones = cones::read_all(spec, sky, findings);
        let options_valid = options::check(&spec.options, findings);
        unit_slips::check_targets(spec, findings);
        if let Some((spacecraft, start)) = spacecraft.as_ref().zip(start.as_ref()) {
            unit_slips::check_spacecraft(spacecraft, start, findings);
        }
        Some(Self {
            name: spec.name.clone(),
            epoch,
            time_system: spec.time_system,
            reference_frame: spec.reference_frame,
            spacecraft: spacecraft?,
            start: start?,
            end: match end {
                Some(end) => Some(end?),
                None => None,
            },
            targets: targets?,
            order_rules: order_rules?,
            latest_end: match latest_end {
                Some(latest) => Some(latest?),
                None => None,
            },
            cones: cones?,
            options: options_valid.then(|| spec.options.clone())?,
        })
    }

    /// Free text that names the scenario.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Epoch of time zero in the time system.
    #[must_use]
    pub fn epoch(&self) -> Option<DateTime> {
        self.epoch
    }

    /// Time system of the epoch.
    #[must_use]
    pub fn time_system(&self) -> Option<TimeSystem> {
        self.time_system
    }

    /// The reference frame.
    #[must_use]
    pub fn reference_frame(&self) -> Option<ReferenceFrame> {
        self.reference_frame
    }

    /// The spacecraft.
    #[must_use]
    pub fn spacecraft(&self) -> &Spacecraft {
        &self.spacecraft
    }

    /// State at time zero.
    #[must_use]
    pub fn start(&self) -> &Start {
        &self.start
    }

    /// Conditions at the end, if there is one beyond the last target.
    #[must_use]
    pub fn end(&self) -> Option<&End> {
        self.end.as_ref()
    }

    /// The same with the start in an attitude.
    pub(crate) fn starting_in(&self, attitude: Attitude) -> Self {
        let start = Start {
            attitude,
            roll: None,
            ..self.start.clone()
        };
        Self {
            start,
            ..self.clone()
        }
    }

    /// The rolls that limits and enforced cones leave from an attitude that a target, or an end of the
    /// tour, describes; `None` where the roll is given.
    pub(crate) fn clear_rolls(
        &self,
        free: Option<&FreeRoll>,
        attitude: &Attitude,
        is_target: bool,
    ) -> Option<RollArcs> {
        let cones = self.cones.iter();
        let enforced = cones.filter(|cone| cone.is_enforced_at(is_target));
        let forbidden: Vec<_> = enforced.map(Cone::forbidden).collect();
        free.map(|free| RollArcs::clear_of(free, &forbidden, attitude))
    }

    /// The targets in the caller's order.
    #[must_use]
    pub fn targets(&self) -> &[Target] {
        &self.targets
    }

    /// Rules for the order of the targets, by their indices; at least one order keeps them, unless
    /// targets may be left out.
    #[must_use]
    pub fn order_rules(&self) -> &OrderRules {
        &self.order_rules
    }

    /// When the schedule ends at the latest, s; `None` where it may take any time.
    #[must_use]
    pub fn latest_end(&self) -> Option<f64> {
        self.latest_end
    }

    /// Whether time of day, or what visits are worth, matters: with windows, values or a latest end.
    #[must_use]
    pub fn has_clock(&self) -> bool {
        let clocked = |target: &Target| target.windows.is_some() || target.value.is_some();
        self.latest_end.is_some() || self.targets.iter().any(clocked)
    }

    /// The cones that bound where boresights point.
    #[must_use]
    pub fn cones(&self) -> &[Cone] {
        &self.cones
    }

    /// Options of the solve.
    #[must_use]
    pub fn options(&self) -> &OptionsSpec {
        &self.options
    }

    /// Total angular momentum in the reference frame, N m s: a constant of the motion.
    #[must_use]
    pub fn momentum(&self) -> Vector3<f64> {
        self.start.momentum(&self.spacecraft)
    }
}

/// A valid scenario with its warnings.
#[derive(Debug, Clone, PartialEq)]
pub struct Validated {
    /// The scenario.
    pub scenario: Scenario,
    /// Warnings, which do not refuse it.
    pub warnings: Vec<Problem>,
}

#[cfg(test)]
pub(crate) mod reference;
#[cfg(test)]
mod tests;
