//! A problem in numbers, as labels need it: forward in time, or backward from the end.

use super::coupling_gaps::CouplingGaps;
use super::target_set::TargetSet;
use super::worth::Worth;
use super::{TimedProblem, TravelTimes};
use crate::tour::order::Place;
use std::sync::Arc;

/// Share of the horizon by which sums of times may differ by rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// The numbers of a problem, in one direction of time.
#[derive(Debug, Clone)]
pub(super) struct Instance {
    /// Number of targets.
    pub(super) count: usize,
    /// No schedule that is of interest ends after it, s.
    pub(super) horizon: f64,
    /// Times of the legs, s: row by row from the start, the targets and the end.
    travel: Vec<f64>,
    gaps: Arc<CouplingGaps>,
    /// Durations of visits, s.
    pub(super) service: Vec<f64>,
    /// Spans of time, s, in which a visit of each target may begin, in order of time.
    begins: Vec<Vec<[f64; 2]>>,
    /// What visits are worth.
    pub(super) units: Vec<u64>,
    /// The targets that cannot follow each: itself, and those that have to come before.
    pub(super) barred: Vec<TargetSet>,
    /// The same in the other direction.
    barred_before: Vec<TargetSet>,
    /// Zero-based places of targets in the order, where they are fixed.
    pub(super) positions: Vec<Option<usize>>,
    /// For the start and every target: the latest departures, s, in ascending order, with which other
    /// targets can still be reached, and the targets that cannot after each of them.
    too_late: Vec<(Vec<f64>, Vec<TargetSet>)>,
}

/// The departure from a place, and what of the leg before it bears on the next one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Departure {
    /// The place before it.
    pub(super) before: usize,
    pub(super) place: usize,
    pub(super) time: f64,
    /// By how much later than the leg on its own allows the visit began, s.
    pub(super) waited: f64,
}

impl Departure {
    /// A departure that does not depend on what was before.
    pub(super) fn first(place: usize, time: f64) -> Self {
        Self {
            before: place,
            place,
            time,
            waited: f64::INFINITY,
        }
    }
}

impl Instance {
    /// The numbers of a problem.
    pub(super) fn new(
        problem: &TimedProblem,
        times: &(impl TravelTimes + ?Sized),
        worth: &Worth,
    ) -> Self {
        let count = problem.targets.len();
        let place = |at: usize| match at {
            0 => Place::Start,
            at if at <= count => Place::Target(at - 1),
            _ => Place::End,
        };
        let mut travel = vec![0.0; (count + 2) * (count + 2)];
        for from in 0..=count {
            for to in (1..count + 2).filter(|to| *to != from) {
                if to <= count || problem.has_end {
                    travel[from * (count + 2) + to] = times.travel_s(place(from), place(to));
                }
            }
        }
        let gaps = times.coupling_gaps_s().into_iter();
        let gaps = gaps.filter(|(triple, _)| problem.has_end || triple[2] != Place::End);
        let gaps: Vec<_> = gaps
            .map(|(triple, gap)| (triple.map(|place| place.number(count + 2)), gap))
            .collect();
        let service: Vec<f64> = problem.targets.iter().map(|t| t.service_s).collect();
        let windows = problem.targets.iter().zip(&service);
        let begins = windows.map(|(target, service)| {
            let any_time = vec![[0.0, f64::INFINITY]];
            let windows = target.windows.clone().unwrap_or(any_time);
            let begins = windows.iter().map(|[from, to]| [*from, to - service]);
            begins.collect()
        });
        let predecessors = |target: usize| problem.rules.predecessors(target).iter().copied();
        let mut barred_before: Vec<TargetSet> =
            (0..count).map(|i| [i].into_iter().collect()).collect();
        for target in 0..count {
            for before in predecessors(target) {
                barred_before[before].insert(target);
            }
        }
        let mut instance = Self {
            count,
            horizon: f64::INFINITY,
            travel,
            gaps: Arc::new(CouplingGaps::new(count + 2, &gaps)),
            begins: begins.collect(),
            service,
            units: worth.units.clone(),
            barred: (0..count)
                .map(|i| predecessors(i).chain([i]).collect())
                .collect(),
            barred_before,
            positions: (0..count).map(|i| problem.rules.position(i)).collect(),
            too_late: Vec::new(),
        };
        let latest = problem.latest_end_s.unwrap_or(f64::INFINITY);
        instance.limit(latest.min(instance.longest()));
        instance
    }

    /// A time by which every schedule that does not wait in vain has ended, s.
    fn longest(&self) -> f64 {
        let opens = self.begins.iter().flatten().map(|span| span[0]);
        let last_opening = opens.fold(0.0, f64::max);
        // From then on nothing waits: each target takes a leg to it, its service and its coupling.
        let legs = (1..self.count + 2).map(|to| {
            let legs = (0..=self.count).map(|from| self.leg(from, to));
            legs.filter(|leg| leg.is_finite()).fold(0.0, f64::max)
        });
        let delays = (1..=self.count).map(|via| {
            let gaps = (0..=self.count).map(|from| self.gaps.largest(from, via));
            gaps.fold(0.0, f64::max)
        });
        let services = self.service.iter().sum::<f64>();
        last_opening + legs.sum::<f64>() + services + delays.sum::<f64>()
    }

    /// The same up to an earlier horizon.
    pub(super) fn until(&self, horizon: f64) -> Self {
        let mut limited = self.clone();
        limited.limit(horizon);
        limited
    }

    fn limit(&mut self, horizon: f64) {
        self.horizon = horizon;
        let shortest = self.shortest_ways();
        let places = self.count + 2;
        for target in 0..self.count {
            let at = target + 1;
            let first = shortest[at];
            let last = horizon - self.service[target] - shortest[at * places + self.count + 1];
            let slack = ROUNDING * horizon;
            let spans = self.begins[target].iter();
            let clipped = spans.map(|[from, to]| [from.max(first - slack), to.min(last + slack)]);
            self.begins[target] = clipped.filter(|[from, to]| from <= to).collect();
        }
        self.too_late = (0..=self.count)
            .map(|from| self.too_late_from(from, &shortest))
            .collect();
    }

    /// Shortest ways between all places over any others, s, without services: what is out of reach that
    /// way is out of reach.
    fn shortest_ways(&self) -> Vec<f64> {
        let places = self.count + 2;
        let mut shortest = self.travel.clone();
        for via in 1..=self.count {
            for from in 0..=self.count {
                let first = shortest[from * places + via];
                for to in 1..places {
                    let over = first + shortest[via * places + to];
                    let way = &mut shortest[from * places + to];
                    *way = way.min(over);
                }
            }
        }
        shortest
    }

    fn too_late_from(&self, from: usize, shortest: &[f64]) -> (Vec<f64>, Vec<TargetSet>) {
        let slack = ROUNDING * self.horizon;
        let latest = |target: usize| {
            let last = self.begins[target]
                .last()
                .map_or(f64::NEG_INFINITY, |span| span[1]);
            last - shortest[from * (self.count + 2) + target + 1] + slack
        };
        let mut departures: Vec<(f64, usize)> = (0..self.count).map(|i| (latest(i), i)).collect();
        departures.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut set = TargetSet::default();
        let mut sets = vec![set];
        for (_, target) in &departures {
            set.insert(*target);
            sets.push(set);
        }
        (departures.into_iter().map(|(time, _)| time).collect(), sets)
    }

    /// The same problem in reversed time: from the end at the horizon back to the start. Fixed places in
    /// the order are forgotten.
    pub(super) fn mirrored(&self) -> Self {
        let places = self.count + 2;
        let other = |place: usize| match place {
            0 => self.count + 1,
            place if place == self.count + 1 => 0,
            place => place,
        };
        let mut travel = vec![0.0; places * places];
        for from in 0..places {
            for to in 0..places {
                travel[from * places + to] = self.leg(other(to), other(from));
            }
        }
        let mirrored = |target: usize| {
            let service = self.service[target];
            let spans = self.begins[target].iter().rev();
            let turned = spans
                .map(|[from, to]| [self.horizon - to - service, self.horizon - from - service]);
            turned.collect()
        };
        let mut instance = Self {
            travel,
            gaps: Arc::new(self.gaps.mirrored(other)),
            begins: (0..self.count).map(mirrored).collect(),
            barred: self.barred_before.clone(),
            barred_before: self.barred.clone(),
            positions: vec![None; self.count],
            ..self.clone()
        };
        instance.limit(self.horizon);
        instance
    }

    /// Time of a leg between places, s: the start is 0, targets count from 1, the end comes last.
    pub(super) fn leg(&self, from: usize, to: usize) -> f64 {
        self.travel[from * (self.count + 2) + to]
    }

    /// The earliest arrival at a place after a departure, s.
    pub(super) fn arrival(&self, from: &Departure, to: usize) -> f64 {
        let gap = self.gaps.of([from.before, from.place, to]);
        from.time + self.leg(from.place, to) + (gap - from.waited).max(0.0)
    }

    /// The earliest arrival at the end after a departure, s.
    pub(super) fn arrival_at_end(&self, from: &Departure) -> f64 {
        self.arrival(from, self.count + 1)
    }

    /// The departure after a visit of a target that begins at some time, s, after another departure.
    pub(super) fn departure(&self, from: &Departure, target: usize, begin: f64) -> Departure {
        Departure {
            before: from.place,
            place: target + 1,
            time: begin + self.service[target],
            waited: begin - (from.time + self.leg(from.place, target + 1)),
        }
    }

    /// By how much the coupling of the leg before a departure delays the next arrival at most, s.
    pub(super) fn longest_delay(&self, from: &Departure) -> f64 {
        (self.gaps.largest(from.before, from.place) - from.waited).max(0.0)
    }

    /// Whether a visit can begin at some time.
    pub(super) fn is_reached(&self, target: usize) -> bool {
        !self.begins[target].is_empty()
    }

    /// When a visit begins at the earliest after an arrival, s.
    pub(super) fn begin_after(&self, target: usize, arrival: f64) -> Option<f64> {
        let spans = &self.begins[target];
        let next = spans.iter().find(|span| arrival <= span[1])?;
        Some(arrival.max(next[0]))
    }

    /// When a visit begins at the latest, not after a time, s.
    pub(super) fn begin_before(&self, target: usize, latest: f64) -> Option<f64> {
        let spans = &self.begins[target];
        let last = spans.iter().rev().find(|span| span[0] <= latest)?;
        Some(latest.min(last[1]))
    }

    /// The targets that cannot be reached any more after a departure from a place.
    pub(super) fn out_of_reach(&self, from: usize, departure: f64) -> &TargetSet {
        let (departures, sets) = &self.too_late[from];
        &sets[departures.partition_point(|latest| *latest < departure)]
    }

    /// When the visits of an order begin, s, the departures before each and to the end, and when it ends,
    /// s; `None` where it breaks a window, a rule or the horizon.
    pub(super) fn follow(&self, order: &[usize]) -> Option<(Vec<f64>, Vec<Departure>, f64)> {
        let mut departure = Departure::first(0, 0.0);
        let mut barred = TargetSet::default();
        let mut begins = Vec::with_capacity(order.len());
        let mut departures = Vec::with_capacity(order.len() + 1);
        for (place, &target) in order.iter().enumerate() {
            let misplaced = self.positions[target].is_some_and(|position| position != place);
            if misplaced || barred.contains(target) {
                return None;
            }
            barred = barred.or(&self.barred[target]);
            let begin = self.begin_after(target, self.arrival(&departure, target + 1))?;
            begins.push(begin);
            departures.push(departure);
            departure = self.departure(&departure, target, begin);
        }
        departures.push(departure);
        let end = self.arrival_at_end(&departure);
        (end <= self.horizon * (1.0 + ROUNDING)).then_some((begins, departures, end))
    }

    /// What the targets of an order are worth together.
    pub(super) fn worth(&self, order: &[usize]) -> u64 {
        order.iter().map(|target| self.units[*target]).sum()
    }
}
