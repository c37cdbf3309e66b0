//! What is said where no way leads around the cones.

use super::clear_path::{self, PathOutcome, PathProblem};
use crate::model::problem::{Code, Problem};

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

/// Searches a way between two named attitudes, the second of which has a JSON pointer; `None` where
/// there is one.
pub(crate) fn no_way(
    between: &PathProblem<'_>,
    [from, to]: [&str; 2],
    pointer: impl Into<String>,
) -> Option<NoWay> {
    if between.cones.is_empty() {
        return None;
    }
    let search = clear_path::find(between);
    let message = match search.outcome {
        PathOutcome::Found(_) => return None,
        PathOutcome::Disconnected => {
            format!("no way leads from {from} to {to} around the cones: this is proved")
        }
        PathOutcome::Unknown {
            resolution,
            closest,
        } => format!(
            "no way from {from} to {to} around the cones was found; one with a clearance of {:.2} \
             degrees would have been, among {} cells. The nearest point that was reached is {:.2} \
             degrees away",
            resolution.to_degrees(),
            search.cells,
            closest.to_degrees(),
        ),
    };
    Some(NoWay {
        is_proved: matches!(search.outcome, PathOutcome::Disconnected),
        problem: Problem::new(pointer, Code::NoClearPath, message, HINT),
    })
}
