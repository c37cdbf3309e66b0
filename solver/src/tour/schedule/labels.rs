//! Labels, from one end of the schedule to the other, in order of time.

use super::instance::{Departure, Instance, ROUNDING};
use super::route_memory::RouteMemory;
use super::target_set::TargetSet;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Labels made between two looks at the stop signal.
const POLL: u64 = 4096;
/// The parent of labels of first targets.
const NONE: usize = usize::MAX;

/// What a path has to reach to be of interest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    /// Least worth.
    pub(super) units: u64,
    /// Which of the paths of interest is the best.
    pub(super) aim: Aim,
}

/// Which path is the best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Aim {
    /// That of the greatest worth, then that which ends first.
    Worth,
    /// That which ends first.
    Time,
}

/// A path from the start to the end.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// The targets in order of visits, forward in time; one may occur twice.
    pub(super) order: Vec<usize>,
    /// What they are worth.
    pub(super) units: u64,
    /// When it ends, s.
    pub(super) end: f64,
}

/// The beginning of a path.
#[derive(Debug, Clone)]
struct Label {
    target: usize,
    parent: usize,
    /// Number of visits.
    visits: usize,
    /// When the last visit begins, s.
    begin: f64,
    /// The departure from it.
    departure: Departure,
    /// By how much a coupling may delay the next visit, s.
    delay: f64,
    units: u64,
    /// Targets visited, as far as kept in mind.
    visited: TargetSet,
    /// Targets that cannot follow, as far as kept in mind.
    barred: TargetSet,
    dominated: bool,
}

impl Label {
    /// Whether all that may follow another label of the same target may follow this one no later.
    fn is_no_later_than(&self, other: &Self) -> bool {
        let (mine, others) = (&self.departure, &other.departure);
        self.begin + self.delay <= other.begin
            || mine.before == others.before
                && self.begin <= other.begin
                && self.begin - mine.waited <= other.begin - others.waited
    }
}

/// Where all paths begin.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Root {
    /// The place: 0 is the start, targets count from 1.
    pub(super) place: usize,
    /// Visits so far, and what they are worth.
    pub(super) visits: usize,
    pub(super) units: u64,
    /// When the place is left, s.
    pub(super) departure: f64,
    /// Targets visited, and targets that cannot follow.
    pub(super) visited: TargetSet,
    pub(super) barred: TargetSet,
}

/// A path so far, at the departure from its last place.
struct Beginning {
    /// Index of its label.
    parent: usize,
    visits: usize,
    units: u64,
    departure: Departure,
    visited: TargetSet,
    barred: TargetSet,
}

/// The labels of a run, as bounds for runs in the other direction.
pub(super) struct Completions {
    horizon: f64,
    /// Of each target: when its visit begins at the latest, forward in time of the other direction; the
    /// worth of what follows; and what is barred. In descending order of worth.
    at: Vec<Vec<(f64, u64, TargetSet)>>,
}

/// What a run found.
pub(super) struct LabelRun {
    /// The best path, if any reaches the goal.
    pub(super) best: Option<Path>,
    /// Whether all labels were made.
    pub(super) complete: bool,
    /// Number of labels made.
    pub(super) labels: u64,
    /// Bounds for the other direction; of no use where not all labels were made.
    pub(super) completions: Completions,
}

/// Makes the labels of an instance, until they are all made, or the number of labels is reached or a
/// stop is asked for. `offer` is told of every path that is better than the ones before.
pub(super) fn run(
    (instance, root): (&Instance, Root),
    memory: &RouteMemory,
    bounds: Option<&Completions>,
    goal: Goal,
    (most, stop): (u64, &dyn Fn() -> bool),
    offer: &mut dyn FnMut(&Path),
) -> LabelRun {
    let mut labels = Labels {
        instance,
        root,
        memory,
        bounds,
        goal,
        all: Vec::new(),
        kept: vec![Vec::new(); instance.count],
        queue: BinaryHeap::new(),
        best: None,
    };
    labels.begin(offer);
    let mut complete = true;
    let mut polled = 0;
    while let Some(Queued { index, .. }) = labels.queue.pop() {
        let made = labels.all.len() as u64;
        if made >= most || (made >= polled + POLL && stop()) {
            complete = false;
            break;
        }
        if made >= polled + POLL {
            polled = made;
        }
        if !labels.all[index].dominated {
            labels.extend(index, offer);
        }
    }
    LabelRun {
        complete,
        labels: labels.all.len() as u64,
        completions: labels.completions(),
        best: labels.best,
    }
}

struct Labels<'a> {
    instance: &'a Instance,
    root: Root,
    memory: &'a RouteMemory,
    bounds: Option<&'a Completions>,
    goal: Goal,
    all: Vec<Label>,
    /// Labels of each target that are not dominated, in descending order of worth.
    kept: Vec<Vec<usize>>,
    queue: BinaryHeap<Queued>,
    best: Option<Path>,
}

impl Labels<'_> {
    /// Labels of all first targets, and the path without targets.
    fn begin(&mut self, offer: &mut dyn FnMut(&Path)) {
        let root = self.root;
        let departure = Departure::first(root.place, root.departure);
        let end = self.instance.arrival_at_end(&departure);
        self.finish(NONE, (root.units, end), offer);
        let out_of_reach = self.instance.out_of_reach(root.place, root.departure);
        let from_start = Beginning {
            parent: NONE,
            visits: root.visits,
            units: root.units,
            departure,
            visited: root.visited,
            barred: root.barred.or(out_of_reach),
        };
        for target in 0..self.instance.count {
            self.visit(target, &from_start);
        }
    }

    fn extend(&mut self, index: usize, offer: &mut dyn FnMut(&Path)) {
        let label = &self.all[index];
        let beginning = Beginning {
            parent: index,
            visits: label.visits,
            units: label.units,
            departure: label.departure,
            visited: label.visited,
            barred: label.barred,
        };
        let end = self.instance.arrival_at_end(&beginning.departure);
        self.finish(index, (beginning.units, end), offer);
        for target in 0..self.instance.count {
            self.visit(target, &beginning);
        }
    }

    /// Goes on to a target, if it can follow.
    fn visit(&mut self, target: usize, from: &Beginning) {
        let instance = self.instance;
        let position = instance.positions[target];
        if from.barred.contains(target) || position.is_some_and(|place| place != from.visits) {
            return;
        }
        let arrival = instance.arrival(&from.departure, target + 1);
        let Some(begin) = instance.begin_after(target, arrival) else {
            return;
        };
        let departure = instance.departure(&from.departure, target, begin);
        let known = self.memory.at(target);
        let mut visited = from.visited.and(known).or(&self.root.visited);
        visited.insert(target);
        let label = Label {
            target,
            parent: from.parent,
            visits: from.visits + 1,
            begin,
            delay: instance.longest_delay(&departure),
            departure,
            units: from.units + instance.units[target],
            visited,
            barred: from
                .barred
                .and(known)
                .or(&self.root.barred)
                .or(&instance.barred[target])
                .or(instance.out_of_reach(target + 1, departure.time)),
            dominated: false,
        };
        if self.may_reach_the_goal(&label) {
            self.keep(label);
        }
    }

    fn may_reach_the_goal(&self, label: &Label) -> bool {
        let Some(bounds) = self.bounds else {
            let rest = (0..self.instance.count).filter(|other| !label.barred.contains(*other));
            let rest: u64 = rest.map(|other| self.instance.units[other]).sum();
            return label.units + rest >= self.goal.units;
        };
        bounds.allow(label, self.goal.units)
    }

    /// Keeps a label that no other dominates, and drops those that it dominates.
    fn keep(&mut self, label: Label) {
        let counted = self.instance.positions.iter().any(Option::is_some);
        let dominates = |a: &Label, b: &Label| {
            a.is_no_later_than(b)
                && a.units >= b.units
                && a.barred.is_subset(&b.barred)
                && (!counted || a.visits == b.visits)
        };
        let kept = &mut self.kept[label.target];
        let all = &mut self.all;
        let worth_less = kept.partition_point(|other| all[*other].units >= label.units);
        if kept[..worth_less]
            .iter()
            .any(|other| dominates(&all[*other], &label))
        {
            return;
        }
        let first = kept.partition_point(|other| all[*other].units > label.units);
        let mut write = first;
        for read in first..kept.len() {
            let other = kept[read];
            if dominates(&label, &all[other]) {
                all[other].dominated = true;
            } else {
                kept[write] = other;
                write += 1;
            }
        }
        kept.truncate(write);
        let index = all.len();
        kept.insert(first, index);
        self.queue.push(Queued {
            begin: label.begin,
            index,
        });
        all.push(label);
    }

    /// A path ends with a label.
    fn finish(&mut self, last: usize, (units, end): (u64, f64), offer: &mut dyn FnMut(&Path)) {
        if units < self.goal.units || end > self.instance.horizon * (1.0 + ROUNDING) {
            return;
        }
        let better = self.best.as_ref().is_none_or(|best| match self.goal.aim {
            Aim::Worth => units > best.units || units == best.units && end < best.end,
            Aim::Time => end < best.end,
        });
        if !better {
            return;
        }
        let mut order = Vec::new();
        let mut at = last;
        while let Some(label) = self.all.get(at) {
            order.push(label.target);
            at = label.parent;
        }
        order.reverse();
        let path = Path { order, units, end };
        offer(&path);
        self.best = Some(path);
    }

    fn completions(&self) -> Completions {
        let of_target = |(target, kept): (usize, &Vec<usize>)| {
            let entries = kept.iter().map(|index| {
                let label = &self.all[*index];
                let latest = self.instance.horizon - label.begin - self.instance.service[target];
                let mut barred = label.barred;
                barred.remove(target);
                (latest, label.units - self.instance.units[target], barred)
            });
            entries.collect()
        };
        Completions {
            horizon: self.instance.horizon,
            at: self.kept.iter().enumerate().map(of_target).collect(),
        }
    }
}

impl Completions {
    /// Whether a label of the other direction can be completed to so much worth.
    fn allow(&self, label: &Label, units: u64) -> bool {
        let begin = label.begin - 2.0 * ROUNDING * self.horizon;
        let mut visited = label.visited;
        visited.remove(label.target);
        let enough = self.at[label.target]
            .iter()
            .take_while(|(_, worth, _)| label.units + worth >= units);
        for (latest, _, barred) in enough {
            if begin <= *latest && visited.is_disjoint(barred) {
                return true;
            }
        }
        false
    }
}

/// A label in the queue: that which begins first is the next, of several the one made first.
struct Queued {
    begin: f64,
    index: usize,
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_time = other.begin.total_cmp(&self.begin);
        by_time.then_with(|| other.index.cmp(&self.index))
    }
}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Queued {}
