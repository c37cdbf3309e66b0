//! Counts and durations of requests.

use crate::base::metrics::{Scrape, histogram};
use axum::http::{Method, StatusCode};
use prometheus::HistogramVec;
use std::time::Duration;

/// Upper ends of the buckets of durations, s.
const DURATIONS_S: [f64; 8] = [0.001, 0.005, 0.02, 0.05, 0.2, 1.0, 5.0, 30.0];

/// Durations of all requests so far, by method, route and status. Routes rather than paths bound the
/// number of their combinations.
#[derive(Debug)]
pub(super) struct RequestMetrics(HistogramVec);

impl Default for RequestMetrics {
    fn default() -> Self {
        Self(histogram(
            "slewplan_http_request_duration_seconds",
            "Time until the answer to a request began.",
            &["method", "route", "status"],
            &DURATIONS_S,
        ))
    }
}

impl RequestMetrics {
    /// Counts a request; its duration is the time until its answer began.
    pub(super) fn count(&self, method: &Method, route: &str, status: StatusCode, took: Duration) {
        // Clients can send any method; each would be a series of its own.
        let method = match method.as_str() {
            known @ ("GET" | "HEAD" | "POST" | "PUT" | "DELETE" | "OPTIONS" | "PATCH") => known,
            _ => "other",
        };
        self.0
            .with_label_values(&[method, route, status.as_str()])
            .observe(took.as_secs_f64());
    }

    /// Adds them to a scrape.
    pub(super) fn report(&self, scrape: &Scrape) {
        scrape.add(&self.0);
    }
}
