//! The option `--database`, declared once for all commands.

use crate::store::DatabaseAddress;
use clap::builder::{TypedValueParser, ValueParserFactory};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error};
use std::ffi::OsStr;

/// The database of the service.
#[derive(Debug, clap::Args)]
pub(super) struct DatabaseOption {
    /// Database: a file, or the URL of one on a Postgres server, which several processes share
    #[arg(
        long,
        global = true,
        env = "SLEWPLAN_DATABASE",
        value_name = "FILE|URL",
        default_value = "slewplan.db"
    )]
    pub(super) database: DatabaseAddress,
}

/// The same where a command needs none, and uses one only when it is told to.
#[derive(Debug, clap::Args)]
pub(super) struct LegDatabaseOption {
    /// Read known legs from this database of the service, and store new ones in it
    #[arg(long, value_name = "FILE|URL")]
    pub(super) database: Option<DatabaseAddress>,
}

/// Reads the option. Its errors do not repeat the value, which may contain a password.
#[derive(Clone)]
pub(crate) struct AddressParser;

impl TypedValueParser for AddressParser {
    type Value = DatabaseAddress;

    fn parse_ref(
        &self,
        command: &Command,
        _: Option<&Arg>,
        value: &OsStr,
    ) -> Result<DatabaseAddress, Error> {
        DatabaseAddress::try_from(value.to_owned()).map_err(|what| {
            let text = format!("--database: {what}\n");
            Error::raw(ErrorKind::ValueValidation, text).with_cmd(command)
        })
    }
}

impl ValueParserFactory for DatabaseAddress {
    type Parser = AddressParser;

    fn value_parser() -> AddressParser {
        AddressParser
    }
}
