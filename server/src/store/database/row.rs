//! Rows of either database.

use crate::store::StoreError;
use sqlx::postgres::{PgRow, Postgres};
use sqlx::sqlite::{Sqlite, SqliteRow};
use sqlx::{ColumnIndex, Decode, Row as _, Type};

/// A row of a query.
#[derive(Clone, Copy)]
pub(in crate::store) enum Row<'r> {
    /// Of SQLite.
    Sqlite(&'r SqliteRow),
    /// Of Postgres.
    Postgres(&'r PgRow),
}

/// A type that a column of either database is read as.
pub(in crate::store) trait Column:
    for<'r> Decode<'r, Sqlite> + Type<Sqlite> + for<'r> Decode<'r, Postgres> + Type<Postgres>
{
}

impl<T> Column for T where
    T: for<'r> Decode<'r, Sqlite> + Type<Sqlite> + for<'r> Decode<'r, Postgres> + Type<Postgres>
{
}

/// Names or counts a column.
pub(in crate::store) trait Place:
    ColumnIndex<SqliteRow> + ColumnIndex<PgRow>
{
}

impl<P: ColumnIndex<SqliteRow> + ColumnIndex<PgRow>> Place for P {}

impl Row<'_> {
    /// The value of a column.
    pub(in crate::store) fn get<T: Column>(&self, place: impl Place) -> Result<T, StoreError> {
        Ok(match self {
            Self::Sqlite(row) => row.try_get(place)?,
            Self::Postgres(row) => row.try_get(place)?,
        })
    }
}

/// A type that is read from a row.
pub(in crate::store) trait FromRow: Sized {
    /// Reads it.
    ///
    /// # Errors
    ///
    /// When a column is missing or has another type.
    fn from_row(row: Row<'_>) -> Result<Self, StoreError>;
}

/// Tuples are read from the columns in their order.
macro_rules! tuple {
    ($($type:ident $place:literal),+) => {
        impl<$($type: Column),+> FromRow for ($($type,)+) {
            fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
                Ok(($(row.get::<$type>($place)?,)+))
            }
        }
    };
}

tuple!(A 0);
tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
