//! Cells of a cube's surface blown up to the sphere.
//!
//! A point with the component of largest size `x_m` lies on face `m` with the coordinates
//! `x_i / |x_m|` in `[-1, 1]`; they are the tangents of angles that the cells divide into equal
//! parts. Across the edge of a face the coordinates of both sides are the same, so that cells meet
//! face to face everywhere. A cell is bounded by hyperplanes through the centre of the sphere: it is
//! convex, and its point farthest from any other is a corner. Where opposite points are the same
//! (attitudes as quaternions of any sign), one of two opposite faces is enough.

use super::sphere::{Point, dot};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// A cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Cell<const D: usize> {
    /// The component of largest size on its face.
    main: usize,
    /// Whether that component is negative.
    negative: bool,
    /// Halvings of the face.
    pub(super) level: u8,
    /// Position along each axis of the face; that of the main axis is not used.
    at: [u16; D],
}

/// One of a cell's faces to its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Side {
    /// The axis across which it is.
    axis: usize,
    /// Whether it is the side of the larger coordinate.
    high: bool,
}

/// All cells down to the finest level.
#[derive(Debug)]
pub(super) struct Lattice<const D: usize> {
    /// The finest level.
    pub(super) finest: u8,
    projective: bool,
    /// Coordinates of corners and centres of the finest cells.
    tangents: Vec<f64>,
}

impl<const D: usize> Lattice<D> {
    /// Cells of at most so many halvings.
    pub(super) fn new(finest: u8, projective: bool) -> Self {
        let steps = 1_u32 << (finest + 1);
        let angle = |i| f64::from(i) / f64::from(steps) * FRAC_PI_2 - FRAC_PI_4;
        Self {
            finest,
            projective,
            tangents: (0..=steps).map(|i| angle(i).tan()).collect(),
        }
    }

    /// The faces; [`Lattice::root`] is the position of a cell's face among them.
    pub(super) fn roots(&self) -> Vec<Cell<D>> {
        let signs: &[bool] = if self.projective {
            &[false]
        } else {
            &[false, true]
        };
        let face = |main| {
            signs.iter().map(move |negative| Cell {
                main,
                negative: *negative,
                level: 0,
                at: [0; D],
            })
        };
        (0..D).flat_map(face).collect()
    }

    /// The position of a cell's face among the roots.
    pub(super) fn root(&self, cell: &Cell<D>) -> usize {
        if self.projective {
            cell.main
        } else {
            2 * cell.main + usize::from(cell.negative)
        }
    }

    /// The face that holds a point, and the point with its sign there.
    pub(super) fn face(&self, x: &Point<D>) -> (usize, Point<D>) {
        let main = (0..D).max_by(|i, j| x[*i].abs().total_cmp(&x[*j].abs()));
        let main = main.unwrap_or(0);
        let negative = x[main] < 0.0;
        if self.projective {
            let sign = if negative { -1.0 } else { 1.0 };
            (main, x.map(|component| sign * component))
        } else {
            (2 * main + usize::from(negative), *x)
        }
    }

    /// Which of a cell's children, as [`Lattice::children`] orders them, holds a point of the cell.
    pub(super) fn child_with(&self, cell: &Cell<D>, x: &Point<D>) -> usize {
        let size = x[cell.main].abs();
        let axes = axes(cell);
        let bits = axes.enumerate().map(|(bit, axis)| {
            usize::from(x[axis] >= self.coordinate(cell, axis, 1) * size) << bit
        });
        bits.sum()
    }

    /// The cells into which a cell is divided.
    pub(super) fn children(cell: &Cell<D>) -> impl Iterator<Item = Cell<D>> + use<D> {
        let cell = *cell;
        (0..1_u16 << (D - 1)).map(move |bits| {
            let mut child = cell;
            child.level += 1;
            for (bit, axis) in axes(&cell).enumerate() {
                child.at[axis] = 2 * cell.at[axis] + (bits >> bit & 1);
            }
            child
        })
    }

    /// Whether a child, by its position among [`Lattice::children`], has part in a side of its
    /// parent.
    pub(super) fn touches(parent: &Cell<D>, child: usize, side: Side) -> bool {
        let bit = side.axis - usize::from(side.axis > parent.main);
        (child >> bit & 1 == 1) == side.high
    }

    /// A coordinate of a cell: 0 is its lower end, 1 its middle, 2 its upper end.
    fn coordinate(&self, cell: &Cell<D>, axis: usize, part: usize) -> f64 {
        let place = 2 * usize::from(cell.at[axis]) + part;
        self.tangents[place << (self.finest - cell.level)]
    }

    /// A point of a cell by its coordinates.
    fn point(&self, cell: &Cell<D>, part: impl Fn(usize) -> usize) -> Point<D> {
        let mut x = [0.0; D];
        x[cell.main] = if cell.negative { -1.0 } else { 1.0 };
        for axis in axes(cell) {
            x[axis] = self.coordinate(cell, axis, part(axis));
        }
        let length = dot(&x, &x).sqrt();
        x.map(|component| component / length)
    }

    /// The middle of a cell.
    pub(super) fn centre(&self, cell: &Cell<D>) -> Point<D> {
        self.point(cell, |_| 1)
    }

    /// The middle of one of its sides.
    pub(super) fn side_centre(&self, cell: &Cell<D>, side: Side) -> Point<D> {
        self.point(cell, |axis| match (axis == side.axis, side.high) {
            (true, false) => 0,
            (true, true) => 2,
            (false, _) => 1,
        })
    }

    /// Largest angle from the middle of a cell to a point of it, rad.
    pub(super) fn radius(&self, cell: &Cell<D>, centre: &Point<D>) -> f64 {
        let corner = |bits: usize| {
            let bit = |axis| axis - usize::from(axis > cell.main);
            dot(
                centre,
                &self.point(cell, |axis| 2 * (bits >> bit(axis) & 1)),
            )
        };
        let least = (0..1 << (D - 1)).map(corner).fold(1.0, f64::min);
        least.acos()
    }

    /// A bound on [`Lattice::radius`] for all cells of a level, rad: half the longest diagonal of small
    /// cells, which are squares or cubes in the middle of a face and rhombic towards its corners.
    pub(super) fn largest_radius(level: u8) -> f64 {
        let axes = (D - 1) as f64;
        let diagonal = axes.max((axes + 6.0) / 3.0).sqrt();
        diagonal / 2.0 * FRAC_PI_2 / f64::from(1_u32 << level)
    }

    /// The sides of a cell.
    pub(super) fn sides(cell: &Cell<D>) -> impl Iterator<Item = Side> + use<D> {
        axes(cell).flat_map(|axis| [false, true].map(|high| Side { axis, high }))
    }

    /// The cell of the same level beyond a side, and the same side as seen from there.
    pub(super) fn beyond(&self, cell: &Cell<D>, side: Side) -> (Cell<D>, Side) {
        let Side { axis, high } = side;
        let last = (1_u16 << cell.level) - 1;
        let mut next = *cell;
        let on_face = if high {
            cell.at[axis] < last
        } else {
            cell.at[axis] > 0
        };
        if on_face {
            next.at[axis] = if high {
                cell.at[axis] + 1
            } else {
                cell.at[axis] - 1
            };
            return (next, Side { axis, high: !high });
        }
        next.main = axis;
        next.negative = !high;
        next.at[axis] = 0;
        next.at[cell.main] = if cell.negative { 0 } else { last };
        let mut touching = Side {
            axis: cell.main,
            high: !cell.negative,
        };
        if self.projective && next.negative {
            next.negative = false;
            touching.high = !touching.high;
            for axis in axes(&next) {
                next.at[axis] = last - next.at[axis];
            }
        }
        (next, touching)
    }

    /// Positions among [`Lattice::children`] on the way from a face down to a cell.
    pub(super) fn descent(cell: &Cell<D>) -> impl Iterator<Item = usize> + use<D> {
        let cell = *cell;
        (0..cell.level).rev().map(move |shift| {
            let bits = axes(&cell).enumerate();
            bits.map(|(bit, axis)| usize::from(cell.at[axis] >> shift & 1) << bit)
                .sum()
        })
    }
}

/// The axes of a cell's face.
fn axes<const D: usize>(cell: &Cell<D>) -> impl Iterator<Item = usize> + use<D> {
    let main = cell.main;
    (0..D).filter(move |axis| *axis != main)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::leg::clear_path::sphere::{angle, opposite};

    /// All cells of a level.
    fn level<const D: usize>(lattice: &Lattice<D>, level: u8) -> Vec<Cell<D>> {
        (0..level).fold(lattice.roots(), |cells, _| {
            cells.iter().flat_map(Lattice::children).collect()
        })
    }

    fn sides_match<const D: usize>(projective: bool) {
        let lattice = Lattice::<D>::new(3, projective);
        let cells = level(&lattice, 2);
        let faces = if projective { D } else { 2 * D };
        assert_eq!(cells.len(), faces << (2 * (D - 1)));
        for cell in &cells {
            for side in Lattice::sides(cell) {
                let (next, touching) = lattice.beyond(cell, side);
                assert!(cells.contains(&next));
                assert_ne!(next, *cell);
                assert_eq!(lattice.beyond(&next, touching), (*cell, side));
                let [here, there] = [
                    lattice.side_centre(cell, side),
                    lattice.side_centre(&next, touching),
                ];
                let apart = angle(&here, &there);
                let apart = if projective {
                    apart.min(angle(&here, &opposite(&there)))
                } else {
                    apart
                };
                assert!(apart < 1e-12, "{cell:?} {side:?} {apart}");
            }
        }
    }

    #[test]
    fn both_cells_of_a_side_agree_on_it() {
        sides_match::<3>(false);
        sides_match::<4>(false);
        sides_match::<4>(true);
    }

    fn radii_are_bounded<const D: usize>() {
        let lattice = Lattice::<D>::new(5, false);
        for halvings in 2..=5 {
            let bound = Lattice::<D>::largest_radius(halvings);
            let radii = level(&lattice, halvings);
            let radii = radii
                .iter()
                .map(|cell| lattice.radius(cell, &lattice.centre(cell)));
            let largest = radii.fold(0.0, f64::max);
            assert!(
                largest <= bound && largest > 0.85 * bound,
                "{D} {halvings}: {largest} {bound}"
            );
        }
    }

    #[test]
    fn the_largest_radius_of_a_level_bounds_its_cells() {
        radii_are_bounded::<3>();
        radii_are_bounded::<4>();
    }

    #[test]
    fn a_descent_leads_to_the_cell_that_holds_its_centre() {
        let lattice = Lattice::<4>::new(3, true);
        for cell in level(&lattice, 3) {
            let centre = lattice.centre(&cell);
            let (face, x) = lattice.face(&centre);
            assert_eq!(face, lattice.root(&cell));
            let mut at = lattice.roots()[face];
            for step in Lattice::descent(&cell) {
                assert_eq!(lattice.child_with(&at, &x), step);
                at = Lattice::children(&at).nth(step).expect("a child");
            }
            assert_eq!(at, cell);
        }
    }
}
