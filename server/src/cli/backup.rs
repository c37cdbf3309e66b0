//! `slewplan backup`: a copy of the database, while the service uses it.

use super::{Exit, Failure, runtime};
use crate::service::ServiceError;
use crate::store;
use std::path::PathBuf;

/// What `backup` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Where the copy goes; it appears complete or not at all
    copy: PathBuf,
    /// The database of the service
    #[arg(
        long,
        env = "SLEWPLAN_DATABASE",
        value_name = "FILE",
        default_value = "slewplan.db"
    )]
    database: PathBuf,
}

/// Copies the database.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let copied = runtime::start()?.block_on(store::backup(&arguments.database, &arguments.copy));
    copied.map_err(ServiceError::from)?;
    Ok(Exit::Complete)
}
