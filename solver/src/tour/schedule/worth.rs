//! Values of targets in whole units, so that sums do not depend on the order of their terms.
//!
//! The unit is a power of ten, some 1e-12 of the sum of all values: values as people write them are
//! whole numbers of it, and equal sums of them are equal. A required target is worth more than all
//! optional ones together, so that a schedule without it loses against every one with it.

use super::TimedTarget;

/// Units of the sum of all values, at most.
const DIGITS: f64 = 1e12;

/// What the targets are worth, in units.
#[derive(Debug, Clone)]
pub(super) struct Worth {
    /// Of each target.
    pub(super) units: Vec<u64>,
    /// The value of a unit is ten to this power.
    exponent: i32,
    /// Of a required one; the optional ones together are worth less.
    required: u64,
}

impl Worth {
    pub(super) fn of(targets: &[TimedTarget]) -> Self {
        let sum: f64 = targets.iter().filter_map(|target| target.value).sum();
        // The least power of ten that is not below the sum, some digits smaller.
        let exponent = (-300..=296).find(|exponent| times_ten_to(DIGITS, *exponent) >= sum);
        let exponent = exponent.unwrap_or(296);
        // At least one, so that no value counts as nothing.
        let optional = |value: f64| whole(times_ten_to(value, -exponent)).max(1);
        let units = targets.iter().map(|target| target.value.map(optional));
        let units: Vec<Option<u64>> = units.collect();
        let required = 1 + units.iter().flatten().sum::<u64>();
        Self {
            units: units.into_iter().map(|u| u.unwrap_or(required)).collect(),
            required,
            exponent,
        }
    }

    /// How many required targets are among those that are worth so much together.
    pub(super) fn required_in(&self, units: u64) -> u64 {
        units / self.required
    }

    /// How many targets are required.
    pub(super) fn required(&self) -> u64 {
        let required = self.units.iter().filter(|units| **units == self.required);
        required.count() as u64
    }

    /// Whether so much worth includes that of all required targets.
    pub(super) fn is_whole(&self, units: u64) -> bool {
        self.required_in(units) >= self.required()
    }

    /// The values of optional targets in a bound on the sum of units.
    pub(super) fn value_of(&self, units: u64) -> f64 {
        if !self.is_whole(units) {
            // There is no schedule.
            return 0.0;
        }
        // No sum of worth is more than that of all targets, but a bound may be.
        let optional = units.saturating_sub(self.required() * self.required);
        times_ten_to(optional.min(self.required - 1) as f64, self.exponent)
    }
}

/// A number times a power of ten. Powers below one are not exact, but their reciprocals are: whole numbers
/// of units are the values again, to the last digit.
fn times_ten_to(number: f64, exponent: i32) -> f64 {
    if exponent < 0 {
        number / 10_f64.powi(-exponent)
    } else {
        number * 10_f64.powi(exponent)
    }
}

/// The nearest whole number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers of units are between 0 and 1e12"
)]
fn whole(units: f64) -> u64 {
    units.round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_above_all_worth_is_the_sum_of_all_values() {
        let target = |value| TimedTarget {
            service_s: 0.0,
            windows: None,
            value,
        };
        for required in [0, 1, 3] {
            let mut targets = vec![target(Some(2.0)), target(Some(5.0))];
            targets.resize(2 + required, target(None));
            let worth = Worth::of(&targets);
            let all: u64 = worth.units.iter().sum();
            for bound in [all, all + 1, u64::MAX] {
                assert_eq!(worth.value_of(bound).to_string(), "7");
            }
            assert_eq!(worth.value_of(all - worth.units[0]).to_string(), "5");
        }
    }
}
