//! Starting rolls of motions through several waypoints.
//!
//! The shortest path over the grids of all rolls, by the estimate of the slews between them, is one start.
//! Others are the shortest paths through the local minima of what a path through a roll takes at least,
//! the sums of a dynamic program forth and of one back, and those at which one roll of the best path is
//! another local minimum.

use super::grid::Grid;
use crate::leg::solve::extremal::KinematicExtremals;
use crate::model::dynamics::Dynamics;
use crate::model::waypoint::Waypoint;
use std::ops::Range;

/// Ratio of the estimate of a path to the least one up to which it is a start, and the number of those of
/// which better estimates are made.
const PROMISING: f64 = 1.15;
const MAX_COMPARED: usize = 16;

/// An estimate of its duration, s, and the numbers of its rolls.
type Path = (f64, Vec<usize>);

/// The waypoints of a route, described from the rolls of its starts, the most promising ones first and
/// so many at most.
pub(crate) fn rolled_routes(
    dynamics: &Dynamics,
    extremals: &KinematicExtremals,
    route: Vec<Waypoint>,
    most: usize,
) -> Vec<Vec<Waypoint>> {
    if route.iter().all(|waypoint| waypoint.roll.is_none()) {
        return vec![route];
    }
    let grids: Vec<Grid> = route.iter().map(Grid::of).collect();
    let mut paths = Paths::new(&grids, dynamics).promising();
    if most > 1 {
        let comparison = Comparison {
            grids: &grids,
            extremals,
        };
        paths = comparison.sorted(paths);
    }
    let waypoints = |path: &Vec<usize>| {
        let rolled = path.iter().zip(&grids);
        rolled
            .map(|(roll, grid)| grid.waypoints[*roll].clone())
            .collect()
    };
    let chosen = paths.iter().take(most);
    chosen.map(|(_, path)| waypoints(path)).collect()
}

/// Compares paths by the kinematic extremals of their legs, an estimate that is better and slower.
struct Comparison<'g> {
    grids: &'g [Grid],
    extremals: &'g KinematicExtremals,
}

impl Comparison<'_> {
    /// Paths and those beside the best of them, the shortest ones first.
    fn sorted(&self, paths: Vec<Path>) -> Vec<Path> {
        let by_duration = |(one, _): &Path, (other, _): &Path| one.total_cmp(other);
        let paths = paths.into_iter();
        let mut paths: Vec<Path> = paths
            .map(|(_, path)| (self.duration_s(&path, 0..path.len()), path))
            .collect();
        paths.sort_by(by_duration);
        for path in paths
            .first()
            .map_or(Vec::new(), |(_, best)| self.beside(best))
        {
            if paths.iter().all(|(_, known)| *known != path) {
                paths.push((self.duration_s(&path, 0..path.len()), path));
            }
        }
        paths.sort_by(by_duration);
        let most = PROMISING * paths.first().map_or(0.0, |(least, _)| *least);
        paths.retain(|(estimate, _)| *estimate <= most);
        paths
    }

    /// The paths that differ from one in the roll of one waypoint, which is a local minimum.
    fn beside(&self, path: &[usize]) -> Vec<Vec<usize>> {
        let mut found = Vec::new();
        for (at, grid) in self.grids.iter().enumerate() {
            let with = |roll: usize| {
                let mut path = path.to_vec();
                path[at] = roll;
                path
            };
            let around = at.saturating_sub(1)..(at + 2).min(path.len());
            let rolls = 0..grid.waypoints.len();
            let durations: Vec<f64> = rolls
                .clone()
                .map(|roll| self.duration_s(&with(roll), around.clone()))
                .collect();
            let minima = rolls.filter(|roll| {
                let mut beside = grid.around(*roll);
                beside.all(|beside| durations[*roll] <= durations[beside])
            });
            found.extend(minima.map(with));
        }
        found
    }

    /// Duration, s, of the legs between some waypoints of a path.
    fn duration_s(&self, path: &[usize], waypoints: Range<usize>) -> f64 {
        let attitude = |i: usize| &self.grids[i].waypoints[path[i]].attitude;
        let legs = waypoints
            .skip(1)
            .map(|i| attitude(i - 1).turn_to(attitude(i)));
        // Extremals are missing where there is no turn, or rates are too different to list them.
        legs.map(|turn| self.extremals.duration_s(&turn).unwrap_or(0.0))
            .sum()
    }
}

/// Shortest paths over grids of rolls.
struct Paths<'g> {
    grids: &'g [Grid],
    /// For every roll of every grid the least time, s, of paths from the first grid, and the roll before.
    forth: Vec<Vec<(f64, usize)>>,
    /// The same to the last grid, and the roll after.
    back: Vec<Vec<(f64, usize)>>,
}

impl<'g> Paths<'g> {
    fn new(grids: &'g [Grid], dynamics: &Dynamics) -> Self {
        let tables = grids
            .windows(2)
            .map(|pair| pair[0].durations_to(&pair[1], dynamics));
        let tables: Vec<Vec<Vec<f64>>> = tables.collect();
        let least = |sums: &mut dyn Iterator<Item = f64>| {
            let least = sums.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b));
            least.map_or((f64::INFINITY, 0), |(roll, sum)| (sum, roll))
        };
        let none = |grid: &Grid| vec![(0.0, 0); grid.waypoints.len()];
        let mut forth: Vec<Vec<(f64, usize)>> = grids.iter().map(none).collect();
        let mut back = forth.clone();
        for i in 1..grids.len() {
            let reached = |to: usize| {
                let from = forth[i - 1].iter().zip(&tables[i - 1]);
                least(&mut from.map(|((sum, _), row)| sum + row[to]))
            };
            forth[i] = (0..grids[i].waypoints.len()).map(reached).collect();
            let at = grids.len() - 1 - i;
            let left = |from: usize| {
                let to = back[at + 1].iter().zip(&tables[at][from]);
                least(&mut to.map(|((sum, _), leg)| sum + leg))
            };
            back[at] = (0..grids[at].waypoints.len()).map(left).collect();
        }
        Self { grids, forth, back }
    }

    /// Estimates, s, and rolls of the paths through local minima, the shortest ones first.
    fn promising(&self) -> Vec<Path> {
        let mut paths: Vec<Path> = Vec::new();
        for (i, grid) in self.grids.iter().enumerate() {
            let through = |roll: usize| self.forth[i][roll].0 + self.back[i][roll].0;
            for roll in 0..grid.waypoints.len() {
                let own = through(roll);
                if grid.around(roll).all(|beside| own <= through(beside)) {
                    paths.push((own, self.path(i, roll)));
                }
            }
        }
        paths.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let most = PROMISING * paths.first().map_or(0.0, |(least, _)| *least);
        let mut promising: Vec<Path> = Vec::new();
        for (estimate, path) in paths {
            let is_new = promising.iter().all(|(_, known)| *known != path);
            if estimate <= most && is_new && promising.len() < MAX_COMPARED {
                promising.push((estimate, path));
            }
        }
        promising
    }

    /// The rolls of the shortest path through one of them.
    fn path(&self, at: usize, roll: usize) -> Vec<usize> {
        let mut path = vec![roll; self.grids.len()];
        for i in (0..at).rev() {
            path[i] = self.forth[i + 1][path[i + 1]].1;
        }
        for i in at + 1..path.len() {
            path[i] = self.back[i - 1][path[i - 1]].1;
        }
        path
    }
}
