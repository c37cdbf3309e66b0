//! Triples whose end states are paid for with costates.
//!
//! # Costates share out the gaps
//!
//! The triple bound halves every coupling gap, since the legs of a tour lie in two triples each. Let
//! copies of the state at a target be given to the legs before and after it, and let the multiplier
//! `p(h, i, j)` belong to the constraint that the copies at `i`, between the places `h` and `j`,
//! agree ([`super::super::lagrangian`]). With
//!
//! `w(h, i, j, k, l) = min over motions i, j, k of their time - p(h, i, j) . a + p(j, k, l) . b`,
//!
//! `a` the state in which `i` is left and `b` that in which `k` is reached, the terms of a multiplier
//! cancel in the sum over all triples of a tour, so that
//!
//! `T >= 1/2 (t_0 + sum over j of w(h, i, j, k, l) + t_n)`,
//!
//! with the terms of the first and last multiplier in the outer legs `t_0`, `t_n`. With the costates of
//! a tour as multipliers the bound of that tour is sharp: each leg of it takes as long as in the tour,
//! in both of its triples. A triple without multipliers has the gap of [`super::coupling_gaps`].
//!
//! # What is not solved
//!
//! By itself, a leg next to `i` takes longer than its pair bound by at least `before(h, i, j)` or
//! `after(h, i, j)`, when it pays for its state at `i`; a constant is added to the one and subtracted
//! from the other, so that both are near zero. A triple takes longer than its pair bounds by at least
//! the sum of these shares on its two sides.

use super::coupling_gaps::NOWHERE;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::{Evaluation, PairTable, PassageCostate, TourModel};
use foldhash::fast::FixedState;
use std::collections::HashMap;

/// Looked up often, by keys that no adversary chooses.
type ByPlaces<const N: usize, T> = HashMap<[usize; N], T, FixedState>;

/// What the legs on both sides of a target exceed their pair bounds by at least, s, when they pay for
/// their states there.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Shares {
    pub(super) before: f64,
    pub(super) after: f64,
}

/// A place beyond a neighbour of a target.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beyond {
    pub(super) place: usize,
    /// Share of the leg between target and neighbour, s.
    pub(super) share: f64,
}

/// The multiplier of a target between two places.
#[derive(Debug, Clone)]
struct Multiplier {
    passage: PassageCostate,
    shares: Shares,
}

/// Multipliers and the triples that pay them, for places numbered as in [`PairTable`].
#[derive(Debug)]
pub(super) struct LagrangianTriples {
    start: usize,
    end: usize,
    symmetric: bool,
    /// By the target with the places before and after it; `None` where the model has no costate.
    multipliers: ByPlaces<3, Option<Multiplier>>,
    /// By how much triples exceed their pair bounds, s. They are listed with the places before and
    /// after them where there is a multiplier, else with [`NOWHERE`].
    excesses: ByPlaces<5, f64>,
    /// For a target and a neighbour of it with multipliers, the places beyond the neighbour that it has
    /// them with.
    beyond: ByPlaces<2, Vec<Beyond>>,
    /// The neighbours with multipliers of every target, and the least share, s, or 0, of its legs
    /// there.
    neighbours: Vec<Vec<(usize, f64)>>,
    /// The least shares of the legs around every target that pay for its own state, s, or 0.
    floors: Vec<f64>,
}

impl LagrangianTriples {
    /// No multipliers.
    pub(super) fn new(model: &dyn TourModel, table: &PairTable) -> Self {
        Self {
            start: table.start(),
            end: table.end(),
            symmetric: model.is_symmetric(),
            multipliers: HashMap::default(),
            excesses: HashMap::default(),
            beyond: HashMap::default(),
            neighbours: vec![Vec::new(); table.targets()],
            floors: vec![0.0; table.targets()],
        }
    }

    /// Whether there is no multiplier.
    pub(super) fn is_empty(&self) -> bool {
        self.beyond.is_empty()
    }

    /// Whether the model has been asked for the multiplier of a target between two places.
    pub(super) fn is_known(&self, triple: [usize; 3]) -> bool {
        self.multipliers.contains_key(&self.either_way(triple))
    }

    /// The shares of the legs around a target, where they pay; 0 where they do not.
    pub(super) fn shares(&self, triple: [usize; 3]) -> Shares {
        self.paid(triple).unwrap_or_default()
    }

    fn paid(&self, triple: [usize; 3]) -> Option<Shares> {
        if self.is_empty() || triple.contains(&NOWHERE) {
            return None;
        }
        let key = self.either_way(triple);
        let shares = self.multipliers.get(&key)?.as_ref()?.shares;
        Some(if key == triple {
            shares
        } else {
            Shares {
                before: shares.after,
                after: shares.before,
            }
        })
    }

    /// The triple in the middle of five places with the outer ones that count, where any does.
    pub(super) fn paying(&self, [h, i, j, k, l]: [usize; 5]) -> Option<[usize; 5]> {
        let first = self.paid([h, i, j]).map_or(NOWHERE, |_| h);
        let last = self.paid([j, k, l]).map_or(NOWHERE, |_| l);
        (first != NOWHERE || last != NOWHERE).then_some([first, i, j, k, last])
    }

    /// Whether the model has been asked for a paying triple.
    pub(super) fn is_solved(&self, paying: [usize; 5]) -> bool {
        self.excesses.contains_key(&self.either_way(paying))
    }

    /// By how much a paying triple exceeds its pair bounds at least, s.
    pub(super) fn excess(&self, paying: [usize; 5]) -> f64 {
        let solved = self.excesses.get(&self.either_way(paying));
        solved.copied().unwrap_or_else(|| self.sum_of_shares(paying))
    }

    fn sum_of_shares(&self, [h, i, j, k, l]: [usize; 5]) -> f64 {
        self.shares([h, i, j]).after + self.shares([j, k, l]).before
    }

    /// The places beyond a neighbour of a target with which the leg between them pays.
    pub(super) fn beyond(&self, target: usize, neighbour: usize) -> &[Beyond] {
        self.beyond.get(&[target, neighbour]).map_or(&[], Vec::as_slice)
    }

    /// The neighbours of a target with multipliers, and the least share, s, or 0, of its legs there.
    pub(super) fn neighbours(&self, target: usize) -> &[(usize, f64)] {
        &self.neighbours[target]
    }

    /// The least sum of shares, s, or 0, of the legs around a target that pay for its own state.
    pub(super) fn floor(&self, target: usize) -> f64 {
        self.floors[target]
    }

    /// Asks the model for multipliers: costates at the middle of five places, of which the outer ones
    /// may be [`NOWHERE`].
    pub(super) fn ask_multipliers(
        &mut self,
        paths: &[[usize; 5]],
        table: &PairTable,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let answers = pool.map(paths, |path| {
            let places: Vec<usize> = path.iter().copied().filter(|&p| p != NOWHERE).collect();
            let at = usize::from(path[0] != NOWHERE);
            let route: Vec<_> = places.iter().map(|&place| table.place(place)).collect();
            let passage = model.path_costates(&route).and_then(|all| all.into_iter().nth(at));
            let [_, before, via, after, _] = *path;
            let multiplier = passage.and_then(|passage| {
                multiplier([before, via, after], passage, table, model)
            });
            (!stop.is_set()).then_some(([before, via, after], multiplier))
        });
        for (triple, multiplier) in answers.into_iter().flatten() {
            self.set(triple, multiplier);
        }
    }

    /// Takes multipliers from the costates along an order, where none is known.
    pub(super) fn follow(
        &mut self,
        path: &[usize],
        passages: Vec<PassageCostate>,
        table: &PairTable,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let triples = path.windows(3).map(|t| [t[0], t[1], t[2]]).zip(passages);
        let fresh: Vec<_> = triples.filter(|(triple, _)| !self.is_known(*triple)).collect();
        let answers = pool.map(&fresh, |(triple, passage)| {
            let found = multiplier(*triple, passage.clone(), table, model);
            (!stop.is_set()).then_some((*triple, found))
        });
        for (triple, multiplier) in answers.into_iter().flatten() {
            self.set(triple, multiplier);
        }
    }

    fn set(&mut self, triple: [usize; 3], multiplier: Option<Multiplier>) {
        let key = self.either_way(triple);
        let turned = multiplier.map(|found| if key == triple { found } else { found.reversed() });
        if let Some(Multiplier { shares, .. }) = &turned {
            let Shares { before, after } = *shares;
            let [i, j, k] = key;
            self.list([i, j], k, before);
            self.list([k, j], i, after);
            self.floors[j] = self.floors[j].min(before.min(0.0) + after.min(0.0));
        }
        self.multipliers.insert(key, turned);
    }

    /// Lists the share of the leg between a target and a neighbour with a multiplier.
    fn list(&mut self, leg: [usize; 2], place: usize, share: f64) {
        let [target, neighbour] = leg;
        let Some(neighbours) = self.neighbours.get_mut(target) else {
            return;
        };
        self.beyond.entry(leg).or_default().push(Beyond { place, share });
        match neighbours.iter_mut().find(|(known, _)| *known == neighbour) {
            Some((_, least)) => *least = least.min(share),
            None => neighbours.push((neighbour, share.min(0.0))),
        }
    }

    /// Asks the model for paying triples.
    pub(super) fn ask_triples(
        &mut self,
        paying: &[[usize; 5]],
        table: &PairTable,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let answers = pool.map(paying, |&path| {
            let path = self.either_way(path);
            (!stop.is_set()).then(|| self.solve(path, table, model)).flatten()
        });
        for (path, excess) in paying.iter().zip(answers) {
            if let Some(excess) = excess {
                self.excesses.insert(self.either_way(*path), excess);
            }
        }
    }

    /// Excess of a paying triple, s; `None` when the solve is stopped.
    fn solve(&self, path: [usize; 5], table: &PairTable, model: &dyn TourModel) -> Option<f64> {
        let [h, i, j, k, l] = path;
        let ends = [[h, i, j], [j, k, l]].map(|triple| self.multiplier(triple));
        let costates = ends.each_ref().map(|end| Some(end.as_ref()?.passage.costate.as_slice()));
        let levels = ends.each_ref().map(|end| end.as_ref().map_or(0.0, |end| end.passage.level_s));
        let least = self.sum_of_shares(path);
        match model.lagrangian_path(&[i, j, k].map(|place| table.place(place)), costates) {
            Evaluation::Value(sum) => {
                let excess = sum + levels[0] - levels[1] - table.bound(i, j) - table.bound(j, k);
                Some(excess.max(least))
            }
            // The model is not asked again.
            Evaluation::Unresolved => Some(least),
            Evaluation::Stopped => None,
        }
    }

    /// The multiplier of a target between two places, in this direction.
    fn multiplier(&self, triple: [usize; 3]) -> Option<Multiplier> {
        if triple.contains(&NOWHERE) {
            return None;
        }
        let key = self.either_way(triple);
        let found = self.multipliers.get(&key)?.as_ref()?;
        Some(if key == triple { found.clone() } else { found.reversed() })
    }

    /// The key of a path: in a symmetric model the lesser of it and its reverse, in which start and end
    /// are exchanged.
    fn either_way<const N: usize>(&self, path: [usize; N]) -> [usize; N] {
        if !self.symmetric {
            return path;
        }
        let mut back = path;
        back.reverse();
        path.min(back.map(|place| match place {
            place if place == self.start => self.end,
            place if place == self.end => self.start,
            place => place,
        }))
    }
}

impl Multiplier {
    /// The same for the tour in reverse: states change sign, costates do not.
    fn reversed(&self) -> Self {
        Self {
            passage: PassageCostate {
                level_s: -self.passage.level_s,
                ..self.passage.clone()
            },
            shares: Shares {
                before: self.shares.after,
                after: self.shares.before,
            },
        }
    }
}

/// The multiplier of a target between two places with the shares of its legs; `None` where these do not
/// resolve.
fn multiplier(
    [before, via, after]: [usize; 3],
    passage: PassageCostate,
    table: &PairTable,
    model: &dyn TourModel,
) -> Option<Multiplier> {
    let excess = |leg: [usize; 2], costates, level_s: f64| {
        match model.lagrangian_path(&leg.map(|place| table.place(place)), costates) {
            Evaluation::Value(sum) if sum.is_finite() => {
                Some(sum + level_s - table.bound(leg[0], leg[1]))
            }
            _ => None,
        }
    };
    let costate = Some(passage.costate.as_slice());
    let shares = Shares {
        before: excess([before, via], [None, costate], -passage.level_s)?,
        after: excess([via, after], [costate, None], passage.level_s)?,
    };
    Some(Multiplier { passage, shares })
}
