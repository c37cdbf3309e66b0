//! Random scenarios with windows and values, and their best schedules by enumeration.

use crate::experiment_a_spec;
use crate::random::Generator;
use crate::solving::{on_threads, outcome_of, scenario_of};
use slewplan_solver::model::plan::{Outcome, Plan};
use slewplan_solver::model::scenario::{Scenario, Target};
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec, WindowSpec};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{Shard, leg_table};
use std::collections::HashMap;

/// Which rates targets may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rates {
    /// Rest at all targets.
    Rest,
    /// Conditions of every kind.
    Any,
}

/// A random scenario: some targets with windows, tight or wide, or with two of them, some with values,
/// some with rules for the order.
#[must_use]
pub fn random_windows(seed: u64, targets: usize, rates: Rates) -> ScenarioSpec {
    let mut spec = experiment_a_spec();
    let mut generator = Generator::new(seed);
    spec.name = Some(format!("windows-{seed}"));
    if generator.coin() {
        spec.end = None;
    }
    let tight = generator.coin();
    let span = 25.0 * targets as f64;
    spec.targets = (0..targets)
        .map(|number| target(number, rates, (tight, span), &mut generator))
        .collect();
    if generator.below(3) == 0 {
        let first = spec.targets[0].id.clone();
        spec.targets[1].after = vec![first];
    }
    if generator.below(4) == 0 {
        spec.targets[targets - 1].position = Some(1 + generator.below(2));
    }
    if generator.coin() {
        spec.latest_end_s = Some(generator.between(0.6, 1.2) * span);
    }
    spec
}

fn target(
    number: usize,
    rates: Rates,
    (tight, span): (bool, f64),
    generator: &mut Generator,
) -> TargetSpec {
    let rate_kind = match rates {
        Rates::Rest => 0,
        Rates::Any => generator.below(4),
    };
    let mut target = generator.target(format!("t{number}"), rate_kind);
    let angles = [(); 3].map(|()| generator.between(-35.0, 35.0));
    target.attitude = AttitudeSpec::RollPitchYawDeg(angles);
    if rate_kind == 0 && generator.coin() {
        target.dwell_s = generator.between(0.0, 6.0);
    }
    let windows = (0..generator.below(3)).map(|i| {
        let from = generator.between(0.0, 0.4) * span + 0.5 * span * i as f64;
        let length = if tight {
            generator.between(10.0, 20.0)
        } else {
            0.45 * span
        };
        WindowSpec {
            from_s: Some(from),
            to_s: Some((from + length).min(0.5 * span * (i + 1) as f64)),
            ..WindowSpec::default()
        }
    });
    let windows: Vec<_> = windows
        .filter(|window| window.from_s < window.to_s)
        .collect();
    target.windows = (!windows.is_empty()).then_some(windows);
    target.value = (generator.below(3) > 0).then(|| 1.0 + generator.below(5) as f64);
    target
}

/// Value and total time, s, of a schedule.
pub type Best = (f64, f64);

/// Value and total time of a plan.
///
/// # Panics
///
/// When the plan says nothing of values or is not verified.
#[must_use]
pub fn standing(plan: &Plan) -> Best {
    assert!(plan.verification.passed);
    let schedule = plan.schedule.as_ref().expect("a schedule");
    (schedule.value, plan.total_time_s)
}

/// The best schedule over all ordered subsets: those that single legs admit are flown, the best first,
/// until no other can be better. `None` where there is no schedule.
///
/// # Panics
///
/// When the description is not valid or a leg has no solution.
#[must_use]
pub fn best_by_enumeration(spec: &ScenarioSpec, rates: Rates) -> Option<Best> {
    let scenario = scenario_of(spec);
    let candidates = Enumeration::of(&scenario).candidates();
    if rates == Rates::Rest {
        return candidates.first().map(|best| best.standing);
    }
    let mut best: Option<Best> = None;
    for candidate in candidates {
        let (value, bound_s) = candidate.standing;
        if best.is_some_and(|(most, time_s)| value < most || bound_s > time_s) {
            break;
        }
        if let Some(time_s) = flown(spec, &candidate.order)
            && best.is_none_or(|(_, known_s)| time_s < known_s)
        {
            best = Some((value, time_s));
        }
    }
    best
}

/// Total time, s, of the schedule of some targets in an order; `None` where there is none.
fn flown(spec: &ScenarioSpec, order: &[usize]) -> Option<f64> {
    let mut alone = spec.clone();
    let ordered = order.iter().enumerate().map(|(place, index)| TargetSpec {
        position: Some(place + 1),
        after: Vec::new(),
        value: None,
        ..spec.targets[*index].clone()
    });
    alone.targets = ordered.collect();
    match outcome_of(&alone) {
        Outcome::Planned(plan) => Some(plan.total_time_s),
        _ => None,
    }
}

struct Candidate {
    order: Vec<usize>,
    standing: Best,
}

struct Enumeration<'a> {
    scenario: &'a Scenario,
    legs: HashMap<(String, String), f64>,
}

impl<'a> Enumeration<'a> {
    fn of(scenario: &'a Scenario) -> Self {
        let whole = Shard { index: 0, of: 1 };
        let (rows, _) = on_threads(2, |run| {
            leg_table(scenario, LegKind::LowerBound, whole, run)
        });
        let legs = rows.into_iter().map(|row| {
            let duration = row.duration_s.expect("a solved leg");
            ((row.from, row.to), duration)
        });
        Self {
            legs: legs.collect(),
            scenario,
        }
    }

    /// All schedules that the times of single legs admit, the best first.
    fn candidates(&self) -> Vec<Candidate> {
        let mut found = Vec::new();
        self.extend(&mut Vec::new(), ("start", 0.0), &mut found);
        found.sort_by(|a, b| {
            let ((more, early), (less, late)) = (a.standing, b.standing);
            less.total_cmp(&more).then(early.total_cmp(&late))
        });
        found
    }

    fn extend(&self, order: &mut Vec<usize>, (at, time): (&str, f64), found: &mut Vec<Candidate>) {
        let targets = self.scenario.targets();
        let complete = (0..targets.len()).all(|i| order.contains(&i) || targets[i].value.is_some());
        let to_end = self
            .scenario
            .end()
            .map(|_| self.legs.get(&(at.into(), "end".into())));
        // A tour without targets has no row in the table.
        let end = time + to_end.flatten().copied().unwrap_or(0.0);
        let in_time = self
            .scenario
            .latest_end()
            .is_none_or(|latest| end <= latest);
        if complete && in_time {
            let mut visited = order.clone();
            visited.sort_unstable();
            let values = visited.iter().filter_map(|i| targets[*i].value);
            let value = values.fold(0.0, |sum, value| sum + value);
            found.push(Candidate {
                order: order.clone(),
                standing: (value, end),
            });
        }
        for (index, target) in targets.iter().enumerate() {
            if !self.admits(order, index) {
                continue;
            }
            let arrival = time + self.legs[&(at.into(), target.id.clone())];
            if let Some(begin) = begin_after(target, arrival) {
                order.push(index);
                self.extend(order, (&target.id, begin + target.service()), found);
                order.pop();
            }
        }
    }

    /// Whether a target may come after some others.
    fn admits(&self, order: &[usize], index: usize) -> bool {
        let rules = self.scenario.order_rules();
        let placed = rules
            .position(index)
            .is_none_or(|place| place == order.len());
        let before = |other: &usize| rules.predecessors(*other).contains(&index);
        placed && !order.contains(&index) && !order.iter().any(before)
    }
}

/// When a visit may begin that is reached at a time.
fn begin_after(target: &Target, arrival: f64) -> Option<f64> {
    let Some(windows) = &target.windows else {
        return Some(arrival);
    };
    let begins = windows
        .iter()
        .map(|w| (arrival.max(w.from), w.to - target.service()));
    begins
        .filter(|(begin, last)| begin <= last)
        .map(|(begin, _)| begin)
        .next()
}
