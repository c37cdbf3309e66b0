//! What is left of a cell where some forms have to vanish.

use super::form::Form;
use nalgebra::{Matrix3, Vector3};

/// The part of a cell, in deviations from its middle, that may hold a solution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Left {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
}

impl Left {
    pub(super) const ALL: Self = Self {
        low: [-1.0; 3],
        high: [1.0; 3],
    };

    /// Share of the cell's volume.
    pub(super) fn share(&self) -> f64 {
        (0..3).map(|k| 0.5 * (self.high[k] - self.low[k])).product()
    }

    /// Where `middle + slopes . d`, up to the rest, can be 0; `None` if nowhere.
    pub(super) fn vanishing(mut self, form: &Form) -> Option<Self> {
        // Rounding of the sums below, which have less than ten terms.
        let terms = form.middle.abs() + form.slopes[..3].iter().map(|x| x.abs()).sum::<f64>();
        let rest = (form.rest + 1e-14 * terms) * (1.0 + 1e-12);
        for k in 0..3 {
            let mut others = [form.middle - rest, form.middle + rest];
            for j in (0..3).filter(|j| *j != k) {
                let ends = [form.slopes[j] * self.low[j], form.slopes[j] * self.high[j]];
                others[0] += ends[0].min(ends[1]);
                others[1] += ends[0].max(ends[1]);
            }
            // slope d = -others.
            let slope = form.slopes[k];
            if slope.abs() < 1e-9 * terms {
                let own = slope.abs();
                if others[0] - own > 0.0 || others[1] + own < 0.0 {
                    return None;
                }
                continue;
            }
            let ends = [-others[0] / slope, -others[1] / slope];
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let slack = 1e-12 * (low.abs() + high.abs());
            self.low[k] = self.low[k].max(low - slack);
            self.high[k] = self.high[k].min(high + slack);
            if self.low[k] > self.high[k] {
                return None;
            }
        }
        Some(self)
    }

    /// Where all three can be 0; `None` if nowhere.
    pub(super) fn all_vanishing(mut self, forms: &[Form; 3]) -> Option<Self> {
        for form in forms {
            self = self.vanishing(form)?;
        }
        let slopes = Matrix3::from_fn(|i, k| forms[i].slopes[k]);
        let Some(inverse) = slopes.try_inverse() else {
            return Some(self);
        };
        if !inverse.iter().all(|x| x.is_finite()) {
            return Some(self);
        }
        for k in 0..3 {
            let row = Vector3::new(inverse[(k, 0)], inverse[(k, 1)], inverse[(k, 2)]);
            self = self.vanishing(&super::form::combined(row.into(), forms))?;
        }
        for form in forms {
            self = self.vanishing(form)?;
        }
        Some(self)
    }
}
