//! Contradictions between solutions and proofs, which only a defect of the program can cause.
//!
//! A certified bound holds for every motion within the tolerances of the checker. A solution that is
//! faster refutes the proof: then no answer may rest on it. A stored leg that does not meet its
//! conditions when it is propagated is a contradiction too.

use crate::model::tolerances::TIME_TOLERANCE;
use std::fmt;

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

/// Whether a solution is faster than its bound by more than the rounding of times.
pub(crate) fn refutes(duration_s: f64, bound_s: f64) -> bool {
    bound_s > duration_s * (1.0 + TIME_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_as_fast_as_their_bounds_do_not_refute_them() {
        assert!(!refutes(100.0, 100.0) && !refutes(100.0, 100.0 * (1.0 + 1e-12)));
        assert!(refutes(100.0, 100.0 * (1.0 + 1e-8)) && refutes(0.0, 1e-3));
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
