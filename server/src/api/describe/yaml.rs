//! The description as YAML whose numbers every reader knows as numbers.
//!
//! Readers of YAML 1.1, as most tools in Python are, want a point and a signed exponent (`1.0e-9`).
//! They take what is written for small and large numbers (`1e-9`) for a text.

use utoipa::openapi::OpenApi;

/// The text of a description.
pub(in crate::api) fn yaml(description: &OpenApi) -> String {
    let yaml = description.to_yaml();
    let yaml = yaml.expect("all types of the description can be written as YAML");
    let lines: Vec<String> = yaml.lines().map(with_plain_exponent).collect();
    lines.join("\n") + "\n"
}

/// A line whose value, if it is a number with an exponent, has a point and a sign. Texts that look like
/// numbers are in quotation marks and stay as they are.
fn with_plain_exponent(line: &str) -> String {
    let start = line.rfind(' ').map_or(0, |space| space + 1);
    let (before, value) = line.split_at(start);
    let is_value = before.ends_with(": ") || before.ends_with("- ");
    match value.split_once('e') {
        Some((digits, exponent)) if is_value && is_decimal(digits) => {
            let Ok(exponent) = exponent.parse::<i32>() else {
                return line.to_owned();
            };
            let point = if digits.contains('.') { "" } else { ".0" };
            format!("{before}{digits}{point}e{exponent:+}")
        }
        _ => line.to_owned(),
    }
}

fn is_decimal(text: &str) -> bool {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let starts = digits.starts_with(|c: char| c.is_ascii_digit());
    starts && digits.chars().all(|c| c.is_ascii_digit() || c == '.')
}

#[cfg(test)]
mod tests {
    use super::*;
    use utoipa::Number;
    use utoipa::openapi::schema::{Components, ObjectBuilder, Type};

    fn limits(minimum: f64, maximum: f64, example: &str) -> String {
        let schema = ObjectBuilder::new()
            .schema_type(Type::Number)
            .minimum(Some(Number::from(minimum)))
            .maximum(Some(Number::from(maximum)))
            .examples([example]);
        let mut description = OpenApi::default();
        let mut components = Components::new();
        components.schemas.insert("Limited".into(), schema.into());
        description.components = Some(components);
        yaml(&description)
    }

    #[test]
    fn exponents_have_a_point_and_a_sign() {
        let yaml = limits(1e-9, 1e21, "1e-9");
        assert!(yaml.contains("minimum: 1.0e-9\n"), "{yaml}");
        assert!(yaml.contains("maximum: 1.0e+21\n"), "{yaml}");
        let yaml = limits(-2.5e-9, 2.5e21, "one");
        assert!(yaml.contains("minimum: -2.5e-9\n"), "{yaml}");
        assert!(yaml.contains("maximum: 2.5e+21\n"), "{yaml}");
    }

    #[test]
    fn texts_and_other_numbers_stay_as_they_are() {
        let yaml = limits(0.001, 12.0, "1e-9");
        assert!(yaml.contains("minimum: 0.001\n"), "{yaml}");
        assert!(yaml.contains("maximum: 12\n"), "{yaml}");
        assert!(yaml.contains("- '1e-9'\n"), "{yaml}");
        for line in [
            "key: 1c9e7",
            "key: eve",
            "text of 1e-9",
            "- 'x: 1e-9'",
            "12e3",
        ] {
            assert_eq!(with_plain_exponent(line), line);
        }
    }
}
