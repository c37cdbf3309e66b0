//! `slewplan copy`: moves everything to another database.

use super::{Exit, Failure, output, runtime};
use crate::documents;
use crate::service::ServiceError;
use crate::store::{self, Copied, CopyLock, DatabaseAddress, Store, StoreError};
use std::fmt::Write;

/// Arguments of `copy`.
#[derive(Debug, clap::Args)]
pub(super) struct CopyArguments {
    /// Database that is copied: a file, or the URL of one on a Postgres server; no service or worker may
    /// use it meanwhile
    #[arg(long, value_name = "FILE|URL")]
    from: DatabaseAddress,
    /// Database that gets everything; it must have nothing yet
    #[arg(long, value_name = "FILE|URL")]
    to: DatabaseAddress,
}

/// Copies the database.
pub(super) fn run(arguments: &CopyArguments) -> Result<Exit, Failure> {
    let CopyArguments { from, to } = arguments;
    runtime::check_there(from)?;
    let copied = runtime::start()?.block_on(copy(from, to));
    let copied = copied.map_err(ServiceError::from)?;
    let mut text = String::new();
    for Copied { table, rows } in copied {
        // Writing into a text cannot fail.
        let _ = writeln!(text, "{rows:>12}  {table}");
    }
    output::print(&text)?;
    Ok(Exit::Complete)
}

async fn copy(from: &DatabaseAddress, to: &DatabaseAddress) -> Result<Vec<Copied>, StoreError> {
    let _locks = [CopyLock::exclude(from)?, CopyLock::exclude(to)?];
    let [source, target] = [
        Store::open_quietly(from, documents::jobs::tell).await?,
        Store::open_quietly(to, documents::jobs::tell).await?,
    ];
    source.refuse_others().await?;
    target.refuse_others().await?;
    let copied = store::copy(&source, &target).await;
    source.close().await;
    target.close().await;
    copied
}
