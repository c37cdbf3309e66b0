//! Every SQL statement of the store is valid for the schema that the migrations make, in both
//! databases.
//!
//! Those of one database only, and those that are made for any table, are left out. The statements are
//! read from the sources, with the macros that lists of columns are written as, and the lists that
//! `row!` makes of fields. So a misspelt name in a statement that no other test runs fails here.

use super::on_a_store;
use crate::store::database::Database;
use crate::store::database::dialect::Dialect;
use sqlx::error::DatabaseError;
use sqlx::{AssertSqlSafe, Executor, SqlSafeStr};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const VERBS: [&str; 4] = ["DELETE", "INSERT", "SELECT", "UPDATE"];

/// SQLSTATE of values whose type is only told with them; all else of the statement is valid then.
const UNTYPED: [&str; 2] = ["42P08", "42P18"];

/// What a macro of the sources stands for.
struct Expansion<'a> {
    parameters: Vec<&'a str>,
    body: String,
}

type Macros<'a> = BTreeMap<&'a str, Expansion<'a>>;

/// What is left out of the sources: tests, the definition of `row!`, what is for one database, and
/// copies of any table.
const LEFT_OUT: [&str; 10] = [
    "tests",
    "tests.rs",
    "row.rs",
    "database",
    "database.rs",
    "notices.rs",
    "shared_clock.rs",
    "roles.rs",
    "copy",
    "copy.rs",
];

/// The sources of the store.
fn sources() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/store");
    let (mut folders, mut text) = (vec![root], String::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path: PathBuf = entry.expect("an entry").path();
            if LEFT_OUT.iter().any(|name| path.ends_with(name)) {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else {
                text += &std::fs::read_to_string(path).expect("a source");
            }
        }
    }
    text + &std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/src/store.rs"))
        .expect("a source")
}

/// The text of the string literal that a source begins with, and what follows it.
fn literal(source: &str) -> (String, &str) {
    let mut text = String::new();
    let mut rest = source.strip_prefix('"').expect("a literal");
    loop {
        let (before, after) = rest.split_at(rest.find(['"', '\\']).expect("an end"));
        text += before;
        if let Some(after) = after.strip_prefix('"') {
            return (text, after);
        }
        // The only escape in use continues the literal on the next line.
        let next_line = after.strip_prefix("\\\n").expect("a continued line");
        rest = next_line.trim_start();
    }
}

/// The macros of the sources that stand for text.
fn macros(sources: &str) -> Macros<'_> {
    let definitions = sources.split("macro_rules! ").skip(1).map(|text| {
        let (name, rest) = text.split_once(" {").expect("a name");
        let (parameters, rest) = rest.split_once("=>").expect("parameters");
        let (body, _) = rest.split_once("};").expect("a body");
        let parameters = parameters.trim().trim_matches(['(', ')']).split(", ");
        let expansion = Expansion {
            parameters: parameters
                .filter_map(|p| Some(p.split_once(':')?.0))
                .collect(),
            body: body.to_owned(),
        };
        (name, expansion)
    });
    definitions.chain(column_lists(sources)).collect()
}

/// The lists of columns that `row!` makes of the fields of a struct.
fn column_lists(sources: &str) -> impl Iterator<Item = (&str, Expansion<'_>)> {
    sources.split("\n    columns ").skip(1).map(|text| {
        let (name, rest) = text.split_once(";\n").expect("a name");
        let (_, rest) = rest.split_once("struct ").expect("a struct");
        let (fields, _) = rest.split_once("\n    }\n").expect("fields");
        let columns: Vec<&str> = fields
            .lines()
            .filter(|line| line.ends_with(','))
            .filter_map(|line| line.split_once(": ")?.0.split_whitespace().last())
            .collect();
        let expansion = Expansion {
            parameters: Vec::new(),
            body: format!("{:?}", columns.join(", ")),
        };
        (name, expansion)
    })
}

/// The arguments of a macro as they are written, and what follows the parenthesis that closes them.
fn arguments(source: &str) -> (Vec<&str>, &str) {
    let (mut given, mut begin, mut rest, mut depth) = (Vec::new(), source, source, 0);
    while let Some(next) = rest.chars().next() {
        let ends = depth == 0 && matches!(next, ',' | ')');
        if ends {
            let argument = begin[..begin.len() - rest.len()].trim();
            given.extend((!argument.is_empty()).then_some(argument));
        }
        if next == '"' {
            rest = literal(rest).1;
            continue;
        }
        rest = &rest[next.len_utf8()..];
        match next {
            ')' if ends => break,
            ',' if ends => begin = rest,
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
    }
    (given, rest)
}

/// All literals of an expression in a row, macros expanded, until its parenthesis is closed.
fn joined(source: &str, macros: &Macros) -> String {
    let (mut text, mut rest, mut depth) = (String::new(), source, 0);
    while let Some(next) = rest.chars().next() {
        let name = rest
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .next();
        let name = name.unwrap_or_default();
        if next == '"' {
            let (part, after) = literal(rest);
            (text, rest) = (text + &part, after);
        } else if let Some(Expansion { parameters, body }) = macros.get(name) {
            let (given, after) = arguments(&rest[name.len() + "!(".len()..]);
            assert_eq!(given.len(), parameters.len(), "{name}");
            let replaced = |body: String, (parameter, argument): (&&str, &&str)| {
                body.replace(*parameter, argument)
            };
            let body = parameters.iter().zip(&given).fold(body.clone(), replaced);
            (text, rest) = (text + &joined(&body, macros), after);
        } else {
            depth += i32::from(next == '(') - i32::from(next == ')');
            if depth < 0 {
                break;
            }
            rest = &rest[name.len().max(next.len_utf8())..];
        }
    }
    text
}

/// Every literal that begins with a verb of SQL, with the rest of the `concat!` that it begins.
fn statements(sources: &str) -> Vec<String> {
    let macros = macros(sources);
    let starts = VERBS.map(|verb| format!("\"{verb} "));
    let starts = starts.iter().flat_map(|start| sources.match_indices(start));
    let statement = |(place, _): (usize, &str)| {
        if sources[..place].trim_end().ends_with("concat!(") {
            joined(&sources[place..], &macros)
        } else {
            literal(&sources[place..]).0
        }
    };
    starts.map(statement).collect()
}

#[test]
fn every_statement_is_valid_for_the_schema() {
    let sources = sources();
    let statements = statements(&sources);
    let calls = sources.matches("sql(").count();
    assert!(
        statements.len() >= calls,
        "{} statements in {calls} calls",
        statements.len()
    );
    on_a_store(|store| {
        let statements = statements.clone();
        async move {
            for statement in statements {
                let text = AssertSqlSafe(statement.clone()).into_sql_str();
                let prepared = match &store.database {
                    Database::Sqlite(database) => {
                        let text = Dialect::Sqlite.of(text, 1);
                        database.writer.prepare(text).await.map(drop)
                    }
                    Database::Postgres(database) => {
                        let text = Dialect::Postgres.of(text, 1);
                        database.pool.prepare(text).await.map(drop)
                    }
                };
                let Err(error) = prepared else { continue };
                let code = error.as_database_error().and_then(DatabaseError::code);
                let untyped = code.is_some_and(|code| UNTYPED.contains(&&*code));
                assert!(untyped, "{error}: {statement}");
            }
        }
    });
}
