//! Contradictions between solutions and proofs, which only a defect of the program can cause.
//!
//! A certified bound holds for every motion. A solution that is faster by more than its tolerances
//! allow refutes the proof: then no answer may rest on it. A stored leg that does not meet its
//! conditions when it is propagated is a contradiction too.

use std::fmt;

/// Relative excess of a bound over a duration that the tolerances of limits allow.
const TOLERANCE: f64 = 1e-5;
/// Largest angle, rad, by which solutions of the optimiser miss their targets.
const MISS: f64 = 1e-8;

/// A contradiction, with what is needed to reproduce it.
#[derive(Debug, Clone, PartialEq)]
pub enum Contradiction {
    /// A leg takes less than its certified bound.
    Leg {
        /// Identity of the leg: spacecraft, momentum, turn and conditions.
        identity: String,
        /// The bound, s.
        bound_s: f64,
        /// The duration of the solution, s.
        duration_s: f64,
    },
    /// A tour takes less than the certified bound of all tours, or a leg of it less than its own.
    Tour {
        /// The places in the order in which they were visited.
        route: Vec<String>,
        /// The ends of the leg; `None` for the whole tour.
        leg: Option<[String; 2]>,
        /// The bound, s.
        bound_s: f64,
        /// The duration of the solution, s.
        duration_s: f64,
    },
    /// A stored leg does not meet its conditions when it is propagated.
    StoredLeg {
        /// Identity of the leg.
        identity: String,
        /// The conditions that it does not meet.
        faults: Vec<String>,
    },
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Leg {
                identity,
                bound_s,
                duration_s,
            } => write!(
                f,
                "a leg with a certified bound of {bound_s} s takes {duration_s} s: {identity}"
            ),
            Self::Tour {
                route,
                leg,
                bound_s,
                duration_s,
            } => {
                let what = leg.as_ref().map_or_else(
                    || "the tour".to_owned(),
                    |[from, to]| format!("the leg from '{from}' to '{to}' of the tour"),
                );
                let route = route.join(", ");
                write!(
                    f,
                    "{what} {route} has a certified bound of {bound_s} s and takes {duration_s} s"
                )
            }
            Self::StoredLeg { identity, faults } => write!(
                f,
                "a stored leg does not meet its conditions ({}): {identity}",
                faults.join("; ")
            ),
        }
    }
}

/// By how much a leg may undercut its bound, s, within the tolerances. Targets are missed by a
/// small angle, which matters where the turn, rad, is small.
pub(crate) fn slack(bound_s: f64, turn: f64) -> f64 {
    let missed = if turn > MISS { MISS / turn } else { 1.0 };
    bound_s * (TOLERANCE + missed).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smaller_turns_have_more_slack_but_never_more_than_the_bound() {
        assert!((slack(100.0, 1.0) - 1e-3).abs() < 2e-6);
        assert!(slack(1.0, 1e-6) > 0.01 && slack(1.0, 1e-6) < 0.011);
        assert!((slack(3.0, 0.0) - 3.0).abs() < 1e-15);
    }

    #[test]
    fn messages_contain_what_is_needed_to_reproduce() {
        let leg = Contradiction::Leg {
            identity: "leg-1;7".into(),
            bound_s: 2.5,
            duration_s: 2.25,
        };
        let text = leg.to_string();
        assert!(
            ["leg-1;7", "2.5", "2.25"]
                .iter()
                .all(|part| text.contains(part)),
            "{text}"
        );
        let tour = Contradiction::Tour {
            route: vec!["start".into(), "b".into(), "a".into()],
            leg: Some(["start".into(), "b".into()]),
            bound_s: 2.5,
            duration_s: 2.25,
        };
        let text = tour.to_string();
        assert!(
            ["start, b, a", "'start' to 'b'"]
                .iter()
                .all(|part| text.contains(part)),
            "{text}"
        );
        let stored = Contradiction::StoredLeg {
            identity: "leg-1;8".into(),
            faults: vec!["late".into(), "fast".into()],
        };
        let text = stored.to_string();
        assert!(
            ["leg-1;8", "late; fast"]
                .iter()
                .all(|part| text.contains(part)),
            "{text}"
        );
    }
}
