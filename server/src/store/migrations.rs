//! The history of the schema, embedded when building.
//!
//! The list replaces `sqlx::migrate!`: that macro alone had SQLite and half of sqlx compiled a second
//! time, for the compiler.

mod postgres;

use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::{AssertSqlSafe, SqlSafeStr, SqlStr};

/// A migration by its number and its file's name after it.
macro_rules! migration {
    ($number:literal, $name:literal) => {
        (
            $number,
            $name,
            include_str!(concat!("../../../migrations/", $number, "_", $name, ".sql")),
        )
    };
}

/// Number, name and statements of every migration, oldest first.
const HISTORY: [(&str, &str, &str); 20] = [
    migration!("0001", "service"),
    migration!("0002", "incumbents"),
    migration!("0003", "reversible_legs"),
    migration!("0004", "certified_legs"),
    migration!("0010", "keys"),
    migration!("0011", "retention"),
    migration!("0012", "segments"),
    migration!("0020", "end_codes"),
    migration!("0021", "legs_by_version"),
    migration!("0030", "packed_plans"),
    migration!("0031", "bound_versions"),
    migration!("0040", "keep_out_violated"),
    migration!("0041", "leg_tables"),
    migration!("0042", "turns"),
    migration!("0050", "job_memory"),
    migration!("0060", "claims"),
    migration!("0061", "leg_shards"),
    migration!("0062", "values"),
    migration!("0063", "long_names"),
    migration!("0064", "claims"),
];

/// What brings a file of SQLite to the schema of this version.
pub(super) fn of_sqlite() -> Migrator {
    migrator(SqlSafeStr::into_sql_str)
}

/// What brings a database of Postgres to the same schema.
pub(super) fn of_postgres() -> Migrator {
    migrator(|sql| AssertSqlSafe(postgres::translated(sql)).into_sql_str())
}

/// # Panics
///
/// Never: every number of the list is one.
fn migrator(statements: fn(&'static str) -> SqlStr) -> Migrator {
    let history = HISTORY.into_iter().map(|(number, name, sql)| {
        Migration::new(
            number.parse().expect("the number of a migration"),
            name.replace('_', " ").into(),
            MigrationType::Simple,
            statements(sql),
            false,
        )
    });
    Migrator::with_migrations(history.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A database knows a migration by the hash of its text.
    #[test]
    fn what_postgres_was_given_never_changes() {
        let digest = |(number, _, sql): (&str, &str, &str)| {
            let digest = crate::base::digest::hex(postgres::translated(sql).as_bytes());
            format!("{number} {}", &digest[..16])
        };
        let expected = [
            "0001 f549da8d7428ec11",
            "0002 dc6ac33d4b9d2889",
            "0003 f2d9624a160f57c7",
            "0004 c4f048d307439bb5",
            "0010 59913a2987cf6205",
            "0011 3da85bc3c7c03405",
            "0012 2f5c1177179c7f2e",
            "0020 452afa48440d9ca1",
            "0021 a7703686c2fba2c6",
            "0030 00735ad2a59dc402",
            "0031 99e96e66209b6c73",
            "0040 724aa5a27540676d",
            "0041 b608bff618f759ca",
            "0042 7e2e9a45d65381cb",
            "0050 d0ab5f87f886f332",
            "0060 74212811e78bc568",
            "0061 ab0b578c3136576b",
            "0062 b73772fbc555dfca",
            "0063 ea6ef3970dd1d923",
            "0064 e96aabef7352f08a",
        ];
        assert_eq!(HISTORY.map(digest), expected);
    }

    #[test]
    fn the_list_names_every_file_of_the_folder_in_order() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../migrations");
        let names = std::fs::read_dir(folder).expect("a folder").map(|entry| {
            let name = entry.expect("readable").file_name();
            name.into_string().expect("plain text")
        });
        let mut files: Vec<String> = names.filter(|name| name != "README.md").collect();
        files.sort();
        let listed = HISTORY.map(|(number, name, _)| format!("{number}_{name}.sql"));
        assert_eq!(files, listed);
    }
}
