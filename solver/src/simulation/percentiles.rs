//! Percentiles over simulated flights, by nearest rank.

/// Percentiles of a quantity that should be small: values that so many flights do not exceed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Percentiles {
    /// 50th percentile.
    pub p50: f64,
    /// 90th percentile.
    pub p90: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Greatest value.
    pub max: f64,
}

/// Percentiles of a quantity that should be large: 50, 90, 99 and 100 % of the flights have at least
/// these values.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LowPercentiles {
    /// 50th percentile.
    pub p50: f64,
    /// 10th percentile.
    pub p10: f64,
    /// 1st percentile.
    pub p1: f64,
    /// Least value.
    pub min: f64,
}

impl Percentiles {
    /// Of values in any order; all zero of none.
    pub(super) fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let rank = |percent: usize| {
            let rank = (values.len() * percent).div_ceil(100).max(1);
            values.get(rank - 1).copied().unwrap_or(0.0)
        };
        Self {
            p50: rank(50),
            p90: rank(90),
            p99: rank(99),
            max: rank(100),
        }
    }
}

impl LowPercentiles {
    /// Of values in any order; all zero of none.
    pub(super) fn of(values: impl Iterator<Item = f64>) -> Self {
        // Positive zeros of no values stay positive.
        let mirrored = |value: f64| 0.0 - value;
        let of_mirrored = Percentiles::of(values.map(mirrored).collect());
        Self {
            p50: mirrored(of_mirrored.p50),
            p10: mirrored(of_mirrored.p90),
            p1: mirrored(of_mirrored.p99),
            min: mirrored(of_mirrored.max),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_the_values_of_nearest_rank() {
        let values: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        let found = Percentiles::of(values);
        let expected = Percentiles {
            p50: 100.0,
            p90: 180.0,
            p99: 198.0,
            max: 200.0,
        };
        assert_eq!(found, expected);
        assert_eq!(Percentiles::of(Vec::new()), Percentiles::default());
        assert!((Percentiles::of(vec![3.0]).p50 - 3.0).abs() <= 0.0);
    }

    #[test]
    fn so_many_flights_have_at_least_the_low_percentiles() {
        let found = LowPercentiles::of((1..=200).map(f64::from));
        let expected = LowPercentiles {
            p50: 101.0,
            p10: 21.0,
            p1: 3.0,
            min: 1.0,
        };
        assert_eq!(found, expected);
        assert_eq!(
            LowPercentiles::of(std::iter::empty()),
            LowPercentiles::default()
        );
    }
}
