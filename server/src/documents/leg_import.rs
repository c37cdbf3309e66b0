//! What became of imported legs, as JSON.

use super::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::model::problem::Problem;
use utoipa::ToSchema;

/// What became of the legs of a file.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegImport)]
pub(crate) struct LegImportDocument<'a> {
    /// Legs that are cached now and were not before.
    imported: u64,
    /// Legs that were cached before; they stay as they are.
    known: u64,
    /// Legs that are not taken, each with its place and the reason.
    refused: Vec<ProblemDocument<'a>>,
}

impl<'a> LegImportDocument<'a> {
    /// How many legs were new and known, and why others are not taken.
    pub(crate) fn new([imported, known]: [u64; 2], refused: &'a [Problem]) -> Self {
        Self {
            imported,
            known,
            refused: documents(refused),
        }
    }
}
