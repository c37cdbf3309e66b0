//! Reproducible random numbers.

use std::f64::consts::TAU;

/// A small generator of reproducible numbers (Steele, Lea and Flood 2014).
#[derive(Debug, Clone)]
pub(crate) struct SplitMix(u64);

impl SplitMix {
    /// A generator whose numbers follow from the seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The generator of one member of a family; its numbers are independent of those of other
    /// members.
    pub(crate) fn member(family: u64, member: u64) -> Self {
        Self::new(Self::new(Self::new(family).draw().wrapping_add(member)).draw())
    }

    /// An independent generator; its draws do not advance this one.
    pub(crate) fn split(&mut self) -> Self {
        Self::new(self.draw())
    }

    /// The next number.
    pub(crate) fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An index below a count that is not zero.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.draw() % count as u64).unwrap_or(0)
    }

    /// A number of the normal distribution with mean zero and variance one (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        // Above zero, so that the logarithm is finite.
        let first = ((self.draw() >> 11) + 1) as f64 / (1_u64 << 53) as f64;
        let second = (self.draw() >> 11) as f64 / (1_u64 << 53) as f64;
        (-2.0 * first.ln()).sqrt() * (TAU * second).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_the_moments_of_their_distribution() {
        let mut random = SplitMix::new(7);
        let numbers: Vec<f64> = (0..100_000).map(|_| random.normal()).collect();
        let moment =
            |power| numbers.iter().map(|x| x.powi(power)).sum::<f64>() / numbers.len() as f64;
        // Five standard errors each.
        assert!(moment(1).abs() < 0.016, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 0.023, "{}", moment(2));
        assert!((moment(4) - 3.0).abs() < 0.16, "{}", moment(4));
    }

    #[test]
    fn members_of_a_family_do_not_repeat_each_other() {
        let first = |family, member| SplitMix::member(family, member).draw();
        let mut seen: Vec<u64> = (0..100)
            .flat_map(|family| (0..100).map(move |member| first(family, member)))
            .collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 10_000);
    }
}
