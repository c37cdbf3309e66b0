//! The search from cell to cell, at finer and finer levels.

use super::lattice::Lattice;
use super::retreat::retreat;
use super::space::{Cosine, Space};
use super::sphere::Point;
use super::tree::{Kind, Tree};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Bound on cells times cones.
const MAX_WORK: usize = 2_000_000;
/// Cells that are allowed with any number of cones.
const MIN_CELLS: usize = 5_000;

/// How finely is searched.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Halvings of a face in the first search.
    pub(super) coarsest: u8,
    /// Halvings in the last one.
    pub(super) finest: u8,
    /// Halvings for a second path where the first was found more coarsely: of the many ways that
    /// are there, coarse cells do not show which is shortest.
    pub(super) compared: u8,
    /// Cells at most.
    pub(super) cells: usize,
}

impl Limits {
    /// So many cells that their number times that of the cones is bounded too, but enough for the
    /// first search.
    fn cells_for(self, cones: usize) -> usize {
        let affordable = MAX_WORK / cones.max(1);
        self.cells.min(affordable.max(MIN_CELLS))
    }
}

/// What a search found.
#[derive(Debug, Clone)]
pub(super) enum Connection<const D: usize> {
    /// One path or two: points whose arcs are clear.
    Paths(Vec<Vec<Point<D>>>),
    /// Nothing, and it is proved that there is nothing.
    Disconnected,
    /// Nothing at this resolution, rad; the reached cells come so near, rad.
    Unknown { resolution: f64, closest: f64 },
}

/// Where one search may go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Through {
    /// Wherever an arc is known to be clear.
    Clear,
    /// Wherever something may be free.
    Possible,
}

/// Why a search did not arrive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Failed {
    /// Everything that can be reached has been.
    Exhausted,
    /// There are too many cells.
    Full,
}

/// A leaf with the best way to it.
#[derive(Debug, Clone, Copy)]
struct Record {
    cost: f64,
    previous: usize,
    /// Whether the arc from the previous leaf's middle to that of this one is clear.
    straight: bool,
    reached: bool,
}

const UNKNOWN: Record = Record {
    cost: f64::INFINITY,
    previous: usize::MAX,
    straight: false,
    reached: false,
};

/// A leaf to be reached, those with the least key first.
struct Entry {
    key: f64,
    leaf: usize,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_key = other.key.total_cmp(&self.key);
        by_key.then(other.leaf.cmp(&self.leaf))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

/// Clearance, rad, with which a path is found for certain at a level.
pub(super) fn resolution<const D: usize, F: Cosine<D>>(level: u8) -> f64 {
    F::SCALE * Lattice::<D>::largest_radius(level)
}

/// Connects two points, and returns how many cells that took.
pub(super) fn connect<const D: usize, F: Cosine<D>>(
    space: &Space<D, F>,
    [from, to]: [&Point<D>; 2],
    limits: Limits,
) -> (Connection<D>, usize) {
    if space.is_clear(from, to) {
        return (Connection::Paths(vec![vec![*from, *to]]), 0);
    }
    let mut search = Search::new(space, limits);
    let mut complete = std::f64::consts::PI;
    search.closest = space.turn(from, to);
    for level in limits.coarsest..=limits.finest {
        match search.run([to, from], level, Through::Possible) {
            Ok(_) => {}
            Err(Failed::Exhausted) => return (Connection::Disconnected, search.tree.len()),
            Err(Failed::Full) => break,
        }
        match search.between([from, to], level) {
            Ok(path) => {
                let mut paths = vec![path];
                if level < limits.compared {
                    paths.extend(search.between([from, to], limits.compared).ok());
                }
                return (Connection::Paths(paths), search.tree.len());
            }
            Err(Failed::Exhausted) => complete = resolution::<D, F>(level),
            Err(Failed::Full) => break,
        }
    }
    let unknown = Connection::Unknown {
        resolution: complete,
        closest: search.closest,
    };
    (unknown, search.tree.len())
}

/// Whether every search for a way fails because there is none, and how many cells it took to know.
pub(super) fn is_disconnected<const D: usize, F: Cosine<D>>(
    space: &Space<D, F>,
    [from, to]: [&Point<D>; 2],
    limits: Limits,
) -> (bool, usize) {
    let mut search = Search::new(space, limits);
    for level in limits.coarsest..=limits.finest {
        match search.run([to, from], level, Through::Possible) {
            Ok(_) => {}
            Err(Failed::Exhausted) => return (true, search.tree.len()),
            Err(Failed::Full) => break,
        }
    }
    (false, search.tree.len())
}

/// The state of the searches through one tree.
struct Search<'a, const D: usize, F> {
    tree: Tree<'a, D, F>,
    records: Vec<Record>,
    queue: BinaryHeap<Entry>,
    level: u8,
    through: Through,
    goal: Point<D>,
    /// Least angle of rotation from a reached cell to the goal, rad.
    closest: f64,
}

impl<'a, const D: usize, F: Cosine<D>> Search<'a, D, F> {
    fn new(space: &'a Space<D, F>, limits: Limits) -> Self {
        Self {
            tree: Tree::new(space, limits.finest, limits.cells_for(space.cones.len())),
            records: Vec::new(),
            queue: BinaryHeap::new(),
            level: 0,
            through: Through::Possible,
            goal: [0.0; D],
            closest: f64::INFINITY,
        }
    }

    /// A path between two points at a level, by ways from both into the open.
    fn between(&mut self, ends: [&Point<D>; 2], level: u8) -> Result<Vec<Point<D>>, Failed> {
        let wanted = resolution::<D, F>(level);
        let ends = ends.map(|end| retreat(self.tree.space, end, wanted));
        let inner = [&ends[0], &ends[1]].map(|way| way[way.len() - 1]);
        let leaf = self.run([&inner[0], &inner[1]], level, Through::Clear)?;
        Ok(self.path(ends, leaf))
    }

    /// One search between two points at a level, and the leaf at which it arrives: A* (Hart, Nilsson and Raphael 1968), with arcs that
    /// skip leaves where they are clear (Theta*, Nash and others 2007). Without them all paths are as
    /// long as those of a taxi, and the shortest is a matter of how the cells happen to lie.
    fn run(
        &mut self,
        [from, to]: [&Point<D>; 2],
        level: u8,
        through: Through,
    ) -> Result<usize, Failed> {
        let leaves = [from, to].map(|end| self.tree.leaf_with(end, level));
        let [Some(first), Some(last)] = leaves else {
            return Err(Failed::Full);
        };
        (self.level, self.through, self.goal) = (level, through, *to);
        self.queue.clear();
        self.records.clear();
        self.records.resize(self.tree.len(), UNKNOWN);
        if through == Through::Clear && !(self.joins(from, first) && self.joins(to, last)) {
            return Err(Failed::Exhausted);
        }
        self.records[first].cost = 0.0;
        self.queue.push(Entry {
            key: 0.0,
            leaf: first,
        });
        let (mut around, mut inner) = (Vec::new(), Vec::new());
        while let Some(Entry { leaf, .. }) = self.queue.pop() {
            if self.records[leaf].reached || self.tree.is_divided(leaf) {
                continue;
            }
            if self.tree.is_open(leaf, level) {
                let Some(children) = self.tree.divide(leaf) else {
                    return Err(Failed::Full);
                };
                self.records.resize(self.tree.len(), UNKNOWN);
                for child in children {
                    self.tree.neighbours(child, &mut inner);
                    for (other, middle) in &inner {
                        if self.records[*other].reached {
                            self.improve(*other, child, middle);
                        }
                    }
                }
                continue;
            }
            self.reach(leaf);
            if leaf == last {
                return Ok(leaf);
            }
            self.tree.neighbours(leaf, &mut around);
            for (other, middle) in &around {
                self.improve(leaf, *other, middle);
            }
        }
        Err(Failed::Exhausted)
    }

    fn reach(&mut self, leaf: usize) {
        self.records[leaf].reached = true;
        if self.through == Through::Clear {
            let left = self
                .tree
                .space
                .turn(&self.tree.node(leaf).centre, &self.goal);
            self.closest = self.closest.min(left);
        }
    }

    /// Whether the middle of a leaf can be reached from a point of it.
    fn joins(&self, x: &Point<D>, leaf: usize) -> bool {
        let (space, node) = (self.tree.space, self.tree.node(leaf));
        node.kind == Kind::Free
            || (node.clearance >= 0.0
                && (space.turn(x, &node.centre) <= node.clearance
                    || space.is_clear(x, &node.centre)))
    }

    /// Whether the arc between the middles of two leaves, of so much rotation, is clear. It is where
    /// the clearances of both make it up, since along it they fall no faster than it turns.
    fn sees(&self, leaf: usize, other: usize, turn: f64) -> bool {
        let [here, there] = [leaf, other].map(|leaf| self.tree.node(leaf));
        turn <= here.clearance + there.clearance
            || self.tree.space.is_clear(&here.centre, &there.centre)
    }

    /// Goes from a leaf to its neighbour through the middle of the side that they share, if that is
    /// shorter than what is known.
    fn improve(&mut self, leaf: usize, other: usize, middle: &Point<D>) {
        let (space, here, next) = (self.tree.space, self.tree.node(leaf), self.tree.node(other));
        if next.kind == Kind::Blocked || self.records[other].reached {
            return;
        }
        let before = self.records[leaf].cost + space.turn(&here.centre, middle);
        if self.through == Through::Possible {
            if before < self.records[other].cost {
                self.enter(leaf, other, before, space.turn(middle, &self.goal));
            }
            return;
        }
        if self.tree.is_open(other, self.level) {
            // Its parts will be entered when it is divided.
            if before < self.records[other].cost {
                let key = before + space.turn(middle, &self.goal);
                self.enter(leaf, other, before, key);
            }
            return;
        }
        if next.clearance < 0.0 {
            return;
        }
        let left = space.turn(&next.centre, &self.goal);
        let previous = self.records[leaf].previous;
        if previous != usize::MAX {
            let earlier = &self.tree.node(previous).centre;
            let turn = space.turn(earlier, &next.centre);
            let cost = self.records[previous].cost + turn;
            if cost < self.records[other].cost && self.sees(previous, other, turn) {
                self.enter(previous, other, cost, cost + left);
                self.records[other].straight = true;
                return;
            }
        }
        let cost = before + space.turn(middle, &next.centre);
        let shorter = cost < self.records[other].cost;
        if shorter && self.joins(middle, leaf) && self.joins(middle, other) {
            self.enter(leaf, other, cost, cost + left);
        }
    }

    fn enter(&mut self, previous: usize, leaf: usize, cost: f64, key: f64) {
        self.records[leaf] = Record {
            cost,
            previous,
            ..UNKNOWN
        };
        self.queue.push(Entry { key, leaf });
    }

    /// The points of the path to a leaf, between the ways from both ends into the open.
    fn path(&self, [begin, mut end]: [Vec<Point<D>>; 2], last: usize) -> Vec<Point<D>> {
        end.reverse();
        let (mut inner, mut leaf) = (Vec::new(), last);
        let mut around = Vec::new();
        loop {
            inner.push(self.tree.node(leaf).centre);
            let Record {
                previous, straight, ..
            } = self.records[leaf];
            if previous == usize::MAX {
                break;
            }
            if !straight {
                self.tree.neighbours(leaf, &mut around);
                let shared = around.iter().find(|(other, _)| *other == previous);
                inner.extend(shared.map(|(_, middle)| *middle));
            }
            leaf = previous;
        }
        inner.reverse();
        [begin, inner, end].concat()
    }
}
