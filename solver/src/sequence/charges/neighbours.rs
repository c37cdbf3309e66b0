//! The cheapest two neighbours of a target.

/// The places around every target in the order of what the target takes over of the edge to them.
///
/// Kept from one step of the ascent to the next: where little changes, little is to be sorted.
#[derive(Debug, Clone)]
pub(super) struct Neighbours {
    places: usize,
    /// By rows, one for each target, all places but the target itself.
    sorted: Vec<u32>,
}

/// Two neighbours of a target and what they cost it, s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    pub(super) ends: [usize; 2],
    pub(super) cost: f64,
}

impl Neighbours {
    pub(super) fn new(targets: usize) -> Self {
        let places = targets + 2;
        let others = |via| (0..places).filter(move |&place| place != via);
        Self {
            places,
            sorted: (0..targets)
                .flat_map(others)
                .map(|place| u32::try_from(place).unwrap_or(u32::MAX))
                .collect(),
        }
    }

    fn row(&self, via: usize) -> &[u32] {
        &self.sorted[via * (self.places - 1)..][..self.places - 1]
    }

    /// Sorts the places around a target by their shares, by insertion.
    pub(super) fn sort(&mut self, via: usize, shares: &[f64]) {
        let row = &mut self.sorted[via * (self.places - 1)..][..self.places - 1];
        for i in 1..row.len() {
            let place = row[i];
            let share = shares[place as usize];
            let mut hole = i;
            while hole > 0 && shares[row[hole - 1] as usize] > share {
                row[hole] = row[hole - 1];
                hole -= 1;
            }
            row[hole] = place;
        }
    }

    /// The cheapest two of the places around a target that are admitted: the least sum of their
    /// shares and of what passing between them costs, which is not negative. Infinite when there are
    /// not two.
    ///
    /// Exact, though most pairs are never looked at: places come in the order of their shares, so
    /// once the shares alone reach the best cost all later pairs do.
    pub(super) fn cheapest(
        &self,
        via: usize,
        shares: &[f64],
        admitted: impl Fn(usize) -> bool,
        passing: impl Fn([usize; 2]) -> f64,
    ) -> Choice {
        let mut places = self
            .row(via)
            .iter()
            .map(|&place| place as usize)
            .filter(|&place| admitted(place));
        let mut best = Choice {
            ends: [via; 2],
            cost: f64::INFINITY,
        };
        while let Some(one) = places.next() {
            for (rank, other) in places.clone().enumerate() {
                let shared = shares[one] + shares[other];
                if shared >= best.cost {
                    // Nor is the next place cheaper together with this one, or any after them.
                    if rank <= 1 {
                        return best;
                    }
                    break;
                }
                let cost = shared + passing([one, other]);
                if cost < best.cost {
                    best = Choice {
                        ends: [one, other],
                        cost,
                    };
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that look random, in `[0, 1)`.
    fn number(a: usize, b: usize, c: usize) -> f64 {
        ((13 * a + 78 * b + 37 * c) as f64).sin().abs()
    }

    #[test]
    fn the_cheapest_pair_is_found_without_looking_at_all() {
        let targets = 12;
        let mut neighbours = Neighbours::new(targets);
        for round in 0..20 {
            let via = round % targets;
            let shares: Vec<f64> = (0..targets + 2)
                .map(|i| number(i, round, 1) - 0.5)
                .collect();
            let passing = |[a, b]: [usize; 2]| 2.0 * number(a.min(b), a.max(b), round);
            let admitted = |place: usize| place % 5 != round % 5;
            neighbours.sort(via, &shares);
            let found = neighbours.cheapest(via, &shares, admitted, passing);
            let others: Vec<usize> = (0..targets + 2)
                .filter(|&place| place != via && admitted(place))
                .collect();
            let mut least = f64::INFINITY;
            for (i, &a) in others.iter().enumerate() {
                for &b in &others[..i] {
                    least = least.min(shares[a] + shares[b] + passing([a, b]));
                }
            }
            assert!((found.cost - least).abs() < 1e-12, "round {round}");
            let [a, b] = found.ends;
            assert!((shares[a] + shares[b] + passing([a, b]) - least).abs() < 1e-12);
        }
    }
}
