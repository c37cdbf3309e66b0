//! From quantities to places in the picture.

/// A linear scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    pub(super) least: f64,
    pub(super) most: f64,
    /// Where the least value is.
    pub(super) from: f64,
    /// Where the largest value is.
    pub(super) to: f64,
}

impl Scale {
    /// The place of a value.
    pub(super) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.least) / (self.most - self.least) * (self.to - self.from)
    }

    /// Round values inside, about so many, with the digits that tell them apart.
    pub(super) fn ticks(&self, about: f64) -> (Vec<f64>, usize) {
        let rough = (self.most - self.least) / about;
        let power = 10_f64.powf(rough.log10().floor());
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= rough);
        let step = factor.unwrap_or(10.0) * power;
        let mut ticks = Vec::new();
        let mut number = (self.least / step - 1e-9).ceil();
        while number * step <= self.most + 1e-9 * step {
            // Zero without a sign.
            ticks.push(number * step + 0.0);
            number += 1.0;
        }
        let mut digits = 0;
        while digits < 9 && step * 10_f64.powi(digits) < 0.999 {
            digits += 1;
        }
        (ticks, usize::try_from(digits).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = |least, most| Scale {
            least,
            most,
            from: 0.0,
            to: 100.0,
        };
        assert_eq!(
            scale(0.0, 467.7).ticks(5.0).0,
            [0.0, 100.0, 200.0, 300.0, 400.0]
        );
        let (ticks, digits) = scale(-0.04, 0.04).ticks(4.0);
        assert_eq!((ticks.len(), digits), (5, 2));
        assert!(ticks.iter().all(|tick| tick.abs() < 0.0401));
        assert!((scale(-1.0, 1.0).at(0.5) - 75.0).abs() < 1e-12);
    }
}
