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

const WORDS: [Word; 5] = [
    // Rows that are read in order to be written by the same transaction.
    Word {
        name: "{for_update}",
        sqlite: "",
        postgres: "FOR UPDATE",
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
    // The texts of a JSON array as rows `asked (key, value)`, counted from 0, each with its leg.
    Word {
        name: "{legs_asked_for}",
        sqlite: "json_each($1) AS asked CROSS JOIN legs INDEXED BY leg_times \
             ON legs.key = asked.value",
        postgres: "(SELECT place - 1 AS key, value \
             FROM jsonb_array_elements_text(CAST($1 AS jsonb)) WITH ORDINALITY \
             AS element (value, place)) AS asked JOIN legs ON legs.key = asked.value",
    },
];

impl Dialect {
    /// The statement in this language.
    pub(in crate::store) fn of(self, statement: SqlStr) -> SqlStr {
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
        AssertSqlSafe(text).into_sql_str()
    }
}
