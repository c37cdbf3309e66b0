//! `slewplan keys`: makes, lists and revokes keys of the service.

use super::{Exit, Failure, output, runtime};
use crate::base::access::{FreshKey, Scope, Scopes};
use crate::base::clock::{now_us, rfc3339};
use crate::service::ServiceError;
use crate::store::{KeyRow, NewKey, Store};
use std::fmt::Write;
use std::path::PathBuf;

/// Microseconds of a day.
const DAY_US: i64 = 86_400_000_000;
const MAX_CLIENT: usize = 64;

/// Arguments of `keys`.
#[derive(Debug, clap::Args)]
pub(super) struct KeysArguments {
    /// The database of the service
    #[arg(
        long,
        global = true,
        env = "SLEWPLAN_DATABASE",
        value_name = "FILE",
        default_value = "slewplan.db"
    )]
    database: PathBuf,
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, clap::Subcommand)]
enum Action {
    /// Make a key and print it, once; a running service requires keys within a second
    Create {
        /// Client of the key: keys of the same client see the same jobs
        client: String,
        /// Scopes of the key
        #[arg(long, value_delimiter = ',', value_enum, default_values_t = [Scope::Read, Scope::Write])]
        scopes: Vec<Scope>,
        /// Days after which the key expires [default: never]
        #[arg(long, value_name = "DAYS", value_parser = clap::value_parser!(u32).range(1..=36_500))]
        expires: Option<u32>,
    },
    /// List all keys, without their secrets
    List,
    /// Revoke a key at once
    Revoke {
        /// Identifier of the key: the first column of the list
        id: String,
    },
}

/// Makes, lists or revokes keys.
pub(super) fn run(arguments: &KeysArguments) -> Result<Exit, Failure> {
    runtime::with_store(&arguments.database, async |store| match &arguments.action {
        Action::Create {
            client,
            scopes,
            expires,
        } => create(store, client, scopes, *expires).await,
        Action::List => list(store).await,
        Action::Revoke { id } => revoke(store, id).await,
    })
}

async fn create(
    store: &Store,
    client: &str,
    scopes: &[Scope],
    expires: Option<u32>,
) -> Result<Exit, Failure> {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_.-".contains(&byte);
    if client.is_empty() || client.len() > MAX_CLIENT || !client.bytes().all(plain) {
        return Err(Failure::Setting {
            name: "CLIENT",
            what: format!(
                "{client:?} is not 1 to {MAX_CLIENT} letters, digits, dots, dashes and \
                 underscores"
            ),
        });
    }
    let fresh = FreshKey::new().map_err(|error| ServiceError::System {
        what: "no randomness for a key".into(),
        source: error.into(),
    })?;
    let now = now_us();
    let key = NewKey {
        id: fresh.id.clone(),
        client: client.to_owned(),
        digest: fresh.digest(),
        scopes: Scopes::new(scopes),
        expires_us: expires.map(|days| now + i64::from(days) * DAY_US),
    };
    store.put_key(&key, now).await.map_err(ServiceError::from)?;
    output::complain(&format!(
        "key {} of {client}; it is shown only this once",
        fresh.id
    ));
    output::print(&format!("{}\n", fresh.secret))?;
    Ok(Exit::Complete)
}

async fn list(store: &Store) -> Result<Exit, Failure> {
    let now = now_us();
    let mut text = String::new();
    for key in store.keys().await.map_err(ServiceError::from)? {
        let line = line(&key, now).map_err(ServiceError::from)?;
        // Writing into a text cannot fail.
        let _ = writeln!(text, "{line}");
    }
    output::print(&text)?;
    Ok(Exit::Complete)
}

fn line(key: &KeyRow, now: i64) -> Result<String, crate::store::StoreError> {
    let end = match (key.revoked_us, key.expires_us) {
        (Some(revoked), _) => format!("revoked {}", rfc3339(revoked)),
        (None, Some(end)) if end <= now => format!("expired {}", rfc3339(end)),
        (None, Some(end)) => format!("until {}", rfc3339(end)),
        (None, None) => "valid".to_owned(),
    };
    let (id, client, scopes) = (&key.id, &key.client, key.scopes()?);
    let created = rfc3339(key.created_us);
    Ok(format!(
        "{id}  {client}  {scopes}  created {created}  {end}"
    ))
}

async fn revoke(store: &Store, id: &str) -> Result<Exit, Failure> {
    let revoked = store.revoke_key(id, now_us()).await;
    if revoked.map_err(ServiceError::from)? {
        return Ok(Exit::Complete);
    }
    Err(Failure::Setting {
        name: "ID",
        what: format!("there is no key {id:?} that could be revoked"),
    })
}
