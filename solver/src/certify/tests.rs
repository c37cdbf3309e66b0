mod claims;
mod enclosures;

use super::*;
