//! What cannot be if every part of the program is right.
//!
//! A certified bound holds for every flight. One that was flown faster, beyond what the tolerances of
//! a flight explain, says that a proof is none: then no answer may rest on it. The same of a stored
//! leg that does not fly as it says.

use std::fmt;

/// Relative excess of a bound over a flown time that the tolerances of limits explain.
const TOLERANCE: f64 = 1e-5;
/// Angle, rad, by which flights of the optimiser miss their targets at most.
const MISS: f64 = 1e-8;

/// Something flown that contradicts something claimed, with what is needed to repeat it.
#[derive(Debug, Clone, PartialEq)]
pub enum Contradiction {
    /// A leg was flown in less than its certified bound.
    Leg {
        /// What tells the leg from all others: spacecraft, momentum, turn and conditions.
        identity: String,
        /// The bound, s.
        bound_s: f64,
        /// What the flight takes, s.
        flown_s: f64,
    },
    /// A tour was flown in less than the certified bound of all tours, or a leg of it in less than
    /// its own.
    Tour {
        /// The places in the order in which they were visited.
        route: Vec<String>,
        /// The ends of the leg; `None` for the whole tour.
        leg: Option<[String; 2]>,
        /// The bound, s.
        bound_s: f64,
        /// What the flight takes, s.
        flown_s: f64,
    },
    /// A stored leg does not fly as it says.
    StoredLeg {
        /// What tells the leg from all others.
        identity: String,
        /// What is wrong with its flight.
        faults: Vec<String>,
    },
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Leg {
                identity,
                bound_s,
                flown_s,
            } => write!(
                f,
                "a leg with a certified bound of {bound_s} s was flown in {flown_s} s: {identity}"
            ),
            Self::Tour {
                route,
                leg,
                bound_s,
                flown_s,
            } => {
                let what = leg.as_ref().map_or_else(
                    || "the tour".to_owned(),
                    |[from, to]| format!("the leg from '{from}' to '{to}' of the tour"),
                );
                let route = route.join(", ");
                write!(
                    f,
                    "{what} {route} has a certified bound of {bound_s} s and was flown in \
                     {flown_s} s"
                )
            }
            Self::StoredLeg { identity, faults } => write!(
                f,
                "a stored leg does not fly as it says ({}): {identity}",
                faults.join("; ")
            ),
        }
    }
}

/// What of a bound of a leg, s, the tolerances of its flight may take off: targets are missed by a
/// little, which counts where the turn, rad, is small.
pub(crate) fn slack(bound_s: f64, turn: f64) -> f64 {
    let missed = if turn > MISS { MISS / turn } else { 1.0 };
    bound_s * (TOLERANCE + missed).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_turns_have_more_slack_and_none_has_all() {
        assert!((slack(100.0, 1.0) - 1e-3).abs() < 2e-6);
        assert!(slack(1.0, 1e-6) > 0.01 && slack(1.0, 1e-6) < 0.011);
        assert!((slack(3.0, 0.0) - 3.0).abs() < 1e-15);
    }

    #[test]
    fn all_that_is_needed_to_repeat_it_is_told() {
        let leg = Contradiction::Leg {
            identity: "leg-1;7".into(),
            bound_s: 2.5,
            flown_s: 2.25,
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
            flown_s: 2.25,
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
