//! The option `--database`.

use crate::store::DatabaseAddress;
use clap::builder::{OsStringValueParser, TypedValueParser, ValueParser, ValueParserFactory};

impl ValueParserFactory for DatabaseAddress {
    type Parser = ValueParser;

    fn value_parser() -> ValueParser {
        ValueParser::new(OsStringValueParser::new().try_map(Self::try_from))
    }
}
