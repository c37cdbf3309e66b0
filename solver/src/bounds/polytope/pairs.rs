//! Where the costates at the two ends of a turn lie on one level.
//!
//! A turn `R` takes the costate `m` at its beginning to `R^T m` at its end. Where `v` supports the first and
//! `v'` the second, both are on one level if `m . (v - R v') = 0`: on a great circle. It is cut where `v` or
//! `v'` cease to support, where its level is critical, at its highest level, and at the axis of the turn,
//! where both costates are one. On each part the way between the costates passes the same walls.

use super::flow::{OnCircle, nearest};
use super::level_curves::{LevelCurves, Wall};
use nalgebra::{Matrix3, Unit, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Parts of a great circle shorter than this, rad, are none.
const NO_PART: f64 = 1e-12;
/// Difference of a vertex and a turned one below which they are one: no great circle belongs to them.
const NO_CIRCLE: f64 = 1e-14;

/// Costates `p cos t + q sin t` that a vertex supports before a turn and another one after it.
#[derive(Debug, Clone)]
pub(super) struct LevelPair {
    pub(super) vertices: [usize; 2],
    p: Vector3<f64>,
    q: Vector3<f64>,
}

/// A costate before and after the turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct CostatePair {
    pub(super) ends: [OnCircle; 2],
    pub(super) level: f64,
    /// The costate after the turn.
    pub(super) after: Vector3<f64>,
}

/// A pair with its parts.
#[derive(Debug)]
pub(super) struct Parts {
    pub(super) pair: LevelPair,
    /// Ranges of `t` without a cut within.
    pub(super) ranges: Vec<[f64; 2]>,
    /// Where its level is that of a saddle, with the level.
    pub(super) saddles: Vec<(f64, f64)>,
}

impl LevelPair {
    /// The costates at a place of the great circle; `back` is the inverse of the turn.
    pub(super) fn at(&self, t: f64, curves: &LevelCurves, back: &Matrix3<f64>) -> CostatePair {
        let before = self.p * t.cos() + self.q * t.sin();
        let after = back * before;
        let [first, last] = self.vertices;
        let on = |vertex: usize, costate: &Vector3<f64>| OnCircle {
            vertex,
            azimuth: curves.circles[vertex].azimuth_of(costate),
        };
        CostatePair {
            ends: [on(first, &before), on(last, &after)],
            level: before.dot(&curves.circles[first].vertex),
            after,
        }
    }

    /// The costates that two vertices support before and after a turn; `None` where there are none.
    pub(super) fn parts(
        curves: &LevelCurves,
        vertices: [usize; 2],
        turn: &UnitQuaternion<f64>,
        axis: &Unit<Vector3<f64>>,
    ) -> Option<Parts> {
        let [first, last] = vertices.map(|vertex| &curves.circles[vertex]);
        let turned = |vector: Vector3<f64>| turn * vector;
        let across = (first.vertex - turned(last.vertex)).try_normalize(NO_CIRCLE)?;
        let p = across.cross(&Vector3::ith(across.iamin(), 1.0)).normalize();
        let q = across.cross(&p);
        let place_of = |vector: &Vector3<f64>| vector.dot(&q).atan2(vector.dot(&p));
        let beyond = |wall: &Wall| curves.circles[wall.to].vertex;
        let before = first.walls.iter().map(|wall| first.vertex - beyond(wall));
        let after = last.walls.iter();
        let after = after.map(|wall| turned(last.vertex - beyond(wall)));
        let mut range: Option<[f64; 2]> = None;
        for side in before.chain(after) {
            // Half of the great circle, and of what is left of it one part at most.
            let middle = place_of(&side);
            let [low, high] = range.map_or([middle - FRAC_PI_2, middle + FRAC_PI_2], |range| {
                let middle = nearest(middle, 0.5 * (range[0] + range[1]));
                [
                    range[0].max(middle - FRAC_PI_2),
                    range[1].min(middle + FRAC_PI_2),
                ]
            });
            if low >= high {
                return None;
            }
            range = Some([low, high]);
        }
        let [low, high] = range?;
        let near = |t: f64| nearest(t, 0.5 * (low + high));
        let highest = first.vertex.dot(&p).hypot(first.vertex.dot(&q));
        let top = near(place_of(&first.vertex));
        let crossed = curves.critical.iter();
        let crossed = crossed.filter(|critical| critical.level < highest);
        let within = |t: &f64| *t > low && *t < high;
        let (mut cuts, mut saddles) = (vec![low, high], Vec::new());
        for critical in crossed {
            let half = (critical.level / highest).acos();
            for t in [top - half, top + half]
                .map(near)
                .into_iter()
                .filter(within)
            {
                cuts.push(t);
                saddles.extend(critical.has_saddle.then_some((t, critical.level)));
            }
        }
        let at_axis = near(place_of(axis));
        cuts.extend(
            [top, at_axis, near(at_axis + PI)]
                .into_iter()
                .filter(within),
        );
        cuts.sort_by(f64::total_cmp);
        let ranges = cuts.windows(2).map(|cut| [cut[0], cut[1]]);
        let ranges = ranges.filter(|[from, to]| to - from > NO_PART).collect();
        Some(Parts {
            pair: Self { vertices, p, q },
            ranges,
            saddles,
        })
    }
}
