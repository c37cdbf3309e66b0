//! The proof that no motion with rates in a symmetric polytope makes a turn in less than a time.
//!
//! What [`crate::bounds::polytope`] derives of the extremals is taken as given: the costate runs along a level curve of
//! the support function, on arcs of circles about vertices, and rests at saddles and minima only; all rests can be moved
//! to the end. The rest is done again in another way. A turn `R` takes the costate `m` at its beginning to `R^T m` at
//! its end. Where the vertices `v` and `v'` support these, `m . (v - R v') = 0`: all costates of this great circle are
//! covered by cells, and in each all ways from `m` to `R^T m` are followed in intervals (`ways`). A cell is refuted if
//! each of them takes as long as the time, or ends in another turn; else it is halved.
//!
//! Single arcs, and extremals near a minimum, which lead around it very often, have proofs of their own
//! (`near_minimum`). So that `v - R v'` is not zero, the turn is changed by a little, and the time of this change is
//! added to what is to be proved.

mod circles;
mod faces;
mod near_minimum;
mod ways;

use super::Rejection;
use super::turn::{
    QuatInterval, VectorInterval, about, angle_of, conjugate, cross, dot, least_turn, minus,
    of_numbers, product, rotate, unit,
};
use crate::bounds::interval::Interval;
use crate::model::attitude::Attitude;
use circles::Circles;
use faces::Faces;
use nalgebra::Vector3;
use near_minimum::{NearMinimum, Nearness};
use ways::{Way, Ways};

/// Change of a turn, as a share of its angle.
const MOVED: f64 = 1e-8;
/// Parts of a great circle to begin with.
const PARTS: u32 = 8;
/// Width of a cell below which the proof is given up, rad.
const NARROW: f64 = 1e-13;
/// Largest numbers of cells and arcs of one proof: some seconds.
const MAX_CELLS: usize = 300_000;
const MAX_ARCS: usize = 10_000_000;
/// Relative difference from which a motion counts as faster: that of the larger set of rates, and rounding.
const FASTER: f64 = 1e-6;

/// A symmetric polytope of rates.
#[derive(Debug)]
pub(super) struct PolytopeProver {
    faces: Faces,
    circles: Vec<Circles>,
}

/// The costates of a great circle that a vertex supports before the turn and another one after it.
struct GreatCircle {
    vertices: [usize; 2],
    axes: [VectorInterval; 2],
}

/// The proof of one turn.
struct Proof<'a> {
    prover: &'a PolytopeProver,
    turn: QuatInterval,
    back: QuatInterval,
    /// The least time to be proved, normalised and rounded up.
    time: f64,
    minima: Vec<Option<NearMinimum<'a>>>,
    cells: usize,
    arcs: usize,
}

impl PolytopeProver {
    /// The rates with `|f . w| <= 1` for all of these vectors, in s/rad; `None` where these are not limited in all
    /// directions, are too many, or are in no general position.
    pub(super) fn new(half_spaces: &[Vector3<f64>]) -> Option<Self> {
        let faces = Faces::around(half_spaces)?;
        let circles = Circles::of(&faces)?;
        Some(Self { faces, circles })
    }

    /// Proves that a turn takes at least a time, s.
    pub(super) fn prove(&self, turn: &Attitude, least_s: f64) -> Result<(), Rejection> {
        if least_s <= 0.0 {
            return Ok(());
        }
        let mut given = turn.xyzw().map(Interval::exactly);
        let length = given[0].length(given[1]).length(given[2]).length(given[3]);
        given = given.map(|x| x / length);
        let angle = angle_of(&given).high;
        let aside = [0.633, 0.424, -0.647].map(Interval::exactly);
        let aside = unit(&aside).ok_or(Rejection::not_proved("no direction to move the turn"))?;
        let moved = Interval::exactly(MOVED * angle);
        let turn = product(&given, &about(&aside, moved));
        let least = Interval::exactly(least_s) * Interval::exactly(self.faces.unit_rad_s);
        let time = (least + Interval::exactly(self.faces.slowest(moved.high))).high;
        let minima = self.faces.facets.iter();
        let mut proof = Proof {
            prover: self,
            back: conjugate(&turn),
            minima: minima.map(|facet| NearMinimum::of(facet, &turn)).collect(),
            turn,
            time,
            cells: 0,
            arcs: 0,
        };
        proof.refute_single_arcs()?;
        let count = self.circles.len();
        for vertices in (0..count).flat_map(|first| (0..count).map(move |last| [first, last])) {
            proof.refute(vertices)?;
        }
        Ok(())
    }
}

impl Proof<'_> {
    /// Refutes the turns at a constant rate in a vertex.
    fn refute_single_arcs(&self) -> Result<(), Rejection> {
        let vector = [self.turn[0], self.turn[1], self.turn[2]];
        for circles in &self.prover.circles {
            let axis = circles.axis();
            let [x, y, z] = cross(&vector, axis);
            if x.length(y).length(z).low > 0.0 {
                continue;
            }
            let angle = least_turn(Interval::angle(dot(&vector, axis), self.turn[3]).twice());
            if (Interval::exactly(angle) / circles.speed).low < self.time {
                return Err(Rejection::not_proved(
                    "a turn at a constant rate is as fast",
                ));
            }
        }
        Ok(())
    }

    /// Refutes all extremals whose first and last costates are supported by two vertices.
    fn refute(&mut self, vertices: [usize; 2]) -> Result<(), Rejection> {
        let [first, last] = vertices.map(|vertex| &self.prover.circles[vertex].vertex);
        let circle = GreatCircle::of(vertices, first, &rotate(&self.turn, last))
            .ok_or(Rejection::not_proved("a vertex turns into another one"))?;
        let part = std::f64::consts::TAU / f64::from(PARTS);
        let parts = (0..PARTS).map(|number| {
            let from = part * f64::from(number);
            // Neighbours overlap by more than rounding.
            (from, from + part * (1.0 + 1e-9))
        });
        let mut open: Vec<(f64, f64)> = parts.collect();
        while let Some((from, to)) = open.pop() {
            self.cells += 1;
            if self.cells > MAX_CELLS || self.arcs > MAX_ARCS {
                return Err(Rejection::not_proved("the proof takes too long"));
            }
            if self.cell_is_refuted(
                &circle,
                Interval {
                    low: from,
                    high: to,
                },
            )? {
                continue;
            }
            let middle = 0.5 * (from + to);
            if to - from < NARROW || middle <= from || middle >= to {
                return Err(Rejection::not_proved(
                    "an extremal may be as fast as the bound, to rounding",
                ));
            }
            open.extend([(from, middle), (middle, to)]);
        }
        Ok(())
    }

    fn cell_is_refuted(
        &mut self,
        circle: &GreatCircle,
        place: Interval,
    ) -> Result<bool, Rejection> {
        let before = circle.at(place);
        let after = rotate(&self.back, &before);
        let [first, last] = circle.vertices;
        let prover = self.prover;
        let all = &prover.circles;
        let supported = |vertex: usize, costate: &VectorInterval| {
            let edges = prover.faces.edges[vertex].iter();
            edges
                .map(|edge| dot(costate, &edge.direction).low)
                .all(|share| share <= 0.0)
        };
        if !supported(first, &before) || !supported(last, &after) {
            return Ok(true);
        }
        let levels = dot(&before, &all[first].vertex).common(dot(&after, &all[last].vertex));
        let Some(level) = levels else {
            return Ok(true);
        };
        let facets = &prover.faces.around[first];
        let near = facets
            .iter()
            .filter_map(|facet| self.minima[*facet].as_ref());
        for minimum in near {
            match minimum.refutes(&before, level, self.time) {
                Nearness::Refuted => return Ok(true),
                Nearness::Open => return Ok(false),
                Nearness::Unknown => {}
            }
        }
        let mut ways = Ways {
            circles: all,
            turn: &self.turn,
            time: self.time,
            level,
            last: (last, all[last].azimuth_of(&after)),
            after,
            steepness: vec![None; all.len()],
            arcs: 0,
            nearest: None,
        };
        let refuted = ways.refuted(&Way::from(first, all[first].azimuth_of(&before)));
        self.arcs += ways.arcs;
        if refuted {
            return Ok(true);
        }
        if let Some((time, missing)) = ways.nearest {
            self.reject_if_faster(time, &missing)?;
        }
        Ok(false)
    }

    /// Rejects the bound if a motion, and what is missing after it at a constant rate, are faster.
    fn reject_if_faster(&self, time: Interval, missing: &QuatInterval) -> Result<(), Rejection> {
        // The rotation vector is `angle / sin(angle / 2)` times the vector part, at most `pi` times.
        let vector = [missing[0], missing[1], missing[2]].map(|x| x * Interval::PI);
        let time = time.high + self.prover.faces.gauge(&vector);
        if time < self.time * (1.0 - FASTER) {
            return Err(Rejection::Faster {
                turn: 0,
                time_s: time / self.prover.faces.unit_rad_s,
            });
        }
        Ok(())
    }
}

impl GreatCircle {
    /// `m . (v - v') = 0`; `None` where the two may be one.
    fn of(vertices: [usize; 2], first: &VectorInterval, last: &VectorInterval) -> Option<Self> {
        let across = unit(&minus(first, last))?;
        let rough = Vector3::from(across.map(Interval::middle));
        let p = unit(&cross(
            &across,
            &of_numbers(&Vector3::ith(rough.iamin(), 1.0)),
        ))?;
        let axes = [p, cross(&across, &p)];
        Some(Self { vertices, axes })
    }

    fn at(&self, place: Interval) -> VectorInterval {
        let (sin, cos) = place.sin_cos();
        let [p, q] = &self.axes;
        [0, 1, 2].map(|i| p[i] * cos + q[i] * sin)
    }
}
