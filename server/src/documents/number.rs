//! Numbers that are safe to write.

use serde::ser::{Error, Serialize, Serializer};
use slewplan_solver::checker::NOT_COMPUTED;
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

/// A number whose writing fails when it is not finite, instead of silently becoming `null`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Number(pub(crate) f64);

impl Number {
    /// A number that could not be computed is none.
    pub(crate) fn computed(value: f64) -> Option<Self> {
        if value.is_finite() && value.abs() >= NOT_COMPUTED {
            None
        } else {
            Some(Self(value))
        }
    }

    /// All entries of an array.
    pub(crate) fn all(values: &[f64]) -> Vec<Self> {
        values.iter().copied().map(Self).collect()
    }
}

impl PartialSchema for Number {
    fn schema() -> RefOr<Schema> {
        f64::schema()
    }
}

impl ToSchema for Number {}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            Err(S::Error::custom(format!(
                "the number {} is not finite",
                self.0
            )))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finite_numbers_keep_every_digit() {
        let value = 0.1 + 0.2;
        let text = serde_json::to_string(&Number(value)).unwrap();
        assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
    }

    #[test]
    fn other_numbers_are_an_error() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(serde_json::to_string(&Number(value)).is_err());
        }
    }
}
