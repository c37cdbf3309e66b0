//! Problems as JSON.

use serde::Serialize;
use slewplan_solver::model::problem::Problem;
use utoipa::ToSchema;

/// A problem: where, what, what to do.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Finding)]
pub(crate) struct ProblemDocument<'a> {
    pointer: &'a str,
    code: &'static str,
    message: &'a str,
    hint: &'a str,
}

impl<'a> From<&'a Problem> for ProblemDocument<'a> {
    fn from(problem: &'a Problem) -> Self {
        Self {
            pointer: &problem.pointer,
            code: problem.code.into(),
            message: &problem.message,
            hint: &problem.hint,
        }
    }
}

/// All problems of a list.
pub(crate) fn documents(problems: &[Problem]) -> Vec<ProblemDocument<'_>> {
    problems.iter().map(ProblemDocument::from).collect()
}

/// The answer of `validate`.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Validation)]
pub(crate) struct ValidationDocument<'a> {
    valid: bool,
    errors: Vec<ProblemDocument<'a>>,
    warnings: Vec<ProblemDocument<'a>>,
}

impl<'a> ValidationDocument<'a> {
    /// Valid means: no errors.
    pub(crate) fn new(errors: &'a [Problem], warnings: &'a [Problem]) -> Self {
        Self {
            valid: errors.is_empty(),
            errors: documents(errors),
            warnings: documents(warnings),
        }
    }
}
