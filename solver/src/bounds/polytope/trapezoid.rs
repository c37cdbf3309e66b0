//! Limits of one component of the rate over a slew.

/// `min(most, begin + slope t, end + slope (T - t))`: what a component of the rate reaches between given ends, rad/s,
/// or its share of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trapezoid {
    /// Its largest value.
    pub most: f64,
    /// Its largest rise in a second; infinite where none is known.
    pub slope: f64,
    /// Its largest values at the two ends; infinite where the component is free.
    pub ends: [f64; 2],
}

impl Trapezoid {
    /// At a time of a slew of a duration.
    pub(crate) fn at(&self, time: f64, duration: f64) -> f64 {
        let begin = self.ends[0] + self.slope * time;
        let end = self.ends[1] + self.slope * (duration - time);
        self.most.min(begin).min(end)
    }

    /// Times at which it may have a kink, within the duration.
    pub(crate) fn kinks(&self, duration: f64) -> [f64; 3] {
        let [begin, end] = self.ends.map(|end| end.min(self.most));
        [
            (self.most - begin) / self.slope,
            duration - (self.most - end) / self.slope,
            0.5 * (duration + (end - begin) / self.slope),
        ]
        .map(|time| time.clamp(0.0, duration))
    }

    /// Its mean over a duration; its largest value over an infinite one.
    pub(crate) fn mean(&self, duration: f64) -> f64 {
        if duration.is_infinite() || self.slope.is_infinite() {
            return self.most;
        }
        self.integral(duration) / duration
    }

    /// Its integral over a finite duration.
    pub(crate) fn integral(&self, duration: f64) -> f64 {
        if self.slope.is_infinite() {
            return self.most * duration;
        }
        let mut times = [0.0, duration, 0.0, 0.0, 0.0];
        times[2..].copy_from_slice(&self.kinks(duration));
        times.sort_by(f64::total_cmp);
        let area = |pair: &[f64]| {
            let ends = [pair[0], pair[1]].map(|time| self.at(time, duration));
            0.5 * (ends[0] + ends[1]) * (pair[1] - pair[0])
        };
        times.windows(2).map(area).sum()
    }
}
