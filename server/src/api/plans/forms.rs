//! The forms of a result, and which of them a request asks for.

use crate::render::export::Form;
use axum::http::{HeaderMap, header};
use serde::{Deserialize, Deserializer};
use utoipa::openapi::schema::{ObjectBuilder, SchemaType, Type};

impl<'de> Deserialize<'de> for Form {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL
            .into_iter()
            .find(|form| form.name() == name)
            .ok_or_else(|| serde::de::Error::custom(format!("format is one of {}", names())))
    }
}

/// The names of all forms for the description.
pub(super) fn described() -> ObjectBuilder {
    ObjectBuilder::new()
        .schema_type(SchemaType::Type(Type::String))
        .enum_values(Some(Form::ALL.map(Form::name)))
}

/// The form that `Accept` prefers, the first among equals; `None` when it accepts none.
pub(super) fn accepted(headers: &HeaderMap) -> Option<Form> {
    let mut ranges = headers
        .get_all(header::ACCEPT)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .map(range)
        .peekable();
    if ranges.peek().is_none() {
        return Some(Form::Json);
    }
    let ranges: Vec<(String, f64)> = ranges.collect();
    let weight = |form: Form| {
        let name = form.media_type();
        let group = format!("{}/*", name.split('/').next().unwrap_or(""));
        // The most specific range that matches decides.
        [name, &group, "*/*"]
            .iter()
            .find_map(|name| ranges.iter().find(|(range, _)| range == name))
            .map_or(0.0, |(_, weight)| *weight)
    };
    Form::ALL
        .into_iter()
        .map(|form| (form, weight(form)))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::export::Format;
    use axum::http::HeaderValue;

    #[test]
    fn the_preferred_form_is_chosen() {
        let csv = Some(Form::Export(Format::Csv));
        let cases = [
            ("*/*", Some(Form::Json)),
            ("text/csv", csv),
            ("text/*;q=0.5, application/json;q=0.4", csv),
            ("text/csv;q=0, */*", Some(Form::Json)),
            ("application/*;q=0.1", Some(Form::Json)),
            (
                "text/x.ccsds.aem.kvn, text/*;q=0.9, */*;q=0.1",
                Some(Form::Export(Format::AemKvn)),
            ),
            (
                "Application/X.CCSDS.AEM+XML",
                Some(Form::Export(Format::AemXml)),
            ),
            ("image/png", None),
        ];
        for (accept, expected) in cases {
            let mut headers = HeaderMap::new();
            headers.insert(header::ACCEPT, HeaderValue::from_static(accept));
            assert_eq!(accepted(&headers), expected, "{accept}");
        }
        assert_eq!(accepted(&HeaderMap::new()), Some(Form::Json));
    }
}
