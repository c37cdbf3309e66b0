//! Lower bounds in two bytes each.

/// Numbers that are rounded down to the steps of a scale from the least to the greatest of them, so
/// that each is a lower bound of what was given. Both infinities stay; what is not a number is minus
/// infinity.
#[derive(Debug, Default)]
pub(super) struct RoundedDown {
    least: f64,
    step: f64,
    levels: Box<[u16]>,
}

/// Levels that stand for minus infinity, the least number, and infinity; the greatest number is below
/// the latter.
const UNBOUNDED: u16 = 0;
const LEAST: u16 = 1;
const INFINITE: u16 = u16::MAX;
/// Number of steps of a scale.
const STEPS: f64 = (INFINITE - 1 - LEAST) as f64;

impl RoundedDown {
    /// Memory of a number, bytes.
    pub(super) const BYTES: u64 = size_of::<u16>() as u64;

    /// Rounds the given numbers.
    pub(super) fn new(values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let least = finite().fold(f64::INFINITY, f64::min);
        let greatest = finite().fold(f64::NEG_INFINITY, f64::max);
        let scale = Self {
            least,
            step: (greatest - least) / STEPS,
            levels: Box::default(),
        };
        let levels = values.iter().map(|&value| scale.level(value)).collect();
        Self { levels, ..scale }
    }

    /// A number, at most as large as the given one.
    pub(super) fn get(&self, index: usize) -> f64 {
        self.value(self.levels[index])
    }

    fn value(&self, level: u16) -> f64 {
        match level {
            UNBOUNDED => f64::NEG_INFINITY,
            INFINITE => f64::INFINITY,
            _ => self.least + f64::from(level - LEAST) * self.step,
        }
    }

    /// The greatest level whose value is not above the given one.
    fn level(&self, value: f64) -> u16 {
        if value == f64::INFINITY {
            return INFINITE;
        }
        if !value.is_finite() {
            return UNBOUNDED;
        }
        let steps = ((value - self.least) / self.step).min(STEPS);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to the number of steps; where the step is 0 all levels are equal"
        )]
        let mut level = LEAST + steps as u16;
        // The quotient and the values of levels may have been rounded up.
        while self.value(level) > value {
            level -= 1;
        }
        level
    }
}

#[cfg(test)]
mod tests {
    use super::{RoundedDown, STEPS};
    use crate::math::random::SplitMix;

    #[test]
    fn numbers_are_rounded_down_by_less_than_a_step() {
        let mut random = SplitMix::new(7);
        for range in [1e-9, 1.0, 300.0, 1e9] {
            let mut value = || 500.0 + range * random.below(1 << 40) as f64 / 2_f64.powi(40);
            let values: Vec<f64> = (0..2_000).map(|_| value()).collect();
            let rounded = RoundedDown::new(&values);
            for (index, &value) in values.iter().enumerate() {
                let kept = rounded.get(index);
                let resolution = range / STEPS + 1e-12 * value;
                assert!(
                    kept <= value && value - kept <= resolution,
                    "{value}: {kept}"
                );
            }
        }
    }

    #[test]
    fn equal_numbers_and_infinities_stay_as_they_are() {
        let given = [f64::INFINITY, 3.25, f64::NEG_INFINITY, 3.25];
        let rounded = RoundedDown::new(&given);
        for (index, value) in given.into_iter().enumerate() {
            assert!(rounded.get(index).total_cmp(&value).is_eq(), "{value}");
        }
        let unknown = RoundedDown::new(&[f64::NAN, f64::INFINITY]);
        assert!(unknown.get(0) == f64::NEG_INFINITY && unknown.get(1) == f64::INFINITY);
    }
}
