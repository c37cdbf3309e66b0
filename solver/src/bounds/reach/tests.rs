//! Motions that exist are not excluded, and what is far from them is.

use crate::math::random::SplitMix;

mod enclosures;
mod motions;

/// A number between two others.
fn number(random: &mut SplitMix, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.below(1_000_001) as f64 / 1e6)
}
