//! Good schedules quickly: iterated local search (Vansteenwegen, Souffriau, Vanden Berghe and Van
//! Oudheusden 2009).
//!
//! A schedule is filled up, one target after the other, where a target adds most worth squared per
//! second that it delays what follows. Then visits are moved to where the schedule ends earlier. A kick
//! removes a run of visits, and the schedule is filled again; it is kept if it is not worse than the one
//! before by more than a tolerance, and after many kicks without success the best one is kicked.

use super::instance::{Departure, Instance};
use crate::math::random::SplitMix;
use std::ops::Range;

/// Kicks without a better schedule after which the best one is taken up again.
const PATIENCE: usize = 40;
/// Longest run of visits that a kick removes, as a share of the schedule: one of this many.
const SHARES: usize = 3;
/// Longest run of visits that is moved, how many places it is moved by at most, and the longest run that
/// is reversed.
const LONGEST_MOVED: usize = 3;
const FARTHEST: usize = 25;
/// Share of what a target is worth for its delay by which the choice is varied.
const NOISE: f64 = 0.5;

/// A schedule with its times.
#[derive(Debug, Clone, Default)]
pub(super) struct Filled {
    pub(super) order: Vec<usize>,
    pub(super) units: u64,
    pub(super) end: f64,
    /// When every visit begins, as early as possible, s.
    begins: Vec<f64>,
    /// The departures before every visit, and that to the end.
    departures: Vec<Departure>,
    /// When it begins at the latest, so that all that follows can be done, s.
    latest: Vec<f64>,
}

impl Filled {
    /// Times of an order; `None` where it breaks a window, a rule or the horizon.
    pub(super) fn of(instance: &Instance, order: Vec<usize>) -> Option<Self> {
        let (begins, departures, end) = instance.follow(&order)?;
        let mut latest = vec![0.0; order.len()];
        let mut due = instance.horizon;
        let mut next = instance.count + 1;
        for (place, &target) in order.iter().enumerate().rev() {
            let bound = due - instance.leg(target + 1, next) - instance.service[target];
            // Not before the earliest begin, but for rounding.
            due = instance
                .begin_before(target, bound)
                .unwrap_or(begins[place])
                .max(begins[place]);
            latest[place] = due;
            next = target + 1;
        }
        Some(Self {
            units: instance.worth(&order),
            order,
            end,
            begins,
            departures,
            latest,
        })
    }

    /// When every visit begins, as early as possible, s.
    pub(super) fn begins(&self) -> &[f64] {
        &self.begins
    }

    /// Whether this is the better schedule.
    pub(super) fn beats(&self, other: &Self) -> bool {
        self.units > other.units || self.units == other.units && self.end < other.end
    }

    /// By how much a visit at a place delays what follows, s; `None` where it does not fit.
    fn delay(&self, instance: &Instance, target: usize, place: usize) -> Option<f64> {
        let from = &self.departures[place];
        let begin = instance.begin_after(target, instance.arrival(from, target + 1))?;
        let departure = instance.departure(from, target, begin);
        let Some(&next) = self.order.get(place) else {
            let end = instance.arrival_at_end(&departure);
            return (end <= instance.horizon).then_some((end - self.end).max(0.0));
        };
        let begin = instance.begin_after(next, instance.arrival(&departure, next + 1))?;
        (begin <= self.latest[place]).then(|| begin - self.begins[place])
    }
}

/// A running local search.
pub(super) struct LocalSearch<'a> {
    instance: &'a Instance,
    random: SplitMix,
    ruled: bool,
    now: Filled,
    pub(super) best: Filled,
}

impl<'a> LocalSearch<'a> {
    /// A search that begins with a schedule.
    pub(super) fn new(instance: &'a Instance, first: Filled, seed: u64) -> Self {
        let barring = (0..instance.count).any(|i| instance.barred[i] != [i].into_iter().collect());
        Self {
            instance,
            random: SplitMix::new(seed),
            ruled: barring || instance.positions.iter().any(Option::is_some),
            best: first.clone(),
            now: first,
        }
    }

    /// So many kicks, or until stopped.
    pub(super) fn run(&mut self, kicks: usize, stop: &dyn Fn() -> bool) {
        self.fill(0.0);
        self.shorten();
        self.take_best();
        let mut failed = 0;
        for _ in 0..kicks {
            if stop() {
                return;
            }
            let before = self.now.clone();
            self.kick();
            self.fill(NOISE);
            self.shorten();
            failed = if self.take_best() { 0 } else { failed + 1 };
            if failed >= PATIENCE {
                failed = 0;
                self.now = self.best.clone();
            } else if before.units > self.now.units && self.random.below(4) > 0 {
                self.now = before;
            }
        }
    }

    fn take_best(&mut self) -> bool {
        let better = self.now.beats(&self.best);
        if better {
            self.best = self.now.clone();
        }
        better
    }

    fn kick(&mut self) {
        let length = self.now.order.len();
        if length == 0 {
            return;
        }
        let most = length.div_ceil(SHARES).max(1);
        let removed = 1 + self.random.below(most);
        let first = self.random.below(length + 1 - removed);
        let mut order = self.now.order.clone();
        order.drain(first..first + removed);
        // Where a removal breaks the times (travel that is longer without a stop) there is no kick.
        if let Some(shorter) = Filled::of(self.instance, order) {
            self.now = shorter;
        }
    }

    /// Adds targets as long as any fits.
    fn fill(&mut self, noise: f64) {
        let mut missing: Vec<usize> = (0..self.instance.count)
            .filter(|target| !self.now.order.contains(target))
            .collect();
        while let Some((added, filled)) = self.best_addition(&mut missing, noise) {
            missing.retain(|target| *target != added);
            self.now = filled;
        }
    }

    /// The best target to add, and the schedule with it. Targets that fit nowhere are dropped from those
    /// that are missing, unless rules may let them fit later: what is added delays the others.
    fn best_addition(&mut self, missing: &mut Vec<usize>, noise: f64) -> Option<(usize, Filled)> {
        let mut choices: Vec<(f64, usize, usize)> = Vec::new();
        let mut fitting = Vec::with_capacity(missing.len());
        for &target in &*missing {
            let now = &self.now;
            let places = 0..=now.order.len();
            let delays =
                places.filter_map(|place| Some((now.delay(self.instance, target, place)?, place)));
            let every: Vec<(f64, usize)> = if self.ruled {
                delays.collect()
            } else {
                delays
                    .min_by(|a, b| a.0.total_cmp(&b.0))
                    .into_iter()
                    .collect()
            };
            if self.ruled || !every.is_empty() {
                fitting.push(target);
            }
            let varied = 1.0 + noise * (self.random.below(1000) as f64 / 1000.0 - 0.5);
            let units = self.instance.units[target] as f64;
            let share = self.instance.horizon * 1e-6;
            let rated = |(delay, place): (f64, usize)| {
                (varied * units * units / (delay + share), target, place)
            };
            choices.extend(every.into_iter().map(rated));
        }
        *missing = fitting;
        choices.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        choices.into_iter().find_map(|(_, target, place)| {
            let mut order = self.now.order.clone();
            order.insert(place, target);
            Some((target, Filled::of(self.instance, order)?))
        })
    }

    /// Moves runs of visits, straight or reversed, as long as the schedule ends earlier.
    fn shorten(&mut self) {
        loop {
            let before = self.now.end;
            for first in 0..self.now.order.len() {
                while let Some(shorter) = self.shorter(first) {
                    self.now = shorter;
                }
            }
            if self.now.end >= before {
                return;
            }
        }
    }

    /// The schedule after a move of a run that begins at a place, if it ends earlier.
    fn shorter(&self, first: usize) -> Option<Filled> {
        let length = self.now.order.len();
        let lasts = first + 1..=length.min(first + FARTHEST);
        lasts.into_iter().find_map(|last| {
            let run = first..last;
            let near = first.saturating_sub(FARTHEST)..=(first + FARTHEST).min(length - run.len());
            let places = near.filter(|place| *place != first && run.len() <= LONGEST_MOVED);
            let moved = places.map(|place| Move {
                run: run.clone(),
                place,
                reversed: false,
            });
            let reversed = Move {
                run: run.clone(),
                place: first,
                reversed: true,
            };
            let mut every = moved.chain((run.len() > 1).then_some(reversed));
            every.find_map(|change| self.after(&change))
        })
    }

    /// The schedule after a move, if it ends earlier.
    fn after(&self, change: &Move) -> Option<Filled> {
        let enough = self.now.end - 1e-9 * self.instance.horizon;
        if !self.ends_before(change, enough) {
            return None;
        }
        let found = Filled::of(self.instance, change.of(&self.now.order))?;
        (found.end < enough).then_some(found)
    }

    /// Whether the times of a move allow it and let the schedule end before a time, s. As soon as a visit
    /// after those that change places begins no earlier than it does now, nothing is gained.
    fn ends_before(&self, change: &Move, end: f64) -> bool {
        let (instance, now) = (self.instance, &self.now);
        let changed = change.changed();
        let mut departure = now.departures[changed.start];
        for place in changed.start..now.order.len() {
            let target = now.order[change.source(place)];
            let arrival = instance.arrival(&departure, target + 1);
            let Some(begin) = instance.begin_after(target, arrival) else {
                return false;
            };
            if place >= changed.end && begin >= now.begins[place] {
                return false;
            }
            departure = instance.departure(&departure, target, begin);
        }
        instance.arrival_at_end(&departure) < end
    }
}

/// A run of visits that is reversed where it is, or moved to a place among the others.
struct Move {
    run: Range<usize>,
    /// Where it begins afterwards.
    place: usize,
    reversed: bool,
}

impl Move {
    /// The places whose visits change.
    fn changed(&self) -> Range<usize> {
        self.run.start.min(self.place)..self.run.end.max(self.place + self.run.len())
    }

    /// The place at which the visit at a place is before the move.
    fn source(&self, place: usize) -> usize {
        let length = self.run.len();
        if self.reversed {
            return if self.run.contains(&place) {
                self.run.start + self.run.end - 1 - place
            } else {
                place
            };
        }
        if (self.place..self.place + length).contains(&place) {
            return self.run.start + place - self.place;
        }
        // The place among the others, and then before the run was taken out.
        let other = if place < self.place {
            place
        } else {
            place - length
        };
        if other < self.run.start {
            other
        } else {
            other + length
        }
    }

    fn of(&self, order: &[usize]) -> Vec<usize> {
        (0..order.len())
            .map(|place| order[self.source(place)])
            .collect()
    }
}
