//! The cells of a sphere, divided where it matters.

use super::lattice::{Cell, Lattice, Side};
use super::space::{Cosine, Space};
use super::sphere::Point;

/// Clearance, rad, that rounding may cost a cell.
const ROUNDING: f64 = 1e-9;

/// What the cones leave of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// All of it, and all points as near to its centre.
    Free,
    /// Perhaps a part.
    Mixed,
    /// Nothing: it is inside one cone.
    Blocked,
}

/// A cell with what is known of it.
#[derive(Debug)]
pub(super) struct Node<const D: usize> {
    /// The cell.
    cell: Cell<D>,
    /// Its middle.
    pub(super) centre: Point<D>,
    /// What the cones leave of it.
    pub(super) kind: Kind,
    /// Clearance of its middle, rad.
    pub(super) clearance: f64,
    /// Position of its first child; 0 where it is not divided.
    children: usize,
}

/// Cells from the faces down to leaves.
pub(super) struct Tree<'a, const D: usize, F> {
    /// The sphere with its cones.
    pub(super) space: &'a Space<D, F>,
    lattice: Lattice<D>,
    nodes: Vec<Node<D>>,
    limit: usize,
}

impl<'a, const D: usize, F: Cosine<D>> Tree<'a, D, F> {
    /// The faces, to be divided down to the finest level and into at most so many cells.
    pub(super) fn new(space: &'a Space<D, F>, finest: u8, limit: usize) -> Self {
        let mut tree = Self {
            space,
            lattice: Lattice::new(finest, space.projective),
            nodes: Vec::new(),
            limit,
        };
        for cell in tree.lattice.roots() {
            tree.add(cell);
        }
        tree
    }

    /// Cells so far.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// A cell.
    pub(super) fn node(&self, index: usize) -> &Node<D> {
        &self.nodes[index]
    }

    /// Whether a cell has been divided.
    pub(super) fn is_divided(&self, index: usize) -> bool {
        self.nodes[index].children > 0
    }

    /// Whether a search at a level has to divide a cell before it may enter.
    pub(super) fn is_open(&self, index: usize, level: u8) -> bool {
        let node = &self.nodes[index];
        node.kind == Kind::Mixed && node.cell.level < level
    }

    fn add(&mut self, cell: Cell<D>) {
        let centre = self.lattice.centre(&cell);
        let clearance = self.space.clearance(&centre);
        let radius = self.lattice.radius(&cell, &centre) * F::SCALE + ROUNDING;
        let kind = if clearance >= radius {
            Kind::Free
        } else if clearance <= -radius {
            Kind::Blocked
        } else {
            Kind::Mixed
        };
        self.nodes.push(Node {
            cell,
            centre,
            kind,
            clearance,
            children: 0,
        });
    }

    /// Divides a cell and returns its children; `None` when there are too many cells already.
    pub(super) fn divide(&mut self, index: usize) -> Option<std::ops::Range<usize>> {
        let (cell, first) = (self.nodes[index].cell, self.nodes.len());
        if first + (1 << (D - 1)) > self.limit {
            return None;
        }
        for child in Lattice::children(&cell) {
            self.add(child);
        }
        self.nodes[index].children = first;
        Some(first..self.nodes.len())
    }

    /// The leaf that holds a point, divided down to a level; `None` when there are too many cells.
    pub(super) fn leaf_with(&mut self, x: &Point<D>, level: u8) -> Option<usize> {
        let (mut index, x) = self.lattice.face(x);
        loop {
            if self.nodes[index].children == 0 {
                if !self.is_open(index, level) {
                    return Some(index);
                }
                self.divide(index)?;
            }
            let node = &self.nodes[index];
            index = node.children + self.lattice.child_with(&node.cell, &x);
        }
    }

    /// The leaves beyond the sides of a leaf, each with the middle of the side that they share.
    pub(super) fn neighbours(&self, index: usize, found: &mut Vec<(usize, Point<D>)>) {
        found.clear();
        let cell = self.nodes[index].cell;
        for side in Lattice::sides(&cell) {
            let (next, touching) = self.lattice.beyond(&cell, side);
            let mut at = self.lattice.root(&next);
            for child in Lattice::descent(&next) {
                if self.nodes[at].children == 0 {
                    break;
                }
                at = self.nodes[at].children + child;
            }
            if self.nodes[at].children == 0 {
                found.push((at, self.lattice.side_centre(&cell, side)));
            } else {
                self.leaves_on(at, touching, found);
            }
        }
    }

    /// The leaves of a divided cell that have part in one of its sides.
    fn leaves_on(&self, index: usize, side: Side, found: &mut Vec<(usize, Point<D>)>) {
        let node = &self.nodes[index];
        if node.children == 0 {
            found.push((index, self.lattice.side_centre(&node.cell, side)));
            return;
        }
        for child in 0..1 << (D - 1) {
            if Lattice::touches(&node.cell, child, side) {
                self.leaves_on(node.children + child, side, found);
            }
        }
    }
}
