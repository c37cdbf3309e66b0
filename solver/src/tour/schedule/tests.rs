//! The search against enumeration over all subsets and orders, on random tables.

use super::*;
use crate::math::random::SplitMix;
use std::collections::HashMap;

struct Case {
    problem: TimedProblem,
    travel: Vec<Vec<f64>>,
    /// Coupling gaps of triples of places, by their numbers; none in two cases of three.
    gaps: HashMap<[usize; 3], f64>,
}

impl TravelTimes for Case {
    fn travel_s(&self, from: Place, to: Place) -> f64 {
        self.travel[self.number(from)][self.number(to)]
    }

    fn coupling_gaps_s(&self) -> Vec<([Place; 3], f64)> {
        let place = |number: usize| match number {
            0 => Place::Start,
            number if number == self.travel.len() - 1 => Place::End,
            number => Place::Target(number - 1),
        };
        let gaps = self.gaps.iter();
        gaps.map(|(triple, gap)| (triple.map(place), *gap))
            .collect()
    }
}

impl Case {
    fn random(seed: u64) -> Self {
        let mut random = SplitMix::new(seed);
        let count = 1 + random.below(5);
        let mut whole = |least: usize, most: usize| least + random.below(most - least + 1);
        let travel = (0..count + 2)
            .map(|_| (0..count + 2).map(|_| whole(1, 9) as f64).collect())
            .collect();
        let longest = if whole(0, 1) > 0 { 4 } else { 12 };
        let required_share = whole(0, 2);
        let targets = (0..count).map(|_| {
            let windows = (0..whole(0, 2)).map(|i| {
                let from = 30.0 * i as f64 + whole(0, 16) as f64 - 4.0;
                [from, from + whole(2, longest) as f64]
            });
            let windows: Vec<[f64; 2]> = windows.collect();
            TimedTarget {
                service_s: whole(0, 2) as f64,
                windows: (!windows.is_empty()).then_some(windows),
                value: (whole(0, 2) >= required_share).then(|| whole(1, 5) as f64 / 10.0),
            }
        });
        let targets: Vec<_> = targets.collect();
        let mut after = vec![Vec::new(); count];
        let mut positions = vec![None; count];
        if count > 1 && whole(0, 1) > 0 {
            after[1].push(0);
            if count > 3 {
                after[3] = vec![1, 2];
            }
        }
        if whole(0, 2) > 1 {
            positions[count - 1] = Some(whole(0, count - 1));
        }
        let latest = whole(0, 40);
        let mut gaps = HashMap::new();
        if whole(0, 2) == 0 {
            for _ in 0..count * count {
                let [from, via, to] = [whole(0, count), whole(1, count), whole(1, count + 1)];
                if from != via && via != to && to != from {
                    gaps.insert([from, via, to], whole(1, 5) as f64);
                }
            }
        }
        Self {
            problem: TimedProblem {
                targets,
                rules: OrderRules::new(positions, after),
                has_end: whole(0, 1) > 0,
                latest_end_s: (latest > 8).then_some(latest as f64),
            },
            travel,
            gaps,
        }
    }

    fn number(&self, place: Place) -> usize {
        place.number(self.travel.len())
    }

    /// The earliest arrival after the departures from all places so far.
    fn arrival(&self, left: &[(Place, f64)], service: f64, to: Place) -> f64 {
        let (at, time) = left[left.len() - 1];
        let arrival = time + self.travel_s(at, to);
        let Some(&[(before, departure), _]) = left.last_chunk() else {
            return arrival;
        };
        let gap = self.gaps.get(&[before, at, to].map(|p| self.number(p)));
        let alone = self.travel_s(before, at) + service + self.travel_s(at, to);
        arrival.max(departure + alone + gap.unwrap_or(&0.0))
    }

    /// When an order ends, if it is admitted: by the rules, the windows and the latest end.
    fn end(&self, order: &[usize]) -> Option<f64> {
        let problem = &self.problem;
        let mut left = vec![(Place::Start, 0.0)];
        let mut served = 0.0;
        for (place, &target) in order.iter().enumerate() {
            let misplaced = problem.rules.position(target).is_some_and(|p| p != place);
            let later = |before: &usize| order[place..].contains(before);
            if misplaced || problem.rules.predecessors(target).iter().any(later) {
                return None;
            }
            let arrival = self.arrival(&left, served, Place::Target(target));
            let TimedTarget {
                service_s, windows, ..
            } = &problem.targets[target];
            let begin = match windows {
                None => Some(arrival),
                Some(windows) => {
                    let begins = windows.iter().map(|[from, to]| (arrival.max(*from), *to));
                    let mut fitting = begins.filter(|(begin, to)| begin + service_s <= *to);
                    fitting.next().map(|(begin, _)| begin)
                }
            };
            left.push((Place::Target(target), begin? + service_s));
            served = *service_s;
        }
        let time = if problem.has_end {
            self.arrival(&left, served, Place::End)
        } else {
            left[left.len() - 1].1
        };
        problem
            .latest_end_s
            .is_none_or(|latest| time <= latest)
            .then_some(time)
    }

    /// Value in tenths and end of the best schedule, over all ordered subsets.
    fn best(&self) -> Option<(f64, f64)> {
        let mut best = None;
        let mut order = Vec::new();
        self.enumerate(&mut order, &mut best);
        best
    }

    fn enumerate(&self, order: &mut Vec<usize>, best: &mut Option<(f64, f64)>) {
        let targets = &self.problem.targets;
        let missing = |i: &usize| targets[*i].value.is_none() && !order.contains(i);
        let end = self.end(order);
        if self.gaps.is_empty() {
            let schedule = self.problem.schedule_of(order, self);
            assert_eq!(schedule.map(|schedule| schedule.end_s), end, "{order:?}");
        }
        if !(0..targets.len()).any(|i| missing(&i))
            && let Some(end) = end
        {
            let value = self.tenths(order);
            let better = |(most, first): &(f64, f64)| {
                value.total_cmp(most).then(first.total_cmp(&end)).is_gt()
            };
            if best.as_ref().is_none_or(better) {
                *best = Some((value, end));
            }
        }
        for target in 0..targets.len() {
            if !order.contains(&target) {
                order.push(target);
                self.enumerate(order, best);
                order.pop();
            }
        }
    }

    /// The sum of values in whole tenths.
    fn tenths(&self, order: &[usize]) -> f64 {
        let values = order.iter().filter_map(|i| self.problem.targets[*i].value);
        values.map(|value| (10.0 * value).round()).sum()
    }
}

fn never() -> bool {
    false
}

#[test]
fn searches_find_what_enumeration_finds() {
    let (mut infeasible, mut partial) = (0, 0);
    for seed in 0..3000 {
        let case = Case::random(seed);
        let found = search(
            &case.problem,
            &case,
            SearchLimits::default(),
            &never,
            &mut |_| (),
        );
        assert!(found.complete, "{seed}");
        let best = found
            .best
            .as_ref()
            .map(|best| (case.tenths(&best.order), best.end_s));
        assert_eq!(
            best,
            case.best(),
            "{seed}: {:?} {:?} {:?}",
            case.problem,
            case.travel,
            case.gaps
        );
        if let Some(best) = found.best {
            assert_eq!(case.end(&best.order), Some(best.end_s), "{seed}");
            assert!((found.value_bound - best.value).abs() < 1e-9, "{seed}");
            assert!((found.end_bound_s - best.end_s).abs() < 1e-9, "{seed}");
            partial += usize::from(best.order.len() < case.problem.targets.len());
        } else {
            infeasible += 1;
        }
    }
    assert!(infeasible > 100 && partial > 100, "{infeasible} {partial}");
}

#[test]
fn bounds_hold_at_every_moment_and_wider_windows_lose_no_value() {
    for seed in 0..300 {
        let case = Case::random(seed);
        let mut reports = Vec::new();
        let limits = SearchLimits::default();
        let found = search(&case.problem, &case, limits, &never, &mut |report| {
            reports.push(report.clone());
        });
        let Some(best) = found.best else { continue };
        for report in reports {
            assert!(report.value_bound > best.value - 1e-9, "{seed}");
            let end_bound = report.best.filter(|known| known.value >= best.value);
            assert!(
                end_bound.is_none() || report.end_bound_s <= best.end_s,
                "{seed}"
            );
        }
        let mut wider = case.problem.clone();
        for target in &mut wider.targets {
            target.windows = None;
        }
        let wider = search(&wider, &case, limits, &never, &mut |_| ());
        assert!(
            wider
                .best
                .is_some_and(|wider| wider.value > best.value - 1e-9),
            "{seed}"
        );
    }
}

#[test]
fn a_limited_search_answers_with_bounds() {
    let count = 60;
    let mut random = SplitMix::new(3);
    let places: Vec<[f64; 2]> = (0..=count)
        .map(|_| [0, 1].map(|_| random.below(100) as f64))
        .collect();
    let at = |place| match place {
        Place::Target(target) => places[target],
        Place::Start | Place::End => places[count],
    };
    let times = |from, to| {
        let ([a, b], [c, d]) = (at(from), at(to));
        (a - c).hypot(b - d)
    };
    let value = |i: usize| Some(1.0 + (i % 7) as f64);
    let problem = TimedProblem {
        targets: (0..count)
            .map(|i| TimedTarget {
                service_s: 1.0,
                windows: None,
                value: value(i),
            })
            .collect(),
        rules: OrderRules::none(count),
        has_end: true,
        latest_end_s: Some(200.0),
    };
    let limits = SearchLimits {
        labels: Some(20_000),
        ..SearchLimits::default()
    };
    let found = search(&problem, &times, limits, &never, &mut |_| ());
    let again = search(&problem, &times, limits, &never, &mut |_| ());
    assert_eq!(found, again);
    let best = found.best.unwrap();
    assert!(!found.complete && best.value < found.value_bound);
    assert!(
        best.value > 0.4 * found.value_bound,
        "{} {}",
        best.value,
        found.value_bound
    );
}
