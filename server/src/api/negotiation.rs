//! Which form of an answer a request accepts.

use axum::http::{HeaderMap, header};

/// The form that `Accept` prefers, the first among equals and without it; `None` when it accepts none.
pub(super) fn accepted<F: Copy>(
    headers: &HeaderMap,
    forms: &[F],
    media_type: fn(F) -> &'static str,
) -> Option<F> {
    let mut ranges = headers
        .get_all(header::ACCEPT)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .map(range)
        .peekable();
    if ranges.peek().is_none() {
        return forms.first().copied();
    }
    let ranges: Vec<(String, f64)> = ranges.collect();
    let weight = |form: F| {
        let name = media_type(form);
        let group = format!("{}/*", name.split('/').next().unwrap_or(""));
        // The most specific range that matches decides.
        [name, &group, "*/*"]
            .iter()
            .find_map(|name| ranges.iter().find(|(range, _)| range == name))
            .map_or(0.0, |(_, weight)| *weight)
    };
    forms
        .iter()
        .map(|form| (*form, weight(*form)))
        .filter(|(_, weight)| *weight > 0.0)
        .reduce(|best, next| if next.1 > best.1 { next } else { best })
        .map(|(form, _)| form)
}

fn range(text: &str) -> (String, f64) {
    let mut parts = text.split(';').map(str::trim);
    let name = parts.next().unwrap_or("").to_ascii_lowercase();
    let weight = parts
        .find_map(|part| part.strip_prefix("q="))
        .map_or(1.0, |weight| weight.parse().unwrap_or(0.0));
    (name, weight)
}
