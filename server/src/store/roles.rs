//! Rights in a database of Postgres: those who run the program need not be able to change its schema.

use super::database::Database;
use super::{Store, StoreError};
use sqlx::AssertSqlSafe;

impl Store {
    /// Gives a role what services and workers need, on all tables that there are now.
    ///
    /// # Errors
    ///
    /// When there is no such role, or this one may not give it anything.
    pub(crate) async fn grant_to(&self, role: &str) -> Result<(), StoreError> {
        let Database::Postgres(database) = &self.database else {
            return Ok(());
        };
        let quoted = "SELECT quote_ident($1), quote_ident(current_schema())";
        let (role, schema): (String, String) = sqlx::query_as(quoted)
            .bind(role)
            .fetch_one(&database.pool)
            .await?;
        let mut transaction = database.pool.begin().await?;
        for grant in [
            format!("GRANT USAGE ON SCHEMA {schema} TO {role}"),
            format!(
                "GRANT SELECT, INSERT, UPDATE, DELETE ON ALL TABLES IN SCHEMA {schema} TO {role}"
            ),
            format!("REVOKE INSERT, UPDATE, DELETE ON _sqlx_migrations FROM {role}"),
        ] {
            sqlx::query(AssertSqlSafe(grant))
                .execute(&mut *transaction)
                .await?;
        }
        transaction.commit().await?;
        Ok(())
    }
}
