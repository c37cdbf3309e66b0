//! What is known of triples.

use crate::pool::SolverPool;
use crate::sequence::{Evaluation, PairTable, Place, TourModel};
use crate::stop::StopSignal;

/// A target with two places before and after it, in either direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Triple {
    /// The target.
    pub(super) via: usize,
    /// Its neighbours, the smaller number first.
    pub(super) ends: [usize; 2],
}

impl Triple {
    pub(super) fn new(via: usize, a: usize, b: usize) -> Self {
        Self {
            via,
            ends: [a.min(b), a.max(b)],
        }
    }
}

/// By how much triples exceed the sums of their pair bounds, as far as the model has been asked.
///
/// Places are numbered as in [`PairTable`].
#[derive(Debug)]
pub(super) struct Triples {
    targets: usize,
    has_end: bool,
    couples: Vec<bool>,
    /// Row `via * places + from`, there once something is known of it: excess of every `to`, s, not
    /// a number where nothing is known.
    rows: Vec<Option<Box<[f64]>>>,
}

impl Triples {
    /// Nothing known yet.
    pub(super) fn new(model: &dyn TourModel) -> Self {
        let targets = model.target_count();
        Self {
            targets,
            has_end: model.has_end(),
            couples: (0..targets).map(|via| model.couples(via)).collect(),
            rows: vec![None; targets * (targets + 2)],
        }
    }

    /// Lower bound, s, of what the two legs take together beyond their pair bounds: 0 where nothing
    /// better is known.
    pub(super) fn excess(&self, from: usize, via: usize, to: usize) -> f64 {
        // The greater of 0 and what is no number is 0.
        self.known(from, via, to).max(0.0)
    }

    /// Whether asking the model could tell more.
    pub(super) fn is_open(&self, triple: Triple) -> bool {
        let [a, b] = triple.ends;
        let unknown = |[from, to]: [usize; 2]| self.known(from, triple.via, to).is_nan();
        self.couples[triple.via] && self.directions(a, b).into_iter().flatten().any(unknown)
    }

    /// Asks the model for triples, both directions of each by the same worker, who may know the one
    /// when he knows the other.
    /// Those that are interrupted stay unknown.
    pub(super) fn ask(
        &mut self,
        triples: &[Triple],
        table: &PairTable,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) {
        let answers = pool.map(triples, |triple| {
            let [a, b] = triple.ends;
            self.directions(a, b).map(|direction| {
                let [from, to] = direction?;
                if stop.is_set() {
                    return Some(Evaluation::Stopped);
                }
                Some(model.triple_bound(self.place(from), triple.via, self.place(to)))
            })
        });
        for (triple, answers) in triples.iter().zip(answers) {
            let [a, b] = triple.ends;
            for (direction, answer) in self.directions(a, b).into_iter().zip(answers) {
                let (Some([from, to]), Some(answer)) = (direction, answer) else {
                    continue;
                };
                let pairs = table.bound(from, triple.via) + table.bound(triple.via, to);
                match answer {
                    Evaluation::Value(bound) if bound.is_finite() => {
                        self.set(from, triple.via, to, (bound - pairs).max(0.0));
                    }
                    // Nothing beyond the pairs, and no use asking again.
                    Evaluation::Value(_) | Evaluation::Unresolved => {
                        self.set(from, triple.via, to, 0.0);
                    }
                    Evaluation::Stopped => {}
                }
            }
        }
    }

    /// The directions in which a triple can be flown and of which there is something to know.
    fn directions(&self, a: usize, b: usize) -> [Option<[usize; 2]>; 2] {
        let (start, end) = (self.targets, self.targets + 1);
        let flown = |from, to| {
            let possible = from != end && to != start && (to != end || self.has_end);
            possible.then_some([from, to])
        };
        [flown(a, b), flown(b, a)]
    }

    fn place(&self, number: usize) -> Place {
        match number.checked_sub(self.targets) {
            None => Place::Target(number),
            Some(0) => Place::Start,
            Some(_) => Place::End,
        }
    }

    fn known(&self, from: usize, via: usize, to: usize) -> f64 {
        self.rows[via * (self.targets + 2) + from]
            .as_ref()
            .map_or(f64::NAN, |row| row[to])
    }

    fn set(&mut self, from: usize, via: usize, to: usize, excess: f64) {
        let places = self.targets + 2;
        let row = &mut self.rows[via * places + from];
        row.get_or_insert_with(|| vec![f64::NAN; places].into())[to] = excess;
    }
}
