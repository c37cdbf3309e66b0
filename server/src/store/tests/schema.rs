//! Both databases have the same tables, columns, keys, constraints and indexes.

use super::{on_a_store, sql};
use crate::store::Store;
use crate::store::database::Database;
use std::collections::BTreeSet;
use std::sync::Mutex;

/// What a schema has, a line each: type, nullity and default of columns, keys, references, indexes,
/// and the number of conditions of a table. The languages differ in little more than catalogues.
struct Catalogue {
    columns: &'static str,
    primary_keys: &'static str,
    references: &'static str,
    indexes: &'static str,
    checks: &'static str,
}

const SQLITE: Catalogue = Catalogue {
    columns: "SELECT t.name || '.' || c.name || ' ' || c.type || ' ' || \
         (c.\"notnull\" OR c.pk > 0) || ' ' || coalesce(c.dflt_value, '') \
         FROM sqlite_schema t, pragma_table_info(t.name) c WHERE t.type = 'table'",
    primary_keys: "SELECT t.name || ' key ' || group_concat(c.name ORDER BY c.pk) \
         FROM sqlite_schema t, pragma_table_info(t.name) c \
         WHERE t.type = 'table' AND c.pk > 0 GROUP BY t.name",
    references: "SELECT t.name || '.' || f.\"from\" || ' of ' || f.\"table\" || '.' || f.\"to\" \
         || ' ' || f.on_delete \
         FROM sqlite_schema t, pragma_foreign_key_list(t.name) f WHERE t.type = 'table'",
    indexes: "SELECT t.name || ' ' || CASE i.origin WHEN 'c' THEN i.name ELSE '' END || ' on ' || \
         (SELECT group_concat(name) FROM pragma_index_info(i.name)) || ' ' || i.\"unique\" || ' ' \
         || i.partial FROM sqlite_schema t, pragma_index_list(t.name) i \
         WHERE t.type = 'table' AND i.origin <> 'pk'",
    checks: "SELECT name || ' checks ' || \
         ((length(sql) - length(replace(sql, 'CHECK (', ''))) / length('CHECK (')) \
         FROM sqlite_schema WHERE type = 'table'",
};

const POSTGRES: Catalogue = Catalogue {
    columns: "SELECT table_name || '.' || column_name || ' ' || CASE data_type \
         WHEN 'bigint' THEN 'INTEGER' WHEN 'boolean' THEN 'INTEGER' WHEN 'text' THEN 'TEXT' \
         WHEN 'double precision' THEN 'REAL' WHEN 'bytea' THEN 'BLOB' ELSE data_type END || ' ' || \
         CASE is_nullable WHEN 'NO' THEN 1 ELSE 0 END || ' ' || \
         CASE column_default WHEN 'false' THEN 'FALSE' \
         ELSE split_part(coalesce(column_default, ''), '::', 1) END \
         FROM information_schema.columns WHERE table_schema = current_schema()",
    primary_keys: "SELECT t.relname || ' key ' || (SELECT string_agg(a.attname, ',' ORDER BY k.n) \
         FROM unnest(i.indkey) WITH ORDINALITY AS k (number, n) \
         JOIN pg_attribute a ON a.attrelid = t.oid AND a.attnum = k.number) \
         FROM pg_index i JOIN pg_class t ON t.oid = i.indrelid \
         WHERE i.indisprimary AND t.relnamespace = CAST(current_schema() AS regnamespace)",
    references: "SELECT t.relname || '.' || a.attname || ' of ' || r.relname || '.' || b.attname \
         || ' ' || CASE c.confdeltype WHEN 'c' THEN 'CASCADE' WHEN 'a' THEN 'NO ACTION' \
         ELSE 'other' END FROM pg_constraint c \
         JOIN pg_class t ON t.oid = c.conrelid JOIN pg_class r ON r.oid = c.confrelid \
         JOIN pg_attribute a ON a.attrelid = t.oid AND a.attnum = c.conkey[1] \
         JOIN pg_attribute b ON b.attrelid = r.oid AND b.attnum = c.confkey[1] \
         WHERE c.contype = 'f'",
    indexes: "SELECT t.relname || ' ' || CASE WHEN i.indisunique THEN '' ELSE x.relname END || ' on ' \
         || (SELECT string_agg(a.attname, ',' ORDER BY k.n) \
         FROM unnest(i.indkey) WITH ORDINALITY AS k (number, n) \
         JOIN pg_attribute a ON a.attrelid = t.oid AND a.attnum = k.number) || ' ' \
         || CAST(i.indisunique AS integer) || ' ' || CASE WHEN i.indpred IS NULL THEN 0 ELSE 1 END \
         FROM pg_index i JOIN pg_class t ON t.oid = i.indrelid JOIN pg_class x ON x.oid = i.indexrelid \
         WHERE NOT i.indisprimary AND t.relnamespace = CAST(current_schema() AS regnamespace)",
    checks: "SELECT t.relname || ' checks ' || count(c.oid) FROM pg_class t \
         LEFT JOIN pg_constraint c ON c.conrelid = t.oid AND c.contype = 'c' \
         WHERE t.relkind = 'r' AND t.relnamespace = CAST(current_schema() AS regnamespace) \
         GROUP BY t.relname",
};

/// Tables of the databases themselves, and of sqlx.
const FOREIGN: [&str; 2] = ["_sqlx_migrations", "sqlite_"];

async fn schema(store: &Store) -> BTreeSet<String> {
    let catalogue = match &store.database {
        Database::Sqlite(_) => SQLITE,
        Database::Postgres(_) => POSTGRES,
    };
    let mut lines = BTreeSet::new();
    for query in [
        catalogue.columns,
        catalogue.primary_keys,
        catalogue.references,
        catalogue.indexes,
        catalogue.checks,
    ] {
        let rows: Vec<(String,)> = sql(query)
            .fetch_all(&store.database)
            .await
            .expect("a catalogue");
        let rows = rows.into_iter().map(|(line,)| line.trim_end().to_owned());
        lines.extend(rows.filter(|line| !FOREIGN.iter().any(|name| line.starts_with(name))));
    }
    lines
}

#[test]
fn both_databases_have_the_same_schema() {
    let schemas = Mutex::new(Vec::new());
    on_a_store(|store| {
        let schemas = &schemas;
        async move {
            let schema = schema(&store).await;
            assert!(schema.len() > 100, "{schema:#?}");
            schemas.lock().expect("alone").push(schema);
        }
    });
    let schemas = schemas.into_inner().expect("alone");
    if let [sqlite, postgres] = &schemas[..] {
        let only =
            |one: &BTreeSet<String>, other| one.difference(other).cloned().collect::<Vec<_>>();
        let differences = [only(sqlite, postgres), only(postgres, sqlite)];
        assert_eq!(differences, [const { Vec::<String>::new() }; 2]);
    }
}
