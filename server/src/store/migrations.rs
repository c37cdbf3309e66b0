//! The history of the schema, embedded when building.
//!
//! The list replaces `sqlx::migrate!`: that macro alone had SQLite and half of sqlx compiled a second
//! time, for the compiler.

use sqlx::SqlSafeStr;
use sqlx::migrate::{Migration, MigrationType, Migrator};

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
const HISTORY: [(&str, &str, &str); 13] = [
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
];

/// What brings a database to the schema of this version.
///
/// # Panics
///
/// Never: every number of the list is one.
pub(super) fn migrator() -> Migrator {
    let history = HISTORY.into_iter().map(|(number, name, sql)| {
        Migration::new(
            number.parse().expect("the number of a migration"),
            name.replace('_', " ").into(),
            MigrationType::Simple,
            sql.into_sql_str(),
            false,
        )
    });
    Migrator::with_migrations(history.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

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
