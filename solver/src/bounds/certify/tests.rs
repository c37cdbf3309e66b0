mod certificates;
mod enclosures;
mod polytopes;
mod sequences;

use super::*;
