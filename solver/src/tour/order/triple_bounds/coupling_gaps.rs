//! Coupling gaps: by how much the bound of a path exceeds the sum of the bounds of its parts, as
//! far as the model has solved them.

use super::gap_estimates::GapEstimates;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::{Evaluation, PairTable, Place, TourModel};
use foldhash::fast::FixedState;
use std::collections::HashMap;

/// Three or five places in a row, in either direction, listed with the smaller end first.
///
/// Places are numbered as in [`PairTable`].
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ShortPath(Vec<usize>);

impl ShortPath {
    pub(super) fn new(places: &[usize]) -> Self {
        let mut places = places.to_vec();
        if places.last() < places.first() {
            places.reverse();
        }
        Self(places)
    }

    /// Its legs, in the direction in which it is listed.
    pub(super) fn legs(&self) -> impl Iterator<Item = [usize; 2]> {
        self.0.windows(2).map(|leg| [leg[0], leg[1]])
    }
}

/// The known gaps of triples, s.
#[derive(Debug)]
struct KnownTriples {
    places: usize,
    /// Number of the row for `via * places + from`, or [`NO_ROW`].
    row_of: Vec<u32>,
    /// Known gaps by `to`, sorted: of many targets, a few in each row.
    rows: Vec<Vec<(u32, f64)>>,
}

/// Stands for a row without known gaps.
const NO_ROW: u32 = u32::MAX;

impl KnownTriples {
    fn new(targets: usize) -> Self {
        let places = targets + 2;
        Self {
            places,
            row_of: vec![NO_ROW; targets * places],
            rows: Vec::new(),
        }
    }

    /// The gap, or NaN where it is unknown.
    fn get(&self, [from, via, to]: [usize; 3]) -> f64 {
        let row = self.row_of[via * self.places + from];
        let row = self.rows.get(row as usize).map_or(&[][..], Vec::as_slice);
        let at = row.binary_search_by_key(&to, |entry| entry.0 as usize);
        at.map_or(f64::NAN, |at| row[at].1)
    }

    fn set(&mut self, [from, via, to]: [usize; 3], gap: f64) {
        let row_of = &mut self.row_of[via * self.places + from];
        if *row_of == NO_ROW {
            *row_of = narrow(self.rows.len());
            self.rows.push(Vec::new());
        }
        let row = &mut self.rows[*row_of as usize];
        match row.binary_search_by_key(&to, |entry| entry.0 as usize) {
            Ok(at) => row[at].1 = gap,
            Err(at) => row.insert(at, (narrow(to), gap)),
        }
    }
}

/// Delays of both legs of triples, s. The search for short orders looks them up all the time.
#[derive(Debug)]
struct Delays {
    places: u64,
    known: HashMap<u64, f64, FixedState>,
}

impl Delays {
    fn new(targets: usize) -> Self {
        Self {
            places: targets as u64 + 2,
            known: HashMap::default(),
        }
    }

    fn key(&self, [from, via, to]: [usize; 3]) -> u64 {
        (via as u64 * self.places + from as u64) * self.places + to as u64
    }

    fn get(&self, triple: [usize; 3]) -> Option<f64> {
        self.known.get(&self.key(triple)).copied()
    }

    fn set(&mut self, triple: [usize; 3], delay: f64) {
        self.known.insert(self.key(triple), delay);
    }
}

/// A number of a place or row in half the memory.
pub(super) fn narrow(number: usize) -> u32 {
    u32::try_from(number).expect("fewer places and rows than 2^32")
}

/// Coupling gaps of triples, and of five places in a row, over their pair bounds.
#[derive(Debug)]
pub(super) struct CouplingGaps {
    targets: usize,
    has_end: bool,
    symmetric: bool,
    couples: Vec<bool>,
    triples: KnownTriples,
    /// Excess of five places over their four pair bounds, s.
    fives: HashMap<[usize; 5], f64, FixedState>,
    estimates: GapEstimates,
    /// Estimated delays of both legs of the triples whose gap is known, s: the gap, or what solved
    /// tours say.
    delays: Delays,
}

impl CouplingGaps {
    /// No gap is known yet.
    pub(super) fn new(model: &dyn TourModel, table: &PairTable) -> Self {
        let targets = model.target_count();
        Self {
            targets,
            has_end: model.has_end(),
            symmetric: model.is_symmetric(),
            couples: (0..targets).map(|via| model.couples(via)).collect(),
            triples: KnownTriples::new(targets),
            fives: HashMap::default(),
            estimates: GapEstimates::new(table, &|from, to| model.free_ends(from, to)),
            delays: Delays::new(targets),
        }
    }

    /// Takes note that the model knows more of a leg.
    pub(super) fn update(&mut self, model: &dyn TourModel, table: &PairTable, [a, b]: [usize; 2]) {
        let free_ends = |from, to| model.free_ends(from, to);
        self.estimates.update(table, [a, b], &free_ends);
        self.estimates.update(table, [b, a], &free_ends);
    }

    /// The gap of a triple, s, as far as it is known, or an estimate; no bound.
    pub(super) fn estimate(&self, from: usize, via: usize, to: usize) -> f64 {
        if let Some(known) = self.delays.get([from, via, to]) {
            known
        } else if self.couples.get(via) == Some(&true) {
            self.estimates.gap(from, via, to)
        } else {
            0.0
        }
    }

    /// Learns from a solved tour along a path how much longer its legs take than their bounds, s: half
    /// of that is due to either end of a leg. Triples of several tours have the mean of the newest and
    /// of those before it.
    pub(super) fn learn(&mut self, path: &[usize], excesses: &[f64]) {
        let last = excesses.len() - 1;
        let share = |leg: usize| {
            let whole = leg == 0 || leg == last;
            if whole {
                excesses[leg]
            } else {
                0.5 * excesses[leg]
            }
        };
        for (leg, triple) in path.windows(3).enumerate() {
            let triple = [triple[0], triple[1], triple[2]];
            let Some(before) = self.delays.get(triple) else {
                continue;
            };
            let delay = (share(leg) + share(leg + 1)).max(0.0);
            let is_first = before.total_cmp(&self.triples.get(triple)).is_eq();
            let delay = if is_first {
                delay
            } else {
                0.5 * (before + delay)
            };
            for triple in [Some(triple), self.twin(triple)].into_iter().flatten() {
                self.delays.set(triple, delay);
            }
        }
    }

    /// The triple that is this one in reverse, where every order takes as long as its reverse: start and
    /// end are the same place.
    fn twin(&self, [from, via, to]: [usize; 3]) -> Option<[usize; 3]> {
        let (start, end) = (self.targets, self.targets + 1);
        let twin = |place: usize| match place {
            place if place == start => end,
            place if place == end => start,
            place => place,
        };
        self.symmetric.then(|| [twin(to), via, twin(from)])
    }

    /// Lower bound, s, of the time of two consecutive legs beyond their pair bounds; 0 where it is
    /// not known.
    pub(super) fn triple(&self, from: usize, via: usize, to: usize) -> f64 {
        // An unknown gap is not a number, for which the maximum gives 0.
        self.triples.get([from, via, to]).max(0.0)
    }

    /// Lower bound, s, of the time of four consecutive legs beyond the bounds of their two halves.
    pub(super) fn five(&self, path: [usize; 5]) -> f64 {
        if self.fives.is_empty() {
            return 0.0;
        }
        let [a, b, c, d, e] = path;
        let halves = || self.triple(a, b, c) + self.triple(c, d, e);
        self.fives
            .get(&path)
            .map_or(0.0, |coupling_gap| (coupling_gap - halves()).max(0.0))
    }

    /// Whether the model can be asked for a gap of this path that is not known.
    pub(super) fn is_open(&self, path: &ShortPath) -> bool {
        let middle = path.0[path.0.len() / 2];
        let unknown = |path: Vec<usize>| match path[..] {
            [a, b, c] => self.triples.get([a, b, c]).is_nan(),
            [a, b, c, d, e] => !self.fives.contains_key(&[a, b, c, d, e]),
            _ => false,
        };
        self.couples[middle] && self.directions(path).into_iter().flatten().any(unknown)
    }

    /// Asks the model for the gaps of paths. One worker asks for both directions of a path, since a
    /// model may derive one from the other. Interrupted evaluations leave the gap unknown.
    pub(super) fn ask(
        &mut self,
        paths: &[ShortPath],
        table: &PairTable,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let answers = pool.map(paths, |path| {
            self.directions(path).map(|path| {
                let path = path?;
                if stop.is_set() {
                    return None;
                }
                let places: Vec<Place> = path.iter().map(|&number| table.place(number)).collect();
                let pairs: f64 = path.windows(2).map(|leg| table.bound(leg[0], leg[1])).sum();
                match model.path_bound(&places) {
                    Evaluation::Value(bound) if bound.is_finite() => {
                        Some((path, (bound - pairs).max(0.0)))
                    }
                    // No gap beyond the pair bounds; the model is not asked again.
                    Evaluation::Value(_) | Evaluation::Unresolved => Some((path, 0.0)),
                    Evaluation::Stopped => None,
                }
            })
        });
        for (path, coupling_gap) in answers.into_iter().flatten().flatten() {
            match path[..] {
                [a, b, c] => {
                    self.estimates.learn([a, b, c], coupling_gap);
                    self.triples.set([a, b, c], coupling_gap);
                    self.delays.set([a, b, c], coupling_gap);
                }
                [a, b, c, d, e] => _ = self.fives.insert([a, b, c, d, e], coupling_gap),
                _ => {}
            }
        }
    }

    /// The directions of a path that a tour can contain: not into the start, not out of the end,
    /// and into the end only if one is prescribed.
    fn directions(&self, path: &ShortPath) -> [Option<Vec<usize>>; 2] {
        let (start, end) = (self.targets, self.targets + 1);
        let mut back = path.0.clone();
        back.reverse();
        [path.0.clone(), back].map(|path| {
            let (from, to) = (path[0], path[path.len() - 1]);
            let possible = from != end && to != start && (to != end || self.has_end);
            possible.then_some(path)
        })
    }
}
