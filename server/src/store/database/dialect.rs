//! The words of statements that differ between the databases.

use sqlx::{AssertSqlSafe, SqlSafeStr as _, SqlStr};

/// One of the two languages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::store) enum Dialect {
    /// SQLite, whose write transactions follow one another.
    Sqlite,
    /// Postgres, whose transactions overlap.
    Postgres,
}

/// A word in braces, and what it stands for in SQLite and in Postgres.
struct Word {
    name: &'static str,
    sqlite: &'static str,
    postgres: &'static str,
}

const WORDS: [Word; 9] = [
    // Rows that are read in order to be written by the same transaction.
    Word {
        name: "{for_update}",
        sqlite: "",
        postgres: "FOR UPDATE",
    },
    Word {
        name: "{for_update_of_jobs}",
        sqlite: "",
        postgres: "FOR UPDATE OF jobs",
    },
    // The same, without those that another transaction has chosen.
    Word {
        name: "{skip_locked}",
        sqlite: "",
        postgres: "FOR UPDATE SKIP LOCKED",
    },
    // Name and type of the columns of a table, in their order.
    Word {
        name: "{columns_of}",
        sqlite: "SELECT name, lower(type) FROM pragma_table_info($1) ORDER BY cid",
        postgres: "SELECT CAST(column_name AS text), CAST(data_type AS text) \
             FROM information_schema.columns \
             WHERE table_schema = current_schema() AND table_name = $1 ORDER BY ordinal_position",
    },
    // The newest number that was assigned to a row of a table, where the database remembers it.
    Word {
        name: "{last_assigned}",
        sqlite: "SELECT seq FROM sqlite_sequence WHERE name = $1",
        postgres: "SELECT pg_sequence_last_value(CAST(pg_get_serial_sequence($1, 'sequence') \
             AS regclass))",
    },
    // The texts of a JSON array as rows `asked (place, wanted)`, counted from 0.
    Word {
        name: "{asked}",
        sqlite: "(SELECT key AS place, value AS wanted FROM json_each($1)) AS asked",
        postgres: "(SELECT element.place - 1 AS place, wanted \
             FROM jsonb_array_elements_text(CAST($1 AS jsonb)) WITH ORDINALITY \
             AS element (wanted, place)) AS asked",
    },
    // Their legs, which are found by their keys one after the other, or by the index that has the times
    // too: without statistics Postgres would read the whole table.
    Word {
        name: "{with_legs}",
        sqlite: "CROSS JOIN legs ON legs.key = wanted",
        postgres: "CROSS JOIN LATERAL (SELECT * FROM legs WHERE key = wanted LIMIT 1) AS legs",
    },
    Word {
        name: "{with_leg_times}",
        sqlite: "CROSS JOIN legs INDEXED BY leg_times ON legs.key = wanted",
        postgres: "CROSS JOIN LATERAL (SELECT * FROM legs WHERE key = wanted LIMIT 1) AS legs",
    },
    // The type of bytes.
    Word {
        name: "{bytes}",
        sqlite: "blob",
        postgres: "bytea",
    },
];

/// How the place of rows in a statement begins.
const ROWS: &str = "{rows $";

impl Dialect {
    /// The statement in this language, with a number of rows of values.
    ///
    /// `{rows $3 job bigint, plan {bytes}}` stands for a table of as many rows with the columns `job` and
    /// `plan`: its values are `$3`, `$4` in the first row, `$5`, `$6` in the second, and so on.
    pub(in crate::store) fn of(self, statement: SqlStr, rows: usize) -> SqlStr {
        if !statement.as_str().contains('{') {
            return statement;
        }
        let mut text = statement.as_str().to_owned();
        for word in &WORDS {
            let meant = match self {
                Self::Sqlite => word.sqlite,
                Self::Postgres => word.postgres,
            };
            text = text.replace(word.name, meant);
        }
        if let Some(with_rows) = with_rows(&text, rows) {
            text = with_rows;
        }
        AssertSqlSafe(text).into_sql_str()
    }
}

/// A statement with its rows written out; `None` when it has none.
fn with_rows(text: &str, rows: usize) -> Option<String> {
    let (before, rest) = text.split_once(ROWS)?;
    let (declared, after) = rest.split_once('}')?;
    let (first, columns) = declared.split_once(' ')?;
    let first: usize = first.parse().ok()?;
    let columns: Vec<(&str, &str)> = columns
        .split(", ")
        .filter_map(|column| column.split_once(' '))
        .collect();
    let row = |row: usize| {
        let value = |(column, (_, kind)): (usize, &(&str, &str))| {
            let number = first + row * columns.len() + column;
            format!("CAST(${number} AS {kind})")
        };
        let values: Vec<_> = columns.iter().enumerate().map(value).collect();
        format!("({})", values.join(", "))
    };
    let rows: Vec<_> = (0..rows).map(row).collect();
    let name =
        |(number, (name, _)): (usize, &(&str, &str))| format!("column{} AS {name}", number + 1);
    let names: Vec<_> = columns.iter().enumerate().map(name).collect();
    let (names, rows) = (names.join(", "), rows.join(", "));
    Some(format!(
        "{before}(SELECT {names} FROM (VALUES {rows}) AS given){after}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_written_out_with_numbered_values() {
        let statement =
            "INSERT INTO t SELECT job, plan FROM {rows $3 job bigint, plan {bytes}} AS new";
        let expected = "INSERT INTO t SELECT job, plan FROM (SELECT column1 AS job, column2 AS plan \
             FROM (VALUES (CAST($3 AS bigint), CAST($4 AS bytea)), \
             (CAST($5 AS bigint), CAST($6 AS bytea))) AS given) AS new";
        let written = Dialect::Postgres.of(statement.into_sql_str(), 2);
        assert_eq!(written.as_str(), expected);
        let plain = "SELECT 1".into_sql_str();
        assert_eq!(Dialect::Sqlite.of(plain, 2).as_str(), "SELECT 1");
    }
}
