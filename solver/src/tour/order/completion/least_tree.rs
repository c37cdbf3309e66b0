//! Minimum spanning trees (Prim 1957, Dijkstra 1959) and cheapest outer edges.

/// An edge of a tree.
#[derive(Debug, Clone, Copy)]
pub(in crate::tour::order) struct Edge {
    /// The two ends, by their positions in the list.
    pub(in crate::tour::order) ends: [usize; 2],
    /// Its weight.
    pub(in crate::tour::order) weight: f64,
}

/// The edges of a minimum spanning tree of a complete graph. The tree begins with position 0; every
/// edge comes after the one that joins its first end to the tree.
///
/// `fill` writes the weights of all edges at a position; that at the position itself is not read. Loops
/// over whole rows, the inside of the tree included, are vectorised.
pub(in crate::tour::order) fn least_tree(
    count: usize,
    fill: impl Fn(usize, &mut [f64]),
) -> Vec<Edge> {
    let padded = count.next_multiple_of(LANES);
    let mut weights = vec![0.0; padded];
    let mut frontier = Frontier {
        link: vec![f64::INFINITY; padded],
        inside_end: vec![0; padded],
        barred: vec![0.0; padded],
    };
    frontier.barred[count..].fill(f64::INFINITY);
    let mut edges = Vec::with_capacity(count.saturating_sub(1));
    let mut joined = 0;
    for _ in 1..count {
        frontier.leave(joined);
        fill(joined, &mut weights[..count]);
        let least = frontier.relax(joined, &weights);
        let Some(nearest) = frontier.first_within(least) else {
            break;
        };
        joined = nearest;
        edges.push(Edge {
            ends: [frontier.inside_end[joined] as usize, joined],
            weight: frontier.link[joined],
        });
    }
    edges
}

/// Positions that are worked on together.
const LANES: usize = 8;

/// The positions outside a growing tree, among all positions.
struct Frontier {
    /// Weight of the lightest edge to the tree; infinite inside.
    link: Vec<f64>,
    /// The other end of that edge.
    inside_end: Vec<u32>,
    /// Added to the weights of edges: infinite inside, else 0.
    barred: Vec<f64>,
}

impl Frontier {
    /// Takes a position into the tree.
    fn leave(&mut self, position: usize) {
        self.barred[position] = f64::INFINITY;
        self.link[position] = f64::INFINITY;
    }

    /// Updates the links by the edges at a position that joined the tree; returns the least weight.
    fn relax(&mut self, joined: usize, weights: &[f64]) -> f64 {
        let end = u32::try_from(joined).unwrap_or(u32::MAX);
        let mut least = [f64::INFINITY; LANES];
        let rows = self.link.chunks_exact_mut(LANES);
        let rows = rows.zip(self.inside_end.chunks_exact_mut(LANES));
        let known = weights.chunks_exact(LANES);
        let known = known.zip(self.barred.chunks_exact(LANES));
        for ((link, ends), (weights, barred)) in rows.zip(known) {
            for lane in 0..LANES {
                let weight = weights[lane] + barred[lane];
                let lighter = weight < link[lane];
                link[lane] = if lighter { weight } else { link[lane] };
                ends[lane] = if lighter { end } else { ends[lane] };
                least[lane] = if link[lane] < least[lane] {
                    link[lane]
                } else {
                    least[lane]
                };
            }
        }
        least.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The first position outside whose link is no heavier; the first one where weights are no numbers.
    fn first_within(&self, weight: f64) -> Option<usize> {
        let outside = |place: &usize| self.barred[*place] < f64::INFINITY;
        let light = self.link.iter().position(|&link| link <= weight);
        light
            .filter(outside)
            .or_else(|| (0..self.barred.len()).find(outside))
    }
}

/// Position in the list and weight of the lightest target; the first among equals.
pub(in crate::tour::order) fn cheapest(
    remaining: &[usize],
    weight: impl Fn(usize) -> f64,
) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (place, &target) in remaining.iter().enumerate() {
        let weight = weight(target);
        if weight < best.1 {
            best = (place, weight);
        }
    }
    best
}
