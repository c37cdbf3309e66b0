//! The forms of a result, and which of them a request asks for.

use super::super::negotiation;
use crate::render::export::Form;
use axum::http::HeaderMap;
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

/// The form that `Accept` prefers; `None` when it accepts none.
pub(super) fn accepted(headers: &HeaderMap) -> Option<Form> {
    negotiation::accepted(headers, &Form::ALL, Form::media_type)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::export::Format;
    use axum::http::{HeaderValue, header};

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
