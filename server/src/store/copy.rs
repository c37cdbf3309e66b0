//! Copies of a whole database, between SQLite and Postgres in either direction.
//!
//! The copy is made in one transaction of the target, from one state of the source: it is there
//! complete or not at all, and an interrupted one is begun again. Rows pass in batches, by the order of
//! their primary keys.

pub(super) mod cells;
mod lock;

pub(crate) use lock::CopyLock;

use super::database::Transaction;
use super::database::statement::sql;
use super::{Store, StoreError};
use cells::{Cell, Cells};
use sqlx::AssertSqlSafe;

/// A table that is copied.
pub(super) struct Table {
    pub(super) name: &'static str,
    /// Its primary key.
    key: &'static [&'static str],
    /// Number of rows that pass at once.
    batch: i64,
}

/// Rows of small tables, of those with a motion each, and of those with a document of megabytes.
const SMALL: i64 = 500;
const MOTIONS: i64 = 100;
const DOCUMENTS: i64 = 4;

const fn table(name: &'static str, key: &'static [&'static str], batch: i64) -> Table {
    Table { name, key, batch }
}

/// All tables, each after those that it refers to. A test compares them with the schema.
pub(super) const TABLES: [Table; 12] = [
    table("api_keys", &["id"], SMALL),
    table("spacecraft", &["name", "version"], SMALL),
    table("jobs", &["sequence"], DOCUMENTS),
    table("results", &["job"], DOCUMENTS),
    table("incumbents", &["job"], DOCUMENTS),
    table("events", &["job", "id"], SMALL),
    table("idempotency_keys", &["key"], SMALL),
    table("segments", &["sequence"], MOTIONS),
    table("leg_table_parts", &["job", "first"], MOTIONS),
    table("leg_spacecraft", &["key"], SMALL),
    table("legs", &["sequence"], MOTIONS),
    // What a check of the health has written says nothing of another database.
    table("readiness", &["one"], 0),
];

/// Number of rows of a table that were copied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Copied {
    /// The table.
    pub(crate) table: &'static str,
    /// How many.
    pub(crate) rows: i64,
}

pub(super) fn copied_tables() -> impl Iterator<Item = &'static Table> {
    TABLES.iter().filter(|table| table.batch > 0)
}

/// Copies everything that a database has into one that has nothing. Returns the numbers of rows.
///
/// # Errors
///
/// When the target has something, and when a database cannot be used.
pub(crate) async fn copy(source: &Store, target: &Store) -> Result<Vec<Copied>, StoreError> {
    let mut from = source.database.snapshot().await?;
    let mut to = target.begin().await?;
    for table in copied_tables() {
        let rows = count(&mut to, table.name).await?;
        if rows > 0 {
            return Err(StoreError::NotEmpty {
                table: table.name,
                rows,
            });
        }
    }
    let mut all = Vec::new();
    for table in copied_tables() {
        let columns = columns(&mut to, table.name).await?;
        let mut last: Option<Cells> = None;
        loop {
            let batch = read(&mut from, table, &columns, last.as_ref()).await?;
            write(&mut to, table, &columns, &batch).await?;
            let is_last = batch.len() < usize::try_from(table.batch).unwrap_or(usize::MAX);
            last = batch.into_iter().next_back();
            if is_last {
                break;
            }
        }
        if columns.iter().any(|column| column.name == ASSIGNED) {
            let newest = newest_number(&mut from, table.name).await?;
            go_on_after(&mut to, table.name, newest).await?;
        }
        let rows = [
            count(&mut from, table.name).await?,
            count(&mut to, table.name).await?,
        ];
        if rows[0] != rows[1] {
            return Err(StoreError::Inconsistent {
                table: table.name,
                what: format!("{} rows of {} were copied", rows[1], rows[0]),
            });
        }
        tracing::info!(table = table.name, rows = rows[0], "copied");
        all.push(Copied {
            table: table.name,
            rows: rows[0],
        });
    }
    to.commit().await?;
    Ok(all)
}

/// The column whose values a database assigns, each once.
const ASSIGNED: &str = "sequence";

/// A column of the target.
struct Column {
    name: String,
    is_truth: bool,
}

async fn columns(on: &mut Transaction, table: &str) -> Result<Vec<Column>, StoreError> {
    let rows: Vec<(String, String)> = sql("{columns_of}").bind(table).fetch_all(on).await?;
    let columns = rows.into_iter().map(|(name, kind)| Column {
        name,
        is_truth: kind == "boolean",
    });
    Ok(columns.collect())
}

async fn count(on: &mut Transaction, table: &str) -> Result<i64, StoreError> {
    let query = AssertSqlSafe(format!("SELECT count(*) FROM {table}"));
    let (rows,) = sql(query).fetch_one(on).await?;
    Ok(rows)
}

/// The rows after one, by the order of the primary key.
async fn read(
    from: &mut Transaction,
    table: &Table,
    columns: &[Column],
    after: Option<&Cells>,
) -> Result<Vec<Cells>, StoreError> {
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let (key, names) = (table.key.join(", "), names.join(", "));
    let places = |from: usize| numbered(from, table.key.len());
    let condition = match after {
        Some(_) => format!("WHERE ({key}) > ({})", places(2)),
        None => String::new(),
    };
    let query = format!(
        "SELECT {names} FROM {} {condition} ORDER BY {key} LIMIT $1",
        table.name
    );
    let mut query = sql(AssertSqlSafe(query)).bind(table.batch);
    for name in after.iter().flat_map(|_| table.key) {
        let place = columns.iter().position(|column| column.name == *name);
        let cell = place
            .zip(after)
            .and_then(|(place, after)| after.0.get(place));
        query = query.bind(cell.unwrap_or(&Cell::Text(None)).value());
    }
    query.fetch_all(from).await
}

/// `$from, $from+1, ...`
fn numbered(from: usize, count: usize) -> String {
    let places: Vec<String> = (from..from + count)
        .map(|place| format!("${place}"))
        .collect();
    places.join(", ")
}

async fn write(
    to: &mut Transaction,
    table: &Table,
    columns: &[Column],
    rows: &[Cells],
) -> Result<(), StoreError> {
    if rows.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let count = columns.len();
    let places = (0..rows.len()).map(|row| format!("({})", numbered(row * count + 1, count)));
    let text = format!(
        "INSERT INTO {} ({}) VALUES {}",
        table.name,
        names.join(", "),
        places.collect::<Vec<_>>().join(", ")
    );
    let mut statement = sql(AssertSqlSafe(text));
    for row in rows {
        for (cell, column) in row.0.iter().zip(columns) {
            statement = statement.bind(if column.is_truth {
                cell.truth()
            } else {
                cell.value()
            });
        }
    }
    statement.execute(to).await?;
    Ok(())
}

/// The greatest number that the source has assigned, even if its row was deleted.
async fn newest_number(from: &mut Transaction, table: &str) -> Result<i64, StoreError> {
    let query = format!("SELECT coalesce(max({ASSIGNED}), 0) FROM {table}");
    let (greatest,): (i64,) = sql(AssertSqlSafe(query)).fetch_one(&mut *from).await?;
    let assigned: Option<(Option<i64>,)> = sql("{last_assigned}")
        .bind(table)
        .fetch_optional(from)
        .await?;
    let assigned = assigned.and_then(|(assigned,)| assigned).unwrap_or(0);
    Ok(greatest.max(assigned))
}

/// Has the target assign greater numbers only.
async fn go_on_after(to: &mut Transaction, table: &str, newest: i64) -> Result<(), StoreError> {
    match to {
        // The numbers of its other tables go on after the greatest that is there.
        Transaction::Sqlite(_) => {
            sql("DELETE FROM sqlite_sequence WHERE name = $1")
                .bind(table)
                .execute(&mut *to)
                .await?;
            sql(
                "INSERT INTO sqlite_sequence (name, seq) SELECT name, $2 FROM sqlite_schema \
                 WHERE name = $1 AND sql LIKE '%AUTOINCREMENT%'",
            )
            .bind(table)
            .bind(newest)
            .execute(to)
            .await?;
        }
        Transaction::Postgres(_) if newest > 0 => {
            let _: Option<(i64,)> =
                sql("SELECT setval(CAST(pg_get_serial_sequence($1, $3) AS regclass), $2)")
                    .bind(table)
                    .bind(newest)
                    .bind(ASSIGNED)
                    .fetch_optional(to)
                    .await?;
        }
        Transaction::Postgres(_) => {}
    }
    Ok(())
}
