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
    mut fill: impl FnMut(usize, &mut [f64]),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::SplitMix;

    /// Weight of the lightest spanning tree by Kruskal's algorithm.
    fn lightest(count: usize, weight: &dyn Fn(usize, usize) -> f64) -> f64 {
        let mut edges: Vec<[usize; 2]> = (0..count)
            .flat_map(|a| (0..a).map(move |b| [a, b]))
            .collect();
        edges.sort_by(|a, b| weight(a[0], a[1]).total_cmp(&weight(b[0], b[1])));
        let mut part: Vec<usize> = (0..count).collect();
        let mut sum = 0.0;
        for [a, b] in edges {
            let (one, other) = (part[a], part[b]);
            if one != other {
                sum += weight(a, b);
                part.iter_mut()
                    .filter(|at| **at == other)
                    .for_each(|at| *at = one);
            }
        }
        sum
    }

    #[test]
    fn trees_are_as_light_as_those_of_kruskal() {
        let mut random = SplitMix::new(1);
        for count in (1..40).chain([64, 65]) {
            let points: Vec<[f64; 2]> = (0..count)
                .map(|_| [(); 2].map(|()| random.below(50) as f64 - 25.0))
                .collect();
            // Ties, and weights of both signs.
            let weight = |a: usize, b: usize| {
                let [p, q] = [points[a], points[b]];
                (p[0] - q[0]).abs() + (p[1] - q[1]).abs() + 0.5 * (p[0] + q[0])
            };
            let tree = least_tree(count, |a, weights| {
                for (b, entry) in weights.iter_mut().enumerate() {
                    *entry = weight(a, b);
                }
            });
            let mut joined = vec![false; count];
            joined[0] = true;
            for edge in &tree {
                let [inside, next] = edge.ends;
                assert!(joined[inside] && !joined[next]);
                assert!((edge.weight - weight(inside, next)).abs() < 1e-12);
                joined[next] = true;
            }
            assert_eq!(tree.len(), count - 1);
            let sum: f64 = tree.iter().map(|edge| edge.weight).sum();
            assert!((sum - lightest(count, &weight)).abs() < 1e-9, "{count}");
        }
    }
}
