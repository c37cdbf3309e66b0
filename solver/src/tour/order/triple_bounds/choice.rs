//! The cheapest neighbours of each target: one of the two relaxed choices of the decomposition.

use super::TripleBounds;
use super::multipliers::PlaceMultipliers;
use super::ranking::CostsAround;
use crate::run::pool::SolverPool;

/// The part of a tour that a bound is for: from a place through some targets to the end.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// The place at which it begins.
    pub(super) entry: usize,
    /// Its targets.
    pub(super) targets: &'a [usize],
    /// Whether a place lies on it.
    admitted: Vec<bool>,
    end: usize,
}

/// The chosen neighbours of a target, the places beyond them, and their cost, s.
#[derive(Debug, Clone, Copy)]
pub(super) struct NeighbourChoice {
    /// The two neighbours.
    pub(super) ends: [usize; 2],
    /// The outer and joint multipliers in the cost: of which target, and for which place beyond it.
    pub(super) beyond: [[usize; 2]; 2],
    pub(super) cost: f64,
}

impl NeighbourChoice {
    /// The places beyond both neighbours, when both neighbours are targets.
    pub(super) fn path_beyond(&self) -> Option<[usize; 2]> {
        let [first, last] = self.beyond;
        ([first[0], last[0]] == self.ends).then_some([first[1], last[1]])
    }
}

impl<'a> Part<'a> {
    pub(super) fn new(entry: usize, end: usize, targets: &'a [usize]) -> Self {
        let mut admitted = vec![false; end + 1];
        for &place in targets.iter().chain([&entry, &end]) {
            admitted[place] = true;
        }
        Self {
            entry,
            targets,
            admitted,
            end,
        }
    }

    /// Whether a place is an end of the part.
    fn is_outer(&self, place: usize) -> bool {
        place == self.entry || place == self.end
    }
}

impl TripleBounds {
    /// Ranks the places around all targets by the current multipliers, and takes these from the edges.
    pub(super) fn apply_multipliers(&mut self, pool: Option<&SolverPool>) {
        let Self {
            multipliers,
            near,
            far,
            ..
        } = self;
        let targets = self.legs.table().targets();
        self.edge_rows.update(targets, multipliers);
        let zero = std::iter::repeat_n(0.0, targets + 2);
        far.rank(pool, targets, zero, |of| CostsAround {
            common: 0.0,
            own: multipliers.outer(of).listed(),
        });
        let least: Vec<f64> = (0..targets).map(|of| far.least(of)).collect();
        let (multipliers, least) = (&*multipliers, &least);
        near.rank(pool, targets, least.iter().copied(), |via| {
            let common = multipliers.common(via);
            // Next to an end of the tour it is the target's own outer multiplier for its other neighbour.
            let cost = move |(place, rest): (usize, f64)| {
                let outer = *least.get(place).unwrap_or(&least[via]);
                let joint = if place >= targets {
                    0.0
                } else {
                    multipliers.joint(place, via).least - multipliers.joint(via, place).most
                };
                (place, common + rest + outer + joint)
            };
            let own = multipliers.near_rest(via).listed().map(cost);
            CostsAround { common, own }
        });
    }

    /// The cheapest neighbours of a target of a part, and places beyond them: the minimum of the
    /// sum of their multipliers and of the cost of passing the target between them.
    ///
    /// The minimum is exact although most pairs are not evaluated. Pairs are enumerated in the
    /// order of a lower bound: their inner multipliers plus the least outer and joint ones (the cost of
    /// passing is not negative). Once this bound reaches the best cost, no later pair can be
    /// cheaper.
    pub(super) fn choice(&self, part: &Part<'_>, via: usize) -> NeighbourChoice {
        let mut best = NeighbourChoice {
            ends: [via; 2],
            beyond: [[via; 2]; 2],
            cost: f64::INFINITY,
        };
        let inner = |&(place, _): &(usize, f64)| part.admitted[place] && place != part.entry;
        let mut places = self.near.row(via).filter(inner);
        // The entry is treated apart: nothing lies beyond it on the part, whether it is a target or
        // not, so its rank does not apply.
        let entry = self.multipliers.near(via, part.entry) + self.far.least(via);
        for (other, cost) in places.clone() {
            if entry + cost >= best.cost {
                break;
            }
            // Only the target of a part with one target lies between its two ends.
            if other != part.end || part.targets.len() == 1 {
                self.choose_beyond(part, via, [part.entry, other], entry + cost, &mut best);
            }
        }
        while let Some((one, one_s)) = places.next() {
            for (rank, (other, other_s)) in places.clone().enumerate() {
                if one_s + other_s >= best.cost {
                    // If the cheapest partner fails, all later pairs fail too.
                    if rank <= 1 {
                        return best;
                    }
                    break;
                }
                self.choose_beyond(part, via, [one, other], one_s + other_s, &mut best);
            }
        }
        best
    }

    /// Replaces a choice by one with these neighbours, if it is cheaper with the best places beyond
    /// them. `least` bounds all but the cost of passing, s.
    fn choose_beyond(
        &self,
        part: &Part<'_>,
        via: usize,
        ends: [usize; 2],
        least: f64,
        best: &mut NeighbourChoice,
    ) {
        let [one, other] = ends;
        let coupling_gaps = &self.coupling_gaps;
        let ways = self.legs.ways(coupling_gaps, part.entry, [one, via, other]);
        let passing = ways[0].min(ways[1]);
        if least + passing >= best.cost {
            return;
        }
        // An end of the part has no choice of its own that would have to agree.
        let joint = |neighbour: usize| {
            if part.is_outer(neighbour) {
                return [PlaceMultipliers::NONE; 2];
            }
            [[via, neighbour], [neighbour, via]].map(|[of, seen]| self.multipliers.joint(of, seen))
        };
        let [[own_one, beyond_one], [own_other, beyond_other]] = [one, other].map(joint);
        let near = self.multipliers.near(via, one) + self.multipliers.near(via, other) + passing
            - own_one.of(other)
            - own_other.of(one);
        let truncated = part.is_outer(one) || part.is_outer(other);
        for (first, first_s) in self.beyond(part, via, one, other) {
            let joint_s = beyond_one.of(first[1]);
            for (rank, (last, last_s)) in self.beyond(part, via, other, one).enumerate() {
                // Both lists are sorted by the outer multipliers alone.
                let least = near + first_s + last_s + beyond_other.least;
                if rank == 0 && least + beyond_one.least >= best.cost {
                    return;
                }
                if least + joint_s >= best.cost {
                    break;
                }
                let mut cost = near + first_s + last_s + joint_s + beyond_other.of(last[1]);
                if cost >= best.cost {
                    continue;
                }
                if !truncated {
                    if first[1] == last[1] {
                        continue;
                    }
                    let path = [first[1], one, via, other, last[1]];
                    cost += self
                        .legs
                        .passing_five(coupling_gaps, part.entry, path, ways)
                        - passing;
                }
                if cost < best.cost {
                    *best = NeighbourChoice {
                        ends,
                        beyond: [first, last],
                        cost,
                    };
                }
            }
        }
    }

    /// The outer multipliers that may apply on the side of one neighbour, cheapest first. Next to
    /// an end of the part it is the target's own multiplier for its other neighbour.
    fn beyond(
        &self,
        part: &Part<'_>,
        via: usize,
        one: usize,
        other: usize,
    ) -> impl Iterator<Item = ([usize; 2], f64)> + Clone {
        let outer = part.is_outer(one);
        let of = if outer { via } else { one };
        let fits = move |&(place, _): &(usize, f64)| {
            if outer {
                place == other
            } else {
                part.admitted[place] && place != via && place != other
            }
        };
        let places = self.far.row(of).filter(fits);
        places.map(move |(place, cost)| ([of, place], cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::pool::SolverPool;
    use crate::run::stop::StopSignal;
    use crate::tour::order::PairTable;
    use crate::tour::order::completion::{LegCosts, SpanningTrees};
    use crate::tour::order::tests::RandomModel;
    use crate::tour::order::triple_bounds::AscentEffort;
    use std::num::NonZeroUsize;

    /// The cost of the cheapest choice, by enumeration.
    fn least(triple_bounds: &TripleBounds, part: &Part<'_>, via: usize) -> f64 {
        let others = || (0..=triple_bounds.end()).filter(|&p| p != via && part.admitted[p]);
        let (multipliers, legs) = (&triple_bounds.multipliers, &triple_bounds.legs);
        let sides = |one: usize, other: usize| -> Vec<[usize; 2]> {
            if part.is_outer(one) {
                return vec![[via, other]];
            }
            let fits = others().filter(|&p| p != one && p != other);
            fits.map(|p| [one, p]).collect()
        };
        let mut least = f64::INFINITY;
        for (one, other) in others().flat_map(|a| others().map(move |b| (a, b))) {
            let single_target = part.targets.len() == 1;
            if one >= other || (part.is_outer(one) && part.is_outer(other) && !single_target) {
                continue;
            }
            let near = multipliers.near(via, one) + multipliers.near(via, other);
            let ways = legs.ways(&triple_bounds.coupling_gaps, part.entry, [one, via, other]);
            for [of, first] in sides(one, other) {
                for [to, last] in sides(other, one) {
                    let joint = |of: usize, beyond: usize| {
                        if of == via {
                            0.0
                        } else {
                            multipliers.joint(of, via).of(beyond)
                        }
                    };
                    let own = |neighbour: usize, beyond: usize| {
                        if part.is_outer(neighbour) {
                            0.0
                        } else {
                            multipliers.joint(via, neighbour).of(beyond)
                        }
                    };
                    let outer = multipliers.outer(of).of(first)
                        + multipliers.outer(to).of(last)
                        + joint(of, first)
                        + joint(to, last)
                        - own(one, other)
                        - own(other, one);
                    let passing = if of == via || to == via {
                        ways[0].min(ways[1])
                    } else if first == last {
                        f64::INFINITY
                    } else {
                        let path = [first, one, via, other, last];
                        legs.passing_five(&triple_bounds.coupling_gaps, part.entry, path, ways)
                    };
                    least = least.min(near + outer + passing);
                }
            }
        }
        least
    }

    #[test]
    fn the_pruned_choice_is_the_minimum_over_all_choices() {
        let pool = SolverPool::new(NonZeroUsize::new(1)).expect("test threads start");
        for seed in 0..8 {
            let kinds = [RandomModel::new, RandomModel::reversible];
            let model = kinds[seed % 2](8, seed % 4 < 2, seed as u64);
            let table = PairTable::new(&model);
            let trees = SpanningTrees::new(&table);
            let mut triple_bounds =
                TripleBounds::new(&model, &table, &trees).expect("legs are coupled");
            let effort = AscentEffort {
                triples: 300,
                fives: 300,
                fives_before_triples_end: true,
                steps: 70,
            };
            triple_bounds.raise(&model, &effort, &pool, &StopSignal::new(), &mut |_| ());
            for (entry, size) in [(table.start(), 8), (7, 7), (7, 4), (7, 2), (7, 1)] {
                let targets: Vec<usize> = (0..size).collect();
                let part = Part::new(entry, table.end(), &targets);
                for &via in &targets {
                    let found = triple_bounds.choice(&part, via).cost;
                    let expected = least(&triple_bounds, &part, via);
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "seed {seed}, {size} targets"
                    );
                }
            }
        }
    }
}
