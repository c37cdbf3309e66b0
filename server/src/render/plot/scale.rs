//! Scales: from values to coordinates of the picture.

/// Ratio of the ends of positive values from which on a scale is logarithmic.
const DECADES: f64 = 30.0;

/// Allowed surplus of powers of ten over the number of ticks asked for.
const CROWDED: f64 = 1.5;

/// A linear or logarithmic scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    least: f64,
    most: f64,
    from: f64,
    to: f64,
    logarithmic: bool,
}

/// A round value with its text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) words: String,
}

impl Scale {
    /// A linear scale from the coordinate of the minimum to that of the maximum.
    pub(super) const fn linear((least, most): (f64, f64), (from, to): (f64, f64)) -> Self {
        Self {
            least,
            most,
            from,
            to,
            logarithmic: false,
        }
    }

    /// A scale with margins around values: logarithmic where they are positive and span decades,
    /// else linear. `share` is the margin at each end.
    pub(super) fn around(
        values: &mut dyn Iterator<Item = f64>,
        share: f64,
        places: (f64, f64),
    ) -> Self {
        let (least, most) = ends(values);
        if least > 0.0 && most / least >= DECADES {
            let room = (most / least).powf(share);
            return Self {
                logarithmic: true,
                ..Self::linear((least / room, most * room), places)
            };
        }
        Self::around_linear(&mut [least, most].into_iter(), share, places)
    }

    /// The same, always linear.
    pub(super) fn around_linear(
        values: &mut dyn Iterator<Item = f64>,
        share: f64,
        places: (f64, f64),
    ) -> Self {
        let (least, most) = ends(values);
        let room = if most > least {
            share * (most - least)
        } else {
            share * most.abs().max(1.0)
        };
        Self::linear((least - room, most + room), places)
    }

    /// The coordinate of a value, which must be positive on a logarithmic scale.
    pub(super) fn at(&self, value: f64) -> f64 {
        let share = if self.logarithmic {
            (value / self.least).ln() / (self.most / self.least).ln()
        } else {
            (value - self.least) / (self.most - self.least)
        };
        self.from + share * (self.to - self.from)
    }

    /// The value at a coordinate.
    pub(super) fn value(&self, place: f64) -> f64 {
        let share = (place - self.from) / (self.to - self.from);
        if self.logarithmic {
            self.least * (self.most / self.least).powf(share)
        } else {
            self.least + share * (self.most - self.least)
        }
    }

    /// Whether a value lies within the ends.
    pub(super) fn holds(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }

    /// Round values within the ends, about as many as asked for.
    pub(super) fn ticks(&self, about: f64) -> Vec<Tick> {
        if self.logarithmic {
            return self.powers(about);
        }
        let rough = (self.most - self.least) / about;
        let power = 10_f64.powf(rough.log10().floor());
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= rough);
        let step = factor.unwrap_or(10.0) * power;
        let mut digits = 0;
        while digits < 9 && step * 10_f64.powi(digits) < 0.999 {
            digits += 1;
        }
        let digits = usize::try_from(digits).unwrap_or(0);
        let mut ticks = Vec::new();
        let mut number = (self.least / step - 1e-9).ceil();
        while number * step <= self.most + 1e-9 * step {
            // Zero without a sign.
            let value = number * step + 0.0;
            ticks.push(Tick {
                value,
                words: minus(&format!("{value:.digits$}")),
            });
            number += 1.0;
        }
        ticks
    }

    /// Powers of ten and, where these are few, their multiples by 2 and 5.
    fn powers(&self, about: f64) -> Vec<Tick> {
        let decades = (self.most / self.least).log10();
        let factors: &[f64] = if 2.0 * decades <= about {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        let mut ticks = Vec::new();
        // With many decades only every second, third and so on.
        let stride = (decades / (CROWDED * about)).ceil().max(1.0);
        let mut power = stride * (self.least.log10() / stride).floor();
        while power <= self.most.log10() {
            let values = factors.iter().map(|factor| factor * 10_f64.powf(power));
            ticks.extend(values.filter(|value| self.holds(*value)).map(|value| Tick {
                value,
                words: round_text(value),
            }));
            power += stride;
        }
        ticks
    }
}

/// Minimum and maximum; 0 and 1 without any value.
fn ends(values: &mut dyn Iterator<Item = f64>) -> (f64, f64) {
    values
        .fold(None, |ends: Option<(f64, f64)>, value| {
            let (least, most) = ends.unwrap_or((value, value));
            Some((least.min(value), most.max(value)))
        })
        .unwrap_or((0.0, 1.0))
}

/// The text of a power of ten or its multiple by 2 or 5.
fn round_text(value: f64) -> String {
    if (1e-4..1e5).contains(&value) {
        let text = format!("{value:.4}");
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    minus(&format!("{value:.0e}"))
}

/// A number's text with a minus sign as wide as its digits.
pub(super) fn minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(ticks: &[Tick]) -> Vec<f64> {
        ticks.iter().map(|tick| tick.value).collect()
    }

    #[test]
    fn ticks_are_round_and_within_the_ends() {
        let scale = |least, most| Scale::linear((least, most), (0.0, 100.0));
        assert_eq!(
            values(&scale(0.0, 467.7).ticks(5.0)),
            [0.0, 100.0, 200.0, 300.0, 400.0]
        );
        let ticks = scale(-0.04, 0.04).ticks(4.0);
        let words: Vec<&str> = ticks.iter().map(|tick| tick.words.as_str()).collect();
        assert_eq!(
            words,
            ["\u{2212}0.04", "\u{2212}0.02", "0.00", "0.02", "0.04"]
        );
        assert!((scale(-1.0, 1.0).at(0.5) - 75.0).abs() < 1e-12);
    }

    #[test]
    fn values_that_span_decades_have_a_logarithmic_scale() {
        let scale = Scale::around(&mut [0.01, 0.1, 10.0].into_iter(), 0.0, (0.0, 300.0));
        assert!((scale.at(0.1) - 100.0).abs() < 1e-9);
        assert!((scale.value(100.0) - 0.1).abs() < 1e-12);
        let words = |about: f64| {
            let ticks = scale.ticks(about).into_iter();
            ticks.map(|tick| tick.words).collect::<Vec<_>>()
        };
        assert_eq!(words(5.0), ["0.01", "0.1", "1", "10"]);
        assert_eq!(words(6.0)[..4], ["0.01", "0.02", "0.05", "0.1"]);
        assert_eq!(words(1.5), ["0.01", "1"]);
        // Not with a zero among them, nor within a decade.
        for near in [[0.0, 100.0], [1.0, 20.0]] {
            let scale = Scale::around(&mut near.into_iter(), 0.0, (0.0, 1.0));
            assert!((scale.at(0.5 * (near[0] + near[1])) - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn a_single_value_has_margins_on_both_sides() {
        let scale = Scale::around(&mut [7.0].into_iter(), 0.1, (0.0, 10.0));
        assert!((scale.at(7.0) - 5.0).abs() < 1e-12 && scale.holds(7.5));
    }
}
