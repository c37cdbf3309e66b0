//! The fastest motion about one axis from rest to rest within a rate and an acceleration.
//!
//! It accelerates, coasts at the greatest rate if it reaches that, and brakes:
//!
//! ```text
//!   T = angle / w + w / w'    where the rate w is reached, else    T = 2 sqrt(angle / w')
//! ```

/// A bang-coast-bang of one angle.
#[derive(Debug, Clone, Copy)]
pub struct BangCoastBang {
    angle: f64,
    acceleration: f64,
    ramp: f64,
    duration: f64,
}

impl BangCoastBang {
    /// The fastest over an angle (rad, at least zero) within an acceleration (rad/s²) and a rate
    /// (rad/s), both above zero; the rate may be infinite.
    #[must_use]
    pub fn fastest(angle: f64, acceleration: f64, rate: f64) -> Self {
        let ramp = (angle / acceleration).sqrt().min(rate / acceleration);
        let duration = if ramp > 0.0 {
            angle / (ramp * acceleration) + ramp
        } else {
            0.0
        };
        Self {
            angle,
            acceleration,
            ramp,
            duration,
        }
    }

    /// The one without a coast over an angle, which may be zero, in a given time.
    #[must_use]
    pub fn lasting(angle: f64, duration: f64) -> Self {
        Self {
            angle,
            acceleration: 4.0 * angle / duration.powi(2),
            ramp: 0.5 * duration,
            duration,
        }
    }

    /// Total angle, rad.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// Duration, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Greatest rate, rad/s.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.at(0.5 * self.duration).1
    }

    /// Acceleration of the ramps, rad/s².
    #[must_use]
    pub fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Duration of each ramp, s.
    #[must_use]
    pub fn ramp(&self) -> f64 {
        self.ramp
    }

    /// Durations of its ramps and of the coast between them, s.
    #[must_use]
    pub fn parts(&self) -> [f64; 3] {
        let coast = (self.duration - 2.0 * self.ramp).max(0.0);
        [self.ramp, coast, self.ramp]
    }

    /// Angle (rad), rate (rad/s) and acceleration (rad/s²) at a time, s.
    #[must_use]
    pub fn at(&self, time: f64) -> (f64, f64, f64) {
        let a = self.acceleration;
        let left = self.duration - time;
        if time < self.ramp {
            (0.5 * a * time * time, a * time, a)
        } else if left > self.ramp {
            let rate = a * self.ramp;
            (rate * (time - 0.5 * self.ramp), rate, 0.0)
        } else {
            (self.angle - 0.5 * a * left * left, a * left, -a)
        }
    }

    /// The time at which a share (in [0, 1]) of the angle is left, s.
    #[must_use]
    pub fn time_with_left(&self, share: f64) -> f64 {
        let left = self.angle * share;
        let (ramp, rate) = (self.ramp, self.rate());
        let ramped = 0.5 * rate * ramp;
        let remaining = if left <= ramped {
            (2.0 * left / self.acceleration).sqrt()
        } else if left <= self.angle - ramped {
            ramp + (left - ramped) / rate
        } else {
            let begun = 2.0 * (self.angle - left) / self.acceleration;
            self.duration - begun.sqrt()
        };
        self.duration - remaining
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_course_inverts_its_own_angles() {
        for rate in [0.05, 0.2, f64::INFINITY] {
            let course = BangCoastBang::fastest(2.0, 0.01, rate);
            for i in 0..=20 {
                let share = f64::from(i) / 20.0;
                let (angle, ..) = course.at(course.time_with_left(share));
                assert!(
                    (angle - 2.0 * (1.0 - share)).abs() < 1e-7,
                    "{rate} {share}: {angle}"
                );
            }
        }
    }
}
