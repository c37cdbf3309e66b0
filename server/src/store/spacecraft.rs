//! Spacecraft stored by name, with their newest versions.

use super::database::Turn;
use super::database::statement::sql;
use super::{Store, StoreError};

/// Number of versions kept of each name. Jobs do not depend on them: their scenarios have the
/// spacecraft written out.
pub(super) const KEPT_VERSIONS: i64 = 100;

row! {
    columns spacecraft_columns;
    /// A version of a stored spacecraft.
    #[derive(Debug, Clone)]
    pub(crate) struct SpacecraftRow {
        /// Counts from 1 for each name.
        pub(crate) version: i64,
        /// The spacecraft as JSON.
        pub(crate) document: String,
        /// When it was stored.
        pub(crate) created_us: i64,
    }
}

row! {
    /// The newest version of a stored spacecraft, without its document.
    #[derive(Debug, Clone)]
    pub(crate) struct SpacecraftName {
        /// Stored name.
        pub(crate) name: String,
        /// The newest version.
        pub(crate) version: i64,
        /// When it was stored.
        pub(crate) created_us: i64,
    }
}

impl Store {
    /// Stores a spacecraft as the newest version, unless the newest has the same document. Versions
    /// older than the newest [`KEPT_VERSIONS`] are deleted.
    pub(crate) async fn put_spacecraft(
        &self,
        name: &str,
        document: &str,
        now_us: i64,
    ) -> Result<SpacecraftRow, StoreError> {
        let mut transaction = self.begin().await?;
        transaction.take_turn(Turn::Spacecraft).await?;
        let newest: Option<SpacecraftRow> = sql(concat!(
            "SELECT ",
            spacecraft_columns!(),
            " FROM spacecraft WHERE name = $1 ORDER BY version DESC LIMIT 1",
        ))
        .bind(name)
        .fetch_optional(&mut *transaction)
        .await?;
        let version = match newest {
            Some(newest) if newest.document == document => return Ok(newest),
            Some(newest) => newest.version + 1,
            None => 1,
        };
        sql("INSERT INTO spacecraft (name, version, document, created_us) VALUES ($1, $2, $3, $4)")
            .bind(name)
            .bind(version)
            .bind(document)
            .bind(now_us)
            .execute(&mut *transaction)
            .await?;
        sql("DELETE FROM spacecraft WHERE name = $1 AND version <= $2")
            .bind(name)
            .bind(version - KEPT_VERSIONS)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(SpacecraftRow {
            version,
            document: document.to_owned(),
            created_us: now_us,
        })
    }

    /// A stored spacecraft in a given version, or in its newest.
    pub(crate) async fn spacecraft(
        &self,
        name: &str,
        version: Option<i64>,
    ) -> Result<Option<SpacecraftRow>, StoreError> {
        sql(concat!(
            "SELECT ",
            spacecraft_columns!(),
            " FROM spacecraft \
             WHERE name = $1 AND ($2 IS NULL OR version = $2) ORDER BY version DESC LIMIT 1",
        ))
        .bind(name)
        .bind(version)
        .fetch_optional(&self.database)
        .await
    }

    /// Stored spacecraft in the order of their names, which begin with `prefix`, or have no space
    /// without one.
    pub(crate) async fn spacecraft_names(
        &self,
        prefix: Option<&str>,
        after: Option<&str>,
        limit: i64,
    ) -> Result<Vec<SpacecraftName>, StoreError> {
        let letters = prefix.map_or(0, |prefix| prefix.chars().count());
        sql(
            "SELECT name, version, created_us FROM spacecraft AS newest \
             WHERE version = (SELECT max(version) FROM spacecraft AS one WHERE one.name = newest.name) \
             AND (substr(name, 1, CAST($2 AS INTEGER)) = $1 OR ($1 IS NULL AND name NOT LIKE '% %')) \
             AND ($3 IS NULL OR name > $3) ORDER BY name LIMIT $4",
        )
        .bind(prefix)
        .bind(i64::try_from(letters).unwrap_or(i64::MAX))
        .bind(after)
        .bind(limit)
        .fetch_all(&self.database)
        .await
    }
}
