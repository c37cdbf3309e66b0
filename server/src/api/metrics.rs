//! Requests, counted and timed.

use crate::base::metrics::{Histogram, head};
use axum::http::{Method, StatusCode};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Upper ends of the classes of durations, s.
const CLASSES: [f64; 8] = [0.001, 0.005, 0.02, 0.05, 0.2, 1.0, 5.0, 30.0];

/// What is known about all requests so far. Routes, not paths, so that it stays small.
#[derive(Debug, Default)]
pub(super) struct Metrics(Mutex<BTreeMap<Request, Histogram>>);

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Request {
    method: String,
    route: String,
    status: u16,
}

impl Metrics {
    fn lock(&self) -> MutexGuard<'_, BTreeMap<Request, Histogram>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a request; its duration is the time until its answer began.
    pub(super) fn count(&self, method: &Method, route: &str, status: StatusCode, took: Duration) {
        // Anybody can invent methods.
        let method = match method.as_str() {
            known @ ("GET" | "HEAD" | "POST" | "PUT" | "DELETE" | "OPTIONS" | "PATCH") => known,
            _ => "other",
        };
        let request = Request {
            method: method.to_owned(),
            route: route.to_owned(),
            status: status.as_u16(),
        };
        let mut all = self.lock();
        let durations = all.entry(request);
        let durations = durations.or_insert_with(|| Histogram::new(&CLASSES));
        durations.count(took.as_secs_f64());
    }

    /// Writes them in the text form of Prometheus.
    pub(super) fn write(&self, text: &mut String) {
        let name = "slewplan_http_request_duration_seconds";
        head(
            text,
            name,
            "histogram",
            "Time until the answer to a request began.",
        );
        for (request, durations) in &*self.lock() {
            let labels = format!(
                "method=\"{}\",route=\"{}\",status=\"{}\"",
                request.method, request.route, request.status
            );
            durations.write(text, name, &labels);
        }
    }
}
