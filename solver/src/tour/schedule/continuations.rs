//! Bounds on schedules with a given beginning, for searches in which legs take longer than their times.

use super::instance::{Instance, ROUNDING};
use super::labels::{Aim, Completions, Goal, Root, run};
use super::route_memory::RouteMemory;
use super::target_set::TargetSet;
use super::worth::Worth;
use super::{TimedProblem, TravelTimes};
use std::cmp::Ordering;
use std::sync::OnceLock;

/// Greatest number of targets whose labels keep every target in mind.
const MAX_EXACT: usize = 20;
/// Labels of the bounds on all ends, and of a bound on one beginning.
const LABELS_OF_ENDS: u64 = 1_000_000;
const LABELS_OF_ONE: u64 = 20_000;

/// How good a schedule is: more worth is better, and with the same worth an earlier end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rank {
    /// Worth of the visited targets in whole units.
    pub units: u64,
    /// When it ends, s.
    pub end_s: f64,
}

impl Rank {
    /// Better than every schedule.
    pub const BEST: Self = Self {
        units: u64::MAX,
        end_s: 0.0,
    };

    /// Order from the worst to the best.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        let by_units = self.units.cmp(&other.units);
        by_units.then_with(|| other.end_s.total_cmp(&self.end_s))
    }
}

/// The first visits of a schedule.
#[derive(Debug, Clone, Copy)]
pub struct Beginning<'a> {
    /// The targets, in that order.
    pub order: &'a [usize],
    /// When the last of them is left, s.
    pub departure_s: f64,
}

/// The best that may follow a beginning.
#[derive(Debug, Clone, PartialEq)]
pub struct Continuation {
    /// No schedule with the beginning is better.
    pub bound: Rank,
    /// The targets that follow, if the bound is that of a path that visits no target twice.
    pub order: Option<Vec<usize>>,
}

/// Bounds on schedules by their beginnings.
pub struct Continuations {
    instance: Instance,
    memory: RouteMemory,
    worth: Worth,
    least_units: u64,
    /// Bounds on all ends, made when they are first needed; `None` where that took too long.
    ends: OnceLock<Option<Completions>>,
}

impl Continuations {
    /// Bounds on all schedules of a problem.
    #[must_use]
    pub fn new(problem: &TimedProblem, times: &impl TravelTimes) -> Self {
        let worth = Worth::of(&problem.targets);
        let instance = Instance::new(problem, times, &worth);
        let memory = if instance.count <= MAX_EXACT {
            RouteMemory::whole(instance.count)
        } else {
            RouteMemory::nearest(&instance)
        };
        Self {
            instance,
            memory,
            worth,
            least_units: 0,
            ends: OnceLock::new(),
        }
    }

    /// The same for schedules of at least so much worth that end before a time, s.
    #[must_use]
    pub fn narrowed(&self, least_units: u64, before_s: f64) -> Self {
        Self {
            instance: self.instance.until(before_s.min(self.instance.horizon)),
            memory: self.memory.clone(),
            worth: self.worth.clone(),
            least_units,
            ends: OnceLock::new(),
        }
    }

    fn bounds_on_ends(&self) -> Option<Completions> {
        let mirrored = self.instance.mirrored();
        let limits: (u64, &dyn Fn() -> bool) = (LABELS_OF_ENDS, &|| false);
        let all = (&mirrored, Root::default());
        let found = run(all, &self.memory, None, self.goal(), limits, &mut |_| ());
        found.complete.then_some(found.completions)
    }

    fn goal(&self) -> Goal {
        Goal {
            units: self.least_units,
            aim: Aim::Worth,
        }
    }

    /// Worth of targets in whole units.
    #[must_use]
    pub fn units_of_all(&self, targets: &[usize]) -> u64 {
        self.instance.worth(targets)
    }

    /// Whether so much worth includes that of all required targets.
    #[must_use]
    pub fn is_whole(&self, units: u64) -> bool {
        self.worth.is_whole(units)
    }

    /// Upper bound on the sum of values of schedules of so much worth.
    #[must_use]
    pub fn value_of(&self, units: u64) -> f64 {
        self.worth.value_of(units)
    }

    /// The targets that may follow a beginning at all.
    pub fn followers(&self, beginning: Beginning<'_>) -> impl Iterator<Item = usize> {
        let root = self.root(beginning);
        let out_of_reach = *self.instance.out_of_reach(root.place, root.departure);
        let position = |target: &usize| self.instance.positions[*target];
        (0..self.instance.count).filter(move |target| {
            let placed = position(target).is_none_or(|place| place == root.visits);
            placed && !root.barred.contains(*target) && !out_of_reach.contains(*target)
        })
    }

    /// The best that may follow; `None` where nothing of interest does. Where that takes too long to
    /// find out, the bound is `otherwise`.
    #[must_use]
    pub fn of(&self, beginning: Beginning<'_>, otherwise: Rank) -> Option<Continuation> {
        let root = self.root(beginning);
        let limits: (u64, &dyn Fn() -> bool) = (LABELS_OF_ONE, &|| false);
        let from = (&self.instance, root);
        let ends = self.ends.get_or_init(|| self.bounds_on_ends()).as_ref();
        let found = run(from, &self.memory, ends, self.goal(), limits, &mut |_| ());
        if !found.complete {
            return Some(Continuation {
                bound: otherwise,
                order: None,
            });
        }
        let path = found.best?;
        let mut barred = root.barred;
        let is_schedule = path.order.iter().all(|target| {
            let free = !barred.contains(*target);
            barred = barred.or(&self.instance.barred[*target]);
            free
        });
        Some(Continuation {
            bound: Rank {
                units: path.units,
                end_s: path.end * (1.0 - ROUNDING),
            },
            order: is_schedule.then_some(path.order),
        })
    }

    fn root(&self, beginning: Beginning<'_>) -> Root {
        let order = beginning.order;
        let visited: TargetSet = order.iter().copied().collect();
        let barred = order.iter().fold(visited, |barred, target| {
            barred.or(&self.instance.barred[*target])
        });
        Root {
            place: order.last().map_or(0, |last| last + 1),
            visits: order.len(),
            units: self.instance.worth(order),
            departure: beginning.departure_s,
            visited,
            barred,
        }
    }
}
