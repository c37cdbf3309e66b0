//! A server that is away, that only reads, and a schema of a newer version.

use super::{ID, change, on_a_store, on_an_address, open, postgres, runtime, sql, submitted};
use crate::store::{DatabaseAddress, Store, StoreError};
use sqlx::AssertSqlSafe;
use std::ffi::OsString;

#[test]
fn the_store_recovers_from_the_loss_of_its_server() {
    let Some(mut server) = postgres::Server::start() else {
        return println!("not run: Postgres is not installed");
    };
    let address = OsString::from(server.new_database());
    let address = DatabaseAddress::try_from(address).expect("an address");
    let runtime = runtime();
    let store = runtime.block_on(async {
        let store = open(&address).await;
        submitted(&store).await;
        store
    });
    for _ in 0..2 {
        server.kill();
        let read = runtime.block_on(store.job(ID)).expect_err("it is away");
        assert!(read.is_away(), "{read}");
        let written = runtime.block_on(store.check_writable(2));
        let written = written.expect_err("it is away");
        assert!(written.is_away(), "{written}");
        server.restart();
        runtime.block_on(async {
            store.check_writable(3).await.expect("it is back");
            store.job(ID).await.expect("read").expect("there");
        });
    }
}

#[test]
fn a_database_that_only_reads_is_told_from_a_failure() {
    on_a_store(|store| async move {
        if !store.is_shared() {
            return;
        }
        submitted(&store).await;
        let mut transaction = store.begin().await.expect("begun");
        sql("SET TRANSACTION READ ONLY")
            .execute(&mut *transaction)
            .await
            .expect("set");
        let error = sql("DELETE FROM jobs")
            .execute(&mut *transaction)
            .await
            .expect_err("it only reads");
        assert!(error.is_read_only() && !error.is_away(), "{error}");
    });
}

#[test]
fn errors_of_a_server_are_told_apart() {
    on_a_store(|store| async move {
        if !store.is_shared() {
            return;
        }
        for (code, kind) in [
            ("08006", "away"),
            ("28P01", "away"),
            ("3D000", "away"),
            ("53300", "away"),
            ("55000", "away"),
            ("57P02", "away"),
            ("58030", "away"),
            ("53100", "full"),
            ("25006", "read-only"),
            ("40001", "busy"),
            ("57014", "busy"),
            ("23505", "none"),
        ] {
            let raise = format!("DO $$ BEGIN RAISE EXCEPTION USING ERRCODE = '{code}'; END $$");
            let mut transaction = store.begin().await.expect("begun");
            let raised = sql(AssertSqlSafe(raise)).execute(&mut *transaction).await;
            let error = raised.expect_err("it is raised");
            let found = [
                ("away", error.is_away()),
                ("full", error.is_disk_full()),
                ("read-only", error.is_read_only()),
                ("busy", error.is_busy()),
            ];
            for (name, is) in found {
                assert_eq!(is, name == kind, "{code}: {name}");
            }
        }
    });
}

#[test]
fn a_schema_of_a_newer_version_is_refused() {
    on_an_address(async |address| {
        let store = open(&address).await;
        let newer = "UPDATE _sqlx_migrations SET version = 9999 \
             WHERE version = (SELECT max(version) FROM _sqlx_migrations)";
        change(&store, sql(newer)).await;
        store.close().await;
        let refused = Store::open(&address, super::state_of).await;
        let error = refused.expect_err("it is newer");
        assert!(matches!(error, StoreError::NewerSchema(9999)), "{error}");
    });
}
