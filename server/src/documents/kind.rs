//! Which kind of document was given, where another one is asked for.

use super::document::Node;
use slewplan_solver::model::problem::{Code, Problem};

/// A kind of document that people mistake for another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// What is to be planned.
    Scenario,
    /// An answer to a scenario.
    Plan,
    /// What a single slew is to be.
    SlewRequest,
    /// An answer to it.
    SlewAnswer,
    /// Times of legs.
    LegTable,
    /// The state of a job of the service.
    Job,
}

impl Kind {
    /// The kind of a document, as far as its members tell.
    pub(crate) fn of(document: &Node) -> Option<Self> {
        let has = |name| document.member(name).is_some();
        if has("spacecraft") && has("objective") && !has("targets") {
            Some(Self::SlewRequest)
        } else if has("spacecraft") && (has("targets") || has("start")) {
            Some(Self::Scenario)
        } else if has("spacecraft") {
            None
        } else if has("slews") {
            Some(Self::SlewAnswer)
        } else if has("kind") && has("legs") {
            Some(Self::LegTable)
        } else if has("id") && has("state") {
            Some(Self::Job)
        } else if has("total_time_s") || has("trajectory") || (has("status") && has("reasons")) {
            Some(Self::Plan)
        } else {
            None
        }
    }

    /// The problem of a document that is known to be of another kind.
    pub(crate) fn mismatch(self, document: &Node) -> Option<Problem> {
        let found = Self::of(document).filter(|found| *found != self)?;
        let (this, wanted) = (found.name(), self.name());
        Some(Problem::new(
            "",
            Code::WrongDocument,
            format!("this is {this}, not {wanted}"),
            found.hint(self),
        ))
    }

    fn name(self) -> &'static str {
        match self {
            Self::Scenario => "a scenario",
            Self::Plan => "a plan",
            Self::SlewRequest => "the request of a slew",
            Self::SlewAnswer => "the answer to a slew",
            Self::LegTable => "a table of legs",
            Self::Job => "a job of the service",
        }
    }

    /// What to do with a document of this kind where another is wanted.
    fn hint(self, wanted: Self) -> &'static str {
        match (self, wanted) {
            (Self::Scenario, Self::Plan) => {
                "give what slewplan solve answers to it; where both are asked for, the scenario is first"
            }
            (Self::Plan, Self::Scenario) => {
                "give the scenario that the plan was made of; where both are asked for, it is first"
            }
            (Self::SlewRequest, _) => "slewplan slew and POST /v1/slews take it",
            (Self::Job, Self::Plan) => "GET /v1/plans/{id}/result has its plan",
            (_, Self::Scenario) => "a scenario has spacecraft, start and targets",
            _ => "a plan has total_time_s, sequence, passages and trajectory",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documents::document::parse;

    fn kind(text: &str) -> Option<Kind> {
        Kind::of(&parse(text.as_bytes()).unwrap())
    }

    #[test]
    fn documents_are_known_by_their_members() {
        let cases = [
            (r#"{"spacecraft": {}, "targets": []}"#, Some(Kind::Scenario)),
            (r#"{"spacecraft": {}, "start": {}}"#, Some(Kind::Scenario)),
            (
                r#"{"spacecraft": {}, "objective": {}}"#,
                Some(Kind::SlewRequest),
            ),
            (
                r#"{"status": "optimal", "total_time_s": 1}"#,
                Some(Kind::Plan),
            ),
            (
                r#"{"status": "infeasible", "reasons": []}"#,
                Some(Kind::Plan),
            ),
            (r#"{"kind": "certified", "legs": []}"#, Some(Kind::LegTable)),
            (r#"{"id": "1", "state": "queued"}"#, Some(Kind::Job)),
            (r#"{"slews": []}"#, Some(Kind::SlewAnswer)),
            (r#"{"targets": []}"#, None),
            ("{}", None),
            ("[1]", None),
        ];
        for (text, expected) in cases {
            assert_eq!(kind(text), expected, "{text}");
        }
    }

    #[test]
    fn only_another_known_kind_is_a_mismatch() {
        let plan = parse(br#"{"total_time_s": 1}"#).unwrap();
        assert_eq!(Kind::Plan.mismatch(&plan), None);
        let problem = Kind::Scenario.mismatch(&plan).unwrap();
        assert_eq!(problem.message, "this is a plan, not a scenario");
        assert_eq!(Kind::Scenario.mismatch(&Node::Null), None);
    }
}
