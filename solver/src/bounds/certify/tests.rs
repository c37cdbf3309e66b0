mod certificates;
mod enclosures;
mod sequences;

use super::*;
