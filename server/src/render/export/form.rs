//! The forms of a written plan: its own JSON, or the format of another tool.

use super::Format;
use strum::VariantArray as _;

/// The form of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// The whole plan.
    Json,
    /// One of the formats of other tools.
    Export(Format),
}

impl Form {
    /// All forms, in the order of preference among equals.
    pub(crate) const ALL: [Self; 8] = {
        let mut all = [Self::Json; 8];
        let mut index = 0;
        while index < Format::VARIANTS.len() {
            all[index + 1] = Self::Export(Format::VARIANTS[index]);
            index += 1;
        }
        all
    };

    /// The stable name.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Export(format) => format.name(),
        }
    }

    /// The description, in a line.
    pub(crate) const fn summary(self) -> &'static str {
        match self {
            Self::Json => "The whole plan",
            Self::Export(format) => format.summary(),
        }
    }

    /// The media type.
    pub(crate) const fn media_type(self) -> &'static str {
        match self {
            Self::Json => "application/json",
            Self::Export(format) => format.media_type(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_form_has_a_name_and_a_media_type_of_its_own() {
        let distinct = |text: fn(Form) -> &'static str| {
            let texts: HashSet<_> = Form::ALL.into_iter().map(text).collect();
            texts.len()
        };
        assert_eq!(distinct(Form::name), Form::ALL.len());
        assert_eq!(distinct(Form::media_type), Form::ALL.len());
    }
}
