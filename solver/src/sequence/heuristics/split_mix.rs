//! Reproducible random numbers.

/// A small generator of reproducible numbers (Steele, Lea and Flood 2014).
#[derive(Debug, Clone)]
pub(in crate::sequence) struct SplitMix(u64);

impl SplitMix {
    /// A generator whose numbers follow from the seed.
    pub(in crate::sequence) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number.
    pub(in crate::sequence) fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// One of the numbers below a count that is not zero.
    pub(in crate::sequence) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.draw() % count as u64).unwrap_or(0)
    }
}
