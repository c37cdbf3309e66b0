//! `slewplan backup`: copies the database while the service uses it.

use super::database::DatabaseOption;
use super::{Exit, Failure, runtime};
use crate::service::ServiceError;
use crate::store::{self, DatabaseAddress};
use std::path::PathBuf;

/// Arguments of `backup`.
#[derive(Debug, clap::Args)]
pub(super) struct BackupArguments {
    /// File of the copy, which appears complete or not at all
    copy: PathBuf,
    #[command(flatten)]
    database: DatabaseOption,
}

/// Copies the database.
pub(super) fn run(arguments: &BackupArguments) -> Result<Exit, Failure> {
    let DatabaseAddress::File(database) = &arguments.database.database else {
        return Err(Failure::Setting {
            name: "--database",
            what: "a database of Postgres is copied by its own tools, such as pg_dump".into(),
        });
    };
    let copied = runtime::start()?.block_on(store::backup(database, &arguments.copy));
    copied.map_err(ServiceError::from)?;
    Ok(Exit::Complete)
}
