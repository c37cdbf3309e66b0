//! Statements: a text for both databases, with its values.

use super::dialect::Dialect;
use super::postgres;
use super::row::{FromRow, Row};
use crate::store::StoreError;
use sqlx::postgres::{PgArguments, PgConnection, PgPool, Postgres};
use sqlx::query::Query;
use sqlx::sqlite::{Sqlite, SqliteArguments, SqliteConnection, SqlitePool};
use sqlx::{SqlSafeStr, SqlStr};
use std::borrow::Cow;

/// Where a statement is executed: on any connection, or within a transaction.
#[derive(Debug)]
pub(in crate::store) enum Handle<'c> {
    /// Any connection to SQLite.
    SqlitePool(&'c SqlitePool),
    /// One of them.
    Sqlite(&'c mut SqliteConnection),
    /// Any connection to Postgres.
    PostgresPool(&'c PgPool),
    /// One of them.
    Postgres(&'c mut PgConnection),
}

/// A value of a statement; its type is known even where there is none.
#[derive(Debug, Clone)]
pub(in crate::store) enum Value<'v> {
    /// A truth.
    Bool(Option<bool>),
    /// A whole number.
    Integer(Option<i64>),
    /// A number.
    Real(Option<f64>),
    /// A text.
    Text(Option<Cow<'v, str>>),
    /// Bytes.
    Bytes(&'v [u8]),
}

macro_rules! values {
    ($($variant:ident from $type:ty $(: $convert:expr)?;)+) => {
        $(
            impl<'v> From<$type> for Value<'v> {
                fn from(value: $type) -> Self {
                    Self::$variant(values!(@ value $(, $convert)?))
                }
            }
        )+
    };
    (@ $value:ident) => { $value };
    (@ $value:ident, $convert:expr) => { $convert($value) };
}

values! {
    Bool from bool: Some;
    Bool from Option<bool>;
    Integer from i64: Some;
    Integer from u32: |value| Some(i64::from(value));
    Integer from Option<i64>;
    Real from f64: Some;
    Real from Option<f64>;
    Text from &'v str: |text| Some(Cow::Borrowed(text));
    Text from Option<&'v str>: |text: Option<&'v str>| text.map(Cow::Borrowed);
    Text from &'v String: |text: &'v String| Some(Cow::Borrowed(text.as_str()));
    Text from &'v Option<String>: |text: &'v Option<String>| text.as_deref().map(Cow::Borrowed);
    Text from String: |text| Some(Cow::Owned(text));
    Bytes from &'v [u8];
    Bytes from &'v Vec<u8>: Vec::as_slice;
}

/// A statement with its values.
#[derive(Debug)]
pub(in crate::store) struct Statement<'v> {
    text: SqlStr,
    values: Vec<Value<'v>>,
    rows: usize,
}

/// A statement without values so far.
pub(in crate::store) fn sql<'v>(text: impl SqlSafeStr) -> Statement<'v> {
    Statement {
        text: text.into_sql_str(),
        values: Vec::new(),
        rows: 1,
    }
}

/// Executes a statement where it shall be, by a method of sqlx.
macro_rules! run {
    ($statement:ident, $on:ident, $method:ident, $sqlite:expr, $postgres:expr) => {
        match $on.into() {
            Handle::SqlitePool(on) => Ok($statement.for_sqlite().$method(on).await.map($sqlite)?),
            Handle::Sqlite(on) => Ok($statement.for_sqlite().$method(on).await.map($sqlite)?),
            Handle::PostgresPool(on) => {
                let done = $statement.for_postgres().$method(on).await;
                done.map($postgres).map_err(postgres::error)
            }
            Handle::Postgres(on) => {
                let done = $statement.for_postgres().$method(on).await;
                done.map($postgres).map_err(postgres::error)
            }
        }
    };
}

impl<'v> Statement<'v> {
    /// Gives the next of the values `$1`, `$2` and so on.
    pub(in crate::store) fn bind(mut self, value: impl Into<Value<'v>>) -> Self {
        self.values.push(value.into());
        self
    }

    /// Gives the values of the rows that the statement stands for, as the last ones; there must be some.
    pub(in crate::store) fn rows<const N: usize>(mut self, rows: Vec<[Value<'v>; N]>) -> Self {
        self.rows = rows.len();
        self.values.extend(rows.into_iter().flatten());
        self
    }

    /// Executes it. Returns the number of rows that it wrote.
    pub(in crate::store) async fn execute<'c>(
        self,
        on: impl Into<Handle<'c>>,
    ) -> Result<u64, StoreError> {
        run!(self, on, execute, |done| done.rows_affected(), |done| done
            .rows_affected())
    }

    /// All rows.
    pub(in crate::store) async fn fetch_all<'c, R: FromRow>(
        self,
        on: impl Into<Handle<'c>>,
    ) -> Result<Vec<R>, StoreError> {
        run!(
            self,
            on,
            fetch_all,
            |rows| rows.iter().map(Row::Sqlite).map(R::from_row).collect(),
            |rows| rows.iter().map(Row::Postgres).map(R::from_row).collect()
        )?
    }

    /// The first row, if there is any.
    pub(in crate::store) async fn fetch_optional<'c, R: FromRow>(
        self,
        on: impl Into<Handle<'c>>,
    ) -> Result<Option<R>, StoreError> {
        run!(
            self,
            on,
            fetch_optional,
            |row| row.as_ref().map(Row::Sqlite).map(R::from_row).transpose(),
            |row| row.as_ref().map(Row::Postgres).map(R::from_row).transpose()
        )?
    }

    /// The only row.
    pub(in crate::store) async fn fetch_one<'c, R: FromRow>(
        self,
        on: impl Into<Handle<'c>>,
    ) -> Result<R, StoreError> {
        let row = self.fetch_optional(on).await?;
        row.ok_or(StoreError::Database(sqlx::Error::RowNotFound))
    }

    fn for_sqlite(self) -> Query<'static, Sqlite, SqliteArguments> {
        let mut query = sqlx::query(Dialect::Sqlite.of(self.text, self.rows));
        for value in self.values {
            query = match value {
                Value::Bool(value) => query.bind(value),
                Value::Integer(value) => query.bind(value),
                Value::Real(value) => query.bind(value),
                Value::Text(value) => query.bind(value.map(Cow::into_owned)),
                Value::Bytes(value) => query.bind(value),
            };
        }
        query
    }

    fn for_postgres(self) -> Query<'static, Postgres, PgArguments> {
        let mut query = sqlx::query(Dialect::Postgres.of(self.text, self.rows));
        for value in self.values {
            query = match value {
                Value::Bool(value) => query.bind(value),
                Value::Integer(value) => query.bind(value),
                Value::Real(value) => query.bind(value),
                Value::Text(value) => query.bind(value.map(without_nul)),
                Value::Bytes(value) => query.bind(value),
            };
        }
        query
    }
}

/// Texts of Postgres cannot have the character NUL, which names of scenarios may.
fn without_nul(text: Cow<'_, str>) -> String {
    if text.contains('\0') {
        return text.replace('\0', "\u{fffd}");
    }
    text.into_owned()
}
