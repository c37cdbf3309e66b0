//! API keys of clients, and the ownership of jobs and spacecraft.

use super::database::statement::sql;
use super::database::{Transaction, Turn};
use super::{Notice, Store, StoreError};
use crate::base::access::Scopes;

row! {
    columns key_columns;
    /// A key without its secret.
    #[derive(Debug, Clone)]
    pub(crate) struct KeyRow {
        /// Public identifier of the key.
        pub(crate) id: String,
        /// The client that the key belongs to.
        pub(crate) client: String,
        scopes: String,
        /// When it was made.
        pub(crate) created_us: i64,
        /// When it expires.
        pub(crate) expires_us: Option<i64>,
        /// When it was revoked.
        pub(crate) revoked_us: Option<i64>,
    }
}

impl KeyRow {
    /// The scopes that it grants.
    pub(crate) fn scopes(&self) -> Result<Scopes, StoreError> {
        let scopes = self.scopes.parse();
        scopes.map_err(|what| StoreError::Inconsistent {
            table: "api_keys",
            what,
        })
    }

    /// Whether the key is valid at a time.
    pub(crate) fn is_valid(&self, now_us: i64) -> bool {
        self.revoked_us.is_none() && self.expires_us.is_none_or(|end| now_us < end)
    }
}

/// A key to be stored.
#[derive(Debug)]
pub(crate) struct NewKey {
    /// Names the key.
    pub(crate) id: String,
    /// For whom it acts.
    pub(crate) client: String,
    /// SHA-256 of the key, hex.
    pub(crate) digest: String,
    /// What it opens.
    pub(crate) scopes: Scopes,
    /// When it ends.
    pub(crate) expires_us: Option<i64>,
}

/// Numbers of jobs and of names of spacecraft.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Possessions {
    /// Jobs.
    pub(crate) jobs: i64,
    /// Names of spacecraft.
    pub(crate) spacecraft: i64,
}

impl Store {
    /// Stores a key. With `adopt` its client becomes the owner of what belongs to nobody.
    pub(crate) async fn put_key(
        &self,
        key: &NewKey,
        adopt: bool,
        now_us: i64,
    ) -> Result<(), StoreError> {
        let mut transaction = self.begin().await?;
        sql(
            "INSERT INTO api_keys (id, client, digest, scopes, created_us, expires_us) \
             VALUES ($1, $2, $3, $4, $5, $6)",
        )
        .bind(&key.id)
        .bind(&key.client)
        .bind(&key.digest)
        .bind(key.scopes.to_string())
        .bind(now_us)
        .bind(key.expires_us)
        .execute(&mut *transaction)
        .await?;
        if adopt {
            transaction.take_turn(Turn::Adoption).await?;
            give(&mut transaction, &key.client).await?;
        }
        transaction.commit().await?;
        self.tell(Notice::Keys);
        Ok(())
    }

    /// How much belongs to nobody: what was made without keys.
    pub(crate) async fn ownerless(&self) -> Result<Possessions, StoreError> {
        let (jobs, spacecraft) = sql(
            "SELECT (SELECT count(*) FROM jobs WHERE client IS NULL AND parent IS NULL), \
             (SELECT count(DISTINCT name) FROM spacecraft WHERE name NOT LIKE '% %')",
        )
        .fetch_one(&self.database)
        .await?;
        Ok(Possessions { jobs, spacecraft })
    }

    /// All keys, the oldest first.
    pub(crate) async fn keys(&self) -> Result<Vec<KeyRow>, StoreError> {
        sql(concat!(
            "SELECT ",
            key_columns!(),
            " FROM api_keys ORDER BY created_us, id"
        ))
        .fetch_all(&self.database)
        .await
    }

    /// The key with a digest.
    pub(crate) async fn key(&self, digest: &str) -> Result<Option<KeyRow>, StoreError> {
        sql(concat!(
            "SELECT ",
            key_columns!(),
            " FROM api_keys WHERE digest = $1"
        ))
        .bind(digest)
        .fetch_optional(&self.database)
        .await
    }

    /// Revokes a key; `false` when no key of this name is still unrevoked.
    pub(crate) async fn revoke_key(&self, id: &str, now_us: i64) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let revoked =
            sql("UPDATE api_keys SET revoked_us = $1 WHERE id = $2 AND revoked_us IS NULL")
                .bind(now_us)
                .bind(id)
                .execute(&mut *transaction)
                .await?;
        transaction.commit().await?;
        Ok(revoked > 0)
    }

    /// Whether a job exists and belongs to a client.
    pub(crate) async fn owns(&self, client: &str, job: &str) -> Result<bool, StoreError> {
        let owned: Option<(i64,)> = sql("SELECT sequence FROM jobs WHERE client = $1 AND id = $2")
            .bind(client)
            .bind(job)
            .fetch_optional(&self.database)
            .await?;
        Ok(owned.is_some())
    }
}

/// Makes a client the owner of the jobs, idempotency keys and spacecraft that have none. Names that
/// the client has already stay its own, and what would be hidden by them stays without owner.
///
/// A name without owner is stored as it is, others after their client and a space.
async fn give(transaction: &mut Transaction, client: &str) -> Result<(), StoreError> {
    sql(
        "UPDATE idempotency_keys SET key = $1 || ' ' || key WHERE key NOT LIKE '% %' \
         AND $1 || ' ' || key NOT IN (SELECT key FROM idempotency_keys)",
    )
    .bind(client)
    .execute(&mut *transaction)
    .await?;
    sql("UPDATE jobs SET client = $1 WHERE client IS NULL")
        .bind(client)
        .execute(&mut *transaction)
        .await?;
    sql(
        "UPDATE spacecraft SET name = $1 || ' ' || name WHERE name NOT LIKE '% %' \
         AND $1 || ' ' || name NOT IN (SELECT name FROM spacecraft)",
    )
    .bind(client)
    .execute(transaction)
    .await?;
    Ok(())
}
