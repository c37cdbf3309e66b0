mod claims;
mod enclosures;
mod words;

use super::*;
