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
pub(in crate::tour::order) fn least_tree(
    count: usize,
    weight: impl Fn(usize, usize) -> f64,
) -> Vec<Edge> {
    // For each position outside the tree: weight and other end of the lightest edge to the tree.
    let mut link = vec![(f64::INFINITY, 0); count];
    let mut outside: Vec<usize> = (1..count).collect();
    let mut edges = Vec::with_capacity(outside.len());
    let mut joined = 0;
    while !outside.is_empty() {
        let mut nearest = 0;
        for (place, &other) in outside.iter().enumerate() {
            let weight = weight(joined, other);
            if weight < link[other].0 {
                link[other] = (weight, joined);
            }
            if link[other].0 < link[outside[nearest]].0 {
                nearest = place;
            }
        }
        joined = outside.swap_remove(nearest);
        let (weight, inside) = link[joined];
        edges.push(Edge {
            ends: [inside, joined],
            weight,
        });
    }
    edges
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
