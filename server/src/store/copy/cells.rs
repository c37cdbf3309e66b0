//! Rows of any table.

use crate::store::StoreError;
use crate::store::database::row::{FromRow, Row};
use crate::store::database::statement::Value;
use sqlx::{Column as _, Row as _, TypeInfo as _};
use std::borrow::Cow;

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::store) enum Cell {
    Truth(Option<bool>),
    Integer(Option<i64>),
    Real(Option<f64>),
    Text(Option<String>),
    Bytes(Vec<u8>),
}

/// A row, with its values in the order of the query.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::store) struct Cells(pub(in crate::store) Vec<Cell>);

impl Cell {
    /// The value for a statement.
    pub(in crate::store) fn value(&self) -> Value<'_> {
        match self {
            Self::Truth(truth) => Value::Bool(*truth),
            Self::Integer(number) => Value::Integer(*number),
            Self::Real(number) => Value::Real(*number),
            Self::Text(text) => Value::Text(text.as_deref().map(Cow::Borrowed)),
            Self::Bytes(bytes) => Value::Bytes(bytes),
        }
    }

    /// The value for a column of truths, which are numbers in SQLite.
    pub(in crate::store) fn truth(&self) -> Value<'_> {
        match self {
            Self::Integer(number) => Value::Bool(number.map(|number| number != 0)),
            other => other.value(),
        }
    }
}

impl FromRow for Cells {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        let kinds: Vec<String> = match row {
            Row::Sqlite(row) => row
                .columns()
                .iter()
                .map(|c| c.type_info().name().into())
                .collect(),
            Row::Postgres(row) => row
                .columns()
                .iter()
                .map(|c| c.type_info().name().into())
                .collect(),
        };
        let cells = kinds.iter().enumerate().map(|(place, kind)| {
            Ok(match kind.as_str() {
                "BOOL" => Cell::Truth(row.get(place)?),
                "INTEGER" | "INT8" => Cell::Integer(row.get(place)?),
                "REAL" | "FLOAT8" => Cell::Real(row.get(place)?),
                "TEXT" => Cell::Text(row.get(place)?),
                "BLOB" | "BYTEA" => Cell::Bytes(row.get(place)?),
                other => {
                    return Err(StoreError::Inconsistent {
                        table: "a table",
                        what: format!("it has a column of type {other}"),
                    });
                }
            })
        });
        cells.collect::<Result<_, _>>().map(Self)
    }
}
