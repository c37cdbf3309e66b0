//! `slewplan migrate`: brings the schema of a database up to date, for roles that may only use it.

use super::database::DatabaseOption;
use super::{Exit, Failure, output, runtime};
use crate::service::ServiceError;
use crate::store::DatabaseAddress;

/// Arguments of `migrate`.
#[derive(Debug, clap::Args)]
pub(super) struct MigrateArguments {
    #[command(flatten)]
    database: DatabaseOption,
    /// Role of a Postgres server that services and workers connect as: it gets what they need, and no
    /// right to change the schema
    #[arg(long, env = "SLEWPLAN_GRANT_TO", value_name = "ROLE")]
    grant_to: Option<String>,
}

/// Migrates the database.
pub(super) fn run(arguments: &MigrateArguments) -> Result<Exit, Failure> {
    let MigrateArguments { database, grant_to } = arguments;
    let database = &database.database;
    if grant_to.is_some() && matches!(database, DatabaseAddress::File(_)) {
        return Err(Failure::Setting {
            name: "--grant-to",
            what: "a file has no roles".into(),
        });
    }
    runtime::with_store(database, async |store| {
        if let Some(role) = grant_to {
            store.grant_to(role).await.map_err(ServiceError::from)?;
        }
        output::print(&format!("the schema of {database} is up to date\n"))?;
        Ok(Exit::Complete)
    })
}
