//! What is said where no way leads around the cones.

use super::clear_path::{self, PathOutcome, PathProblem, PathSearch};
use super::solve::arrival::Arrival;
use crate::model::cone::ForbiddenCone;
use crate::model::problem::{Code, Problem};
use crate::model::waypoint::Waypoint;

const HINT: &str =
    "narrow the cones, move the attitude, or put a target where the way leads around";

/// The end of a search that found no way.
#[derive(Debug, Clone)]
pub(crate) struct NoWay {
    /// Whether it is proved that there is none.
    pub(crate) is_proved: bool,
    /// What was searched, and how close it came.
    pub(crate) problem: Problem,
}

impl NoWay {
    /// The stable text of the status of a slew without a way.
    pub(crate) fn status(&self) -> &'static str {
        if self.is_proved {
            "infeasible"
        } else {
            Code::NoClearPath.into()
        }
    }
}

/// Two waypoints between which cones may leave no way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WayProblem<'a> {
    /// Forbidden cones.
    pub(crate) cones: &'a [ForbiddenCone],
    /// Where it begins and where it ends.
    pub(crate) ends: [&'a Waypoint; 2],
    /// Which quaternion signs count as arrived.
    pub(crate) arrival: Arrival,
}

impl WayProblem<'_> {
    /// The searches between the attitudes of both ends, one of each arc of their rolls: along an arc
    /// nothing is in a cone, so that a way from one of its rolls is a way from all. They end with the
    /// first way; `None` where there is one.
    fn searches(&self) -> Option<Vec<PathSearch>> {
        let [begins, arrivals] = self.ends.map(Waypoint::attitude_of_each_arc);
        let mut without = Vec::new();
        for (from, to) in begins
            .iter()
            .flat_map(|from| arrivals.iter().map(move |to| (from, to)))
        {
            let search = clear_path::find(&PathProblem {
                cones: self.cones,
                from: *from,
                to: *to,
                signed: self.arrival == Arrival::Quaternion,
            });
            if matches!(search.outcome, PathOutcome::Found(_)) {
                return None;
            }
            without.push(search);
        }
        Some(without)
    }
}

/// Searches a way between two named waypoints, the second of which has a JSON pointer; `None` where
/// there is one.
pub(crate) fn no_way(
    between: &WayProblem<'_>,
    [from, to]: [&str; 2],
    pointer: impl Into<String>,
) -> Option<NoWay> {
    if between.cones.is_empty() {
        return None;
    }
    let searches = between.searches()?;
    let unknown = searches.iter().find_map(|search| match search.outcome {
        PathOutcome::Unknown {
            resolution,
            closest,
        } => Some((search.cells, resolution, closest)),
        PathOutcome::Found(_) | PathOutcome::Disconnected => None,
    });
    let message = match unknown {
        None => format!("no way leads from {from} to {to} around the cones: this is proved"),
        Some((cells, resolution, closest)) => format!(
            "no way from {from} to {to} around the cones was found; one with a clearance of {:.2} \
             degrees would have been, among {cells} cells. The nearest point that was reached is \
             {:.2} degrees away",
            resolution.to_degrees(),
            closest.to_degrees(),
        ),
    };
    Some(NoWay {
        is_proved: unknown.is_none(),
        problem: Problem::new(pointer, Code::NoClearPath, message, HINT),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::attitude::Attitude;
    use crate::model::roll::RollArcs;
    use crate::model::scenario::RateCondition;
    use crate::model::waypoint::WheelCondition;
    use nalgebra::Vector3;
    use std::f64::consts::{PI, TAU};

    fn at(attitude: Attitude, roll: Option<RollArcs>) -> Waypoint {
        Waypoint {
            attitude,
            roll,
            rate: [RateCondition::Fixed(0.0); 3],
            wheels: WheelCondition::Free,
            costates: None,
        }
    }

    /// Cones in a closed ring around body x as the identity attitude points it.
    fn ring() -> Vec<ForbiddenCone> {
        let around = (0..12).map(|i| TAU * f64::from(i) / 12.0);
        let cone = |angle: f64| ForbiddenCone {
            axis: Vector3::x(),
            direction: Vector3::new(
                0.7_f64.cos(),
                0.7_f64.sin() * angle.cos(),
                0.7_f64.sin() * angle.sin(),
            ),
            half_angle: 0.3,
        };
        around.map(cone).collect()
    }

    #[test]
    fn a_way_from_any_arc_of_the_rolls_is_a_way() {
        let cones = ring();
        let away = at(Attitude::from_rotation_vector(Vector3::z() * PI), None);
        let parted = |roll: Option<RollArcs>| {
            let to = at(Attitude::identity(), roll);
            let between = WayProblem {
                cones: &cones,
                ends: [&away, &to],
                arrival: Arrival::Rotation,
            };
            no_way(&between, ["away", "there"], "/end")
        };
        // Body z stays where it is, and body x is within the ring or beyond it.
        let (within, beyond) = ([-0.3, 0.3], [1.2, TAU - 1.2]);
        let rolls = |arcs: &[[f64; 2]]| {
            Some(RollArcs {
                axis: Vector3::z(),
                arcs: arcs.to_vec(),
            })
        };
        let closed = parted(rolls(&[within])).expect("the ring is closed");
        assert!(closed.is_proved && parted(None).is_some_and(|there| there.is_proved));
        assert!(parted(rolls(&[within, beyond])).is_none());
        assert!(parted(rolls(&[beyond])).is_none());
    }
}
