//! The answer of a verification.

use super::plan::{MarginsDocument, VerificationDocument};
use super::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::model::plan::{Margins, Verification};
use slewplan_solver::model::problem::Problem;
use utoipa::ToSchema;

/// What flying a plan again showed.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = VerificationReport)]
pub(crate) struct ReportDocument<'a> {
    #[serde(flatten)]
    verification: VerificationDocument<'a>,
    margins: MarginsDocument,
    warnings: Vec<ProblemDocument<'a>>,
}

impl<'a> ReportDocument<'a> {
    /// Errors, margins and warnings of a flight.
    pub(crate) fn new(
        verification: &'a Verification,
        margins: &Margins,
        warnings: &'a [Problem],
    ) -> Self {
        Self {
            verification: verification.into(),
            margins: margins.into(),
            warnings: documents(warnings),
        }
    }
}
