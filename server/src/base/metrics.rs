//! Metrics in the text format of Prometheus.

use prometheus::core::Collector;
use prometheus::{
    HistogramOpts, HistogramVec, IntCounterVec, IntGaugeVec, Opts, Registry, TextEncoder,
};

/// Media type of [`Scrape::text`].
pub(crate) const TEXT_FORMAT: &str = "text/plain; version=0.0.4; charset=utf-8";

/// Names, labels and buckets are constants of this program.
const VALID: &str = "a valid metric";

/// A histogram with buckets of these upper ends, in ascending order.
pub(crate) fn histogram(name: &str, help: &str, labels: &[&str], ends: &[f64]) -> HistogramVec {
    let options = HistogramOpts::new(name, help).buckets(ends.to_vec());
    HistogramVec::new(options, labels).expect(VALID)
}

/// A counter for every value of a label.
pub(crate) fn counter(name: &str, help: &str, labels: &[&str]) -> IntCounterVec {
    IntCounterVec::new(Opts::new(name, help), labels).expect(VALID)
}

/// Everything that one request for metrics reads. Metrics without any sample are left out.
#[derive(Default)]
pub(crate) struct Scrape(Registry);

impl Scrape {
    /// Adds a metric that is counted while the service runs.
    pub(crate) fn add(&self, metric: &(impl Collector + Clone + 'static)) {
        self.0.register(Box::new(metric.clone())).expect(VALID);
    }

    /// Adds quantities as they are now, each with the values of its labels.
    pub(crate) fn gauge<'a, const N: usize>(
        &self,
        name: &str,
        help: &str,
        labels: [&str; N],
        samples: impl IntoIterator<Item = ([&'a str; N], i64)>,
    ) {
        let gauge = IntGaugeVec::new(Opts::new(name, help), &labels).expect(VALID);
        for (values, quantity) in samples {
            gauge.with_label_values(&values).set(quantity);
        }
        self.add(&gauge);
    }

    /// The metrics in the order of their names.
    pub(crate) fn text(&self) -> String {
        let metrics = self.0.gather();
        let text = TextEncoder::new().encode_to_string(&metrics);
        text.expect("gathered metrics have samples")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_are_cumulative_and_labels_are_written() {
        let sizes = histogram("x", "Sizes.", &[], &[1.0, 10.0]);
        for value in [0.5, 1.0, 5.0, 50.0] {
            sizes.with_label_values::<&str>(&[]).observe(value);
        }
        let scrape = Scrape::default();
        scrape.add(&sizes);
        scrape.gauge("a", "States.", ["state"], [(["on"], 12_345_678_901)]);
        scrape.gauge("b", "Free.", [], [([], 0)]);
        assert_eq!(
            scrape.text(),
            "# HELP a States.\n# TYPE a gauge\na{state=\"on\"} 12345678901\n\
             # HELP b Free.\n# TYPE b gauge\nb 0\n\
             # HELP x Sizes.\n# TYPE x histogram\n\
             x_bucket{le=\"1\"} 2\nx_bucket{le=\"10\"} 3\nx_bucket{le=\"+Inf\"} 4\n\
             x_sum 56.5\nx_count 4\n"
        );
    }
}
