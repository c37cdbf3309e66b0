//! `slewplan keys`: makes, lists and revokes keys of the service.

use super::database::DatabaseOption;
use super::{Exit, Failure, output, runtime};
use crate::base::access::{FreshKey, Scope, Scopes};
use crate::base::clock::{now_us, rfc3339};
use crate::service::ServiceError;
use crate::store::{KeyRow, NewKey, Possessions, Store};
use std::fmt::Write;

/// Microseconds of a day.
const DAY_US: i64 = 86_400_000_000;
const MAX_CLIENT: usize = 64;
const NOTHING: Possessions = Possessions {
    jobs: 0,
    spacecraft: 0,
};

/// Arguments of `keys`.
#[derive(Debug, clap::Args)]
pub(super) struct KeysArguments {
    #[command(flatten)]
    database: DatabaseOption,
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, clap::Subcommand)]
enum Action {
    /// Make a key and print it, once; a running service requires keys within a second
    Create(KeyOrder),
    /// List all keys, without their secrets
    List,
    /// Revoke a key at once
    Revoke {
        /// Identifier of the key: the first column of the list
        id: String,
    },
}

#[derive(Debug, clap::Args)]
struct KeyOrder {
    /// Client of the key: keys of the same client see the same jobs
    client: String,
    /// Scopes of the key
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [Scope::Read, Scope::Write])]
    scopes: Vec<Scope>,
    /// Days after which the key expires [default: never]
    #[arg(long, value_name = "DAYS", value_parser = clap::value_parser!(u32).range(1..=36_500))]
    expires: Option<u32>,
    /// Give the client the plans, idempotency keys and spacecraft that were made without keys
    #[arg(long)]
    adopt: bool,
}

/// Makes, lists or revokes keys.
pub(super) fn run(arguments: &KeysArguments) -> Result<Exit, Failure> {
    let database = &arguments.database.database;
    match &arguments.action {
        Action::Create(order) => {
            runtime::with_store(database, async |store| create(store, order).await)
        }
        Action::List => runtime::with_existing_store(database, list),
        Action::Revoke { id } => {
            runtime::with_existing_store(database, async |store| revoke(store, id).await)
        }
    }
}

async fn create(store: &Store, order: &KeyOrder) -> Result<Exit, Failure> {
    let client = &order.client;
    check_client(client)?;
    let fresh = FreshKey::new().map_err(|error| ServiceError::System {
        what: "no randomness for a key".into(),
        source: error.into(),
    })?;
    let now = now_us();
    let key = NewKey {
        id: fresh.id.clone(),
        client: client.clone(),
        digest: fresh.digest(),
        scopes: Scopes::new(&order.scopes),
        expires_us: order.expires.map(|days| now + i64::from(days) * DAY_US),
    };
    let is_first = store.keys().await.map_err(ServiceError::from)?.is_empty();
    let before = store.ownerless().await.map_err(ServiceError::from)?;
    let stored = store.put_key(&key, order.adopt, now).await;
    stored.map_err(ServiceError::from)?;
    let after = store.ownerless().await.map_err(ServiceError::from)?;
    output::complain(&format!(
        "key {} of {client}; it is shown only this once",
        fresh.id
    ));
    if is_first {
        output::complain("this is the first key: from now on the service asks for one");
    }
    if order.adopt {
        output::complain(&format!(
            "{client} now owns {}",
            made_without_keys(Possessions {
                jobs: before.jobs - after.jobs,
                spacecraft: before.spacecraft - after.spacecraft,
            })
        ));
    }
    if after != NOTHING {
        output::complain(&hidden(after, order));
    }
    output::print(&format!("{}\n", fresh.secret))?;
    Ok(Exit::Complete)
}

fn check_client(client: &str) -> Result<(), Failure> {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_.-".contains(&byte);
    if !client.is_empty() && client.len() <= MAX_CLIENT && client.bytes().all(plain) {
        return Ok(());
    }
    Err(Failure::Setting {
        name: "CLIENT",
        what: format!(
            "{client:?} is not 1 to {MAX_CLIENT} letters, digits, dots, dashes and underscores"
        ),
    })
}

fn made_without_keys(Possessions { jobs, spacecraft }: Possessions) -> String {
    let plural = if jobs == 1 { "" } else { "s" };
    format!("{jobs} plan{plural} and {spacecraft} spacecraft that were made without keys")
}

/// What happens to that which still belongs to nobody.
fn hidden(left: Possessions, order: &KeyOrder) -> String {
    let (what, client) = (made_without_keys(left), &order.client);
    if order.adopt {
        return format!("{what} stay hidden: {client} has spacecraft of the same names");
    }
    format!(
        "no key shows {what}; to give them to {client}, make another key with slewplan keys create \
         {client} --adopt"
    )
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
    let now = now_us();
    let revoked = store.revoke_key(id, now).await;
    if !revoked.map_err(ServiceError::from)? {
        return Err(Failure::Setting {
            name: "ID",
            what: format!("there is no key {id:?} that could be revoked"),
        });
    }
    let keys = store.keys().await.map_err(ServiceError::from)?;
    if !keys.iter().any(|key| key.is_valid(now)) {
        output::complain(
            "no valid key is left: the service still asks for one, also after a restart, and serves \
             nobody; slewplan keys create CLIENT makes a new key, with the name of an old client one \
             for its plans, and slewplan serve --no-keys lets everybody in",
        );
    }
    Ok(Exit::Complete)
}
