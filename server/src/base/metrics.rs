//! Figures for those who run the service, in the text form of Prometheus.

use std::fmt::{Display, Write};

/// How often a quantity was in each class; a class holds everything up to its end.
#[derive(Debug)]
pub(crate) struct Histogram {
    ends: &'static [f64],
    classes: Vec<u64>,
    count: u64,
    sum: f64,
}

impl Histogram {
    /// An empty one with classes of these upper ends, in ascending order.
    pub(crate) fn new(ends: &'static [f64]) -> Self {
        Self {
            ends,
            classes: vec![0; ends.len()],
            count: 0,
            sum: 0.0,
        }
    }

    /// Counts a value.
    pub(crate) fn count(&mut self, value: f64) {
        self.count += 1;
        self.sum += value;
        for (class, end) in self.classes.iter_mut().zip(self.ends) {
            *class += u64::from(value <= *end);
        }
    }

    /// Writes it with labels, or without any.
    pub(crate) fn write(&self, text: &mut String, name: &str, labels: &str) {
        let bucket = format!("{name}_bucket");
        let comma = if labels.is_empty() { "" } else { "," };
        for (class, end) in self.classes.iter().zip(self.ends) {
            sample(
                text,
                &bucket,
                &format!("{labels}{comma}le=\"{end}\""),
                class,
            );
        }
        let all = format!("{labels}{comma}le=\"+Inf\"");
        sample(text, &bucket, &all, self.count);
        sample(text, &format!("{name}_sum"), labels, self.sum);
        sample(text, &format!("{name}_count"), labels, self.count);
    }
}

/// Writes what a figure is.
pub(crate) fn head(text: &mut String, name: &str, kind: &str, help: &str) {
    // Writing into a text cannot fail.
    let _ = writeln!(text, "# HELP {name} {help}\n# TYPE {name} {kind}");
}

/// Writes one value of a figure.
pub(crate) fn sample(text: &mut String, name: &str, labels: &str, value: impl Display) {
    let _ = if labels.is_empty() {
        writeln!(text, "{name} {value}")
    } else {
        writeln!(text, "{name}{{{labels}}} {value}")
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_hold_everything_below_their_ends() {
        let mut histogram = Histogram::new(&[1.0, 10.0]);
        for value in [0.5, 1.0, 5.0, 50.0] {
            histogram.count(value);
        }
        let mut text = String::new();
        histogram.write(&mut text, "x", "");
        assert_eq!(
            text,
            "x_bucket{le=\"1\"} 2\nx_bucket{le=\"10\"} 3\nx_bucket{le=\"+Inf\"} 4\n\
             x_sum 56.5\nx_count 4\n"
        );
    }
}
