//! Paths over attitudes that keep boresights out of cones.
//!
//! Pure geometry: where a local method finds no way around the cones, a path from here is a starting
//! guess, or the reason why there is none.
//!
//! # Method
//!
//! Attitudes are points of the sphere of quaternions; with cones of one boresight only, whose roll
//! about itself is then free, its direction on the ordinary sphere is all that counts. Either sphere
//! is divided into the [cells](lattice) of a blown-up cube. The clearance of a point, the least angle
//! of a boresight to the surface of one of its cones, changes by no more than the angle of rotation.
//! So a cell of radius `r` is free all over if its centre has the clearance `r`, and blocked all over
//! if its centre is `r` deep in one cone. The cells between are divided when a search gets to them
//! (approximate cell decomposition: Zhu and Latombe 1991). Along an arc of constant rotation axis the
//! cosine of the angle to a cone's axis is a constant plus a sinusoid of the angle of rotation, so
//! that its deepest point is known in closed form.
//!
//! At every level, from coarse to fine, there are two searches:
//!
//! 1. Through all cells that are not blocked. Every path lies in such cells; if they do not connect
//!    the ends, it is *proved* that there is none. It begins at the goal, in case that is locked in.
//! 2. From centre to centre of cells through the middle of the side that they share, where these
//!    arcs are clear.
//!
//! # Complete at a resolution
//!
//! Let `r` bound the radius of the undivided cells that are not free. If there is a path all of whose
//! points have the clearance `r`, its ends included, the second search finds one. For that path
//! passes from cell to cell through points `p` of the sides that they share. The ball of radius `r`
//! around `p` is clear, and a ball of less than a quarter turn holds the arc between any two of its
//! points. It holds the middle of the side and, of a cell of radius up to `r`, the centre; of a free
//! cell the ball around its own centre holds the arc from the centre to the middle of the side.
//! The same balls around the ends of the path connect them with the centres of their cells.
//! The arcs of the second search that skip cells only shorten what it finds. An end with less
//! clearance first [retreats](retreat) to where it has that much, or to a local
//! maximum.
//!
//! Cells are limited in number, and with them memory and time; the resolution that the answer states
//! is that of the last level whose searches were not cut short.

mod lattice;
mod retreat;
mod roll;
mod search;
mod shorten;
mod space;
mod sphere;
#[cfg(test)]
mod tests;
mod tree;

use crate::math::quaternion::Quat;
use crate::model::attitude::Attitude;
use crate::model::cone::ForbiddenCone;
use nalgebra::Vector3;
use search::{Connection, Limits, connect, is_disconnected};
use shorten::Path;
use space::{Attitudes, Directions, Forbidden, Linear, Quadratic, Space};
use std::f64::consts::PI;

/// How deep in a cone, rad, the given ends may be.
const END_TOLERANCE: f64 = 1e-6;
/// Difference of unit vectors below which boresights are the same.
const SAME_AXIS: f64 = 1e-12;
/// Searches for a boresight's direction.
const DIRECTION_LIMITS: Limits = Limits {
    coarsest: 3,
    finest: 11,
    compared: 0,
    cells: 100_000,
};
/// Searches that only have to prove that one boresight cannot pass.
const PROOF_LIMITS: Limits = Limits {
    coarsest: 2,
    finest: 9,
    compared: 0,
    cells: 30_000,
};
/// Searches over attitudes.
const ATTITUDE_LIMITS: Limits = Limits {
    coarsest: 3,
    finest: 8,
    compared: 5,
    cells: 100_000,
};
/// Searches over attitudes beside that for a boresight's direction.
const COARSE_LIMITS: Limits = Limits {
    coarsest: 3,
    finest: 5,
    compared: 5,
    cells: 20_000,
};

/// The ends of a path and what it has to keep clear of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathProblem<'a> {
    /// Forbidden cones.
    pub(crate) cones: &'a [ForbiddenCone],
    /// Where it begins; at most 1e-6 rad deep in any cone.
    pub(crate) from: Attitude,
    /// Where it ends; likewise.
    pub(crate) to: Attitude,
    /// Whether only the given sign of the last quaternion counts as arrived.
    pub(crate) signed: bool,
}

/// What a search for a path found.
#[derive(Debug, Clone)]
pub(crate) enum PathOutcome {
    /// Attitudes in steps of at most three degrees, both ends included, with continuous signs. All arcs
    /// between them are clear, as far as the ends are.
    Found(Vec<Attitude>),
    /// It is proved that there is no path.
    Disconnected,
    /// Not found.
    Unknown {
        /// A path with this clearance everywhere would have been found, rad.
        resolution: f64,
        /// Least angle of rotation, or of the boresight where there is but one, from what was
        /// reached to the goal, rad.
        closest: f64,
    },
}

/// The outcome of a search, and its size.
#[derive(Debug, Clone)]
pub(crate) struct PathSearch {
    /// What it found.
    pub(crate) outcome: PathOutcome,
    /// Cells that it looked at.
    pub(crate) cells: usize,
}

/// Least clearance, rad, of the arcs between attitudes; negative inside a cone.
pub(crate) fn least_clearance(cones: &[ForbiddenCone], path: &[Attitude]) -> f64 {
    let space = attitudes(cones, false);
    let arcs = path.windows(2);
    let clearances = arcs.map(|ends| space.arc_clearance(&ends[0].xyzw(), &ends[1].xyzw()));
    clearances.fold(PI, f64::min)
}

/// Searches a path.
pub(crate) fn find(problem: &PathProblem<'_>) -> PathSearch {
    let Some(cones) = within_reach(problem) else {
        return not_found(PathOutcome::Disconnected, 0);
    };
    let attitudes = attitudes(&cones, !problem.signed);
    let [from, to] = [problem.from, problem.to].map(|end| end.xyzw());
    if attitudes.is_clear(&from, &to) {
        return found(&Path::through(&attitudes, &[from, to]), 0);
    }
    let boresights = boresights(&cones);
    if let [boresight] = boresights[..] {
        return roll_free(&cones, &boresight, problem, &attitudes);
    }
    let mut spent = 0;
    for boresight in &boresights {
        let (space, ends) = directions(&cones, boresight, problem);
        let (disconnected, cells) = is_disconnected(&space, [&ends[0], &ends[1]], PROOF_LIMITS);
        spent += cells;
        if disconnected {
            return not_found(PathOutcome::Disconnected, spent);
        }
    }
    let (connection, cells) = connect(&attitudes, [&from, &to], ATTITUDE_LIMITS);
    let paths = match paths(connection) {
        Ok(paths) => paths,
        Err(outcome) => return not_found(outcome, spent + cells),
    };
    shortest(&attitudes, &paths, spent + cells)
}

/// The search where only the direction of one boresight counts: a path of directions decides whether
/// there is one. As its roll is not thought of then, a coarse search over attitudes may find a
/// shorter one.
fn roll_free(
    cones: &[ForbiddenCone],
    boresight: &Vector3<f64>,
    problem: &PathProblem<'_>,
    attitudes: &Attitudes,
) -> PathSearch {
    let (space, ends) = directions(cones, boresight, problem);
    let (connection, cells) = connect(&space, [&ends[0], &ends[1]], DIRECTION_LIMITS);
    let ways = match paths(connection) {
        Ok(ways) => ways,
        Err(outcome) => return not_found(outcome, cells),
    };
    let [from, to] = [problem.from, problem.to].map(|end| end.xyzw());
    let lifted = ways.iter().map(|way| {
        let mut way = Path::through(&space, way);
        way.pull_tight();
        roll::lifted(attitudes, boresight, [&from, &to], &way.points)
    });
    let mut all: Vec<_> = lifted.collect();
    let (connection, more) = connect(attitudes, [&from, &to], COARSE_LIMITS);
    all.extend(paths(connection).unwrap_or_default());
    shortest(attitudes, &all, cells + more)
}

/// The paths of a connection, or the outcome where there are none.
fn paths<const D: usize>(connection: Connection<D>) -> Result<Vec<Vec<[f64; D]>>, PathOutcome> {
    match connection {
        Connection::Paths(paths) => Ok(paths),
        Connection::Disconnected => Err(PathOutcome::Disconnected),
        Connection::Unknown {
            resolution,
            closest,
        } => Err(PathOutcome::Unknown {
            resolution,
            closest,
        }),
    }
}

/// The shortest of some paths when all are pulled tight.
fn shortest(space: &Attitudes, paths: &[Vec<Quat>], cells: usize) -> PathSearch {
    let tight = paths.iter().map(|points| pulled_tight(space, points));
    let shortest = tight.min_by(|a, b| a.turn().total_cmp(&b.turn()));
    match shortest {
        Some(path) => found(&path, cells),
        // A connection has at least one path; without it nothing would be known.
        None => not_found(
            PathOutcome::Unknown {
                resolution: PI,
                closest: PI,
            },
            cells,
        ),
    }
}

fn not_found(outcome: PathOutcome, cells: usize) -> PathSearch {
    PathSearch { outcome, cells }
}

fn found(path: &Path<'_, 4, Quadratic>, cells: usize) -> PathSearch {
    let attitudes = path.points.iter().copied();
    PathSearch {
        outcome: PathOutcome::Found(attitudes.filter_map(Attitude::from_xyzw).collect()),
        cells,
    }
}

/// A short path like the one through some points whose arcs are clear.
fn pulled_tight<'a>(space: &'a Attitudes, points: &[Quat]) -> Path<'a, 4, Quadratic> {
    let mut path = Path::through(space, points);
    path.pull_tight();
    path.make_room();
    // Points that were moved apart may be farther than a step.
    Path::through(space, &path.points)
}

/// The cones, smaller by what the ends are inside of them; `None` where that is too much.
fn within_reach(problem: &PathProblem<'_>) -> Option<Vec<ForbiddenCone>> {
    let reduced = problem.cones.iter().map(|cone| {
        let ends = [&problem.from, &problem.to].map(|end| cone.depth(end));
        let inside = ends[0].max(ends[1]).max(0.0);
        (inside <= END_TOLERANCE).then_some(ForbiddenCone {
            half_angle: cone.half_angle - inside,
            ..*cone
        })
    });
    reduced.collect()
}

/// All attitudes; `projective` where either sign of a quaternion is the same.
fn attitudes(cones: &[ForbiddenCone], projective: bool) -> Attitudes {
    let cones = cones.iter().map(|cone| {
        let cosine = Quadratic::new(&cone.axis, &cone.direction);
        Forbidden::new(cosine, cone.half_angle)
    });
    Space {
        cones: cones.collect(),
        projective,
    }
}

/// The boresights, opposite ones counted once.
fn boresights(cones: &[ForbiddenCone]) -> Vec<Vector3<f64>> {
    let mut found: Vec<Vector3<f64>> = Vec::new();
    for cone in cones {
        if !found.iter().any(|known| sense(known, &cone.axis).is_some()) {
            found.push(cone.axis);
        }
    }
    found
}

/// Whether two boresights are the same (1) or opposite (-1).
fn sense(a: &Vector3<f64>, b: &Vector3<f64>) -> Option<f64> {
    let same = |sign: f64| (a - b * sign).norm() < SAME_AXIS;
    [1.0, -1.0].into_iter().find(|sign| same(*sign))
}

/// The directions of a boresight with those cones that it has to stay out of, and where it begins
/// and ends.
fn directions(
    cones: &[ForbiddenCone],
    boresight: &Vector3<f64>,
    problem: &PathProblem<'_>,
) -> (Directions, [[f64; 3]; 2]) {
    let cones = cones.iter().filter_map(|cone| {
        let sense = sense(boresight, &cone.axis)?;
        let axis = cone.direction * sense;
        Some(Forbidden::new(Linear(axis.into()), cone.half_angle))
    });
    let space = Space {
        cones: cones.collect(),
        projective: false,
    };
    let ends = [problem.from, problem.to].map(|end| end.to_reference(*boresight).into());
    (space, ends)
}
