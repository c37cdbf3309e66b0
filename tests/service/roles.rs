//! A role of Postgres that may not change the schema.

use crate::postgres;
use crate::running::{Service, Worker, slewplan, small};
use sqlx::{AssertSqlSafe, Connection as _, Executor as _, PgConnection};

/// Executes a statement; whether the server did.
fn executed(url: &str, statement: &str) -> bool {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .expect("a runtime");
    runtime.block_on(async {
        let mut connection = PgConnection::connect(url).await.expect("connected");
        let statement = AssertSqlSafe(statement.to_owned());
        connection.execute(statement).await.is_ok()
    })
}

/// The message with which a service does not start.
fn refusal(database: &str) -> String {
    let told = slewplan(&[
        "serve",
        "--listen",
        "127.0.0.1:0",
        "--log",
        "error",
        "--database",
        database,
    ]);
    assert!(!told.status.success());
    String::from_utf8(told.stderr).expect("UTF-8")
}

#[test]
fn a_role_without_rights_on_the_schema_runs_on_one_that_is_prepared() {
    let Some(owner) = postgres::new_database() else {
        return println!("not run: Postgres is not installed");
    };
    let (_, name) = owner.split_once("localhost/").expect("an address");
    let (name, _) = name.split_once('?').expect("an address");
    // A name that has to be quoted.
    let role = format!("Runner of {name}");
    assert!(executed(&owner, &format!("CREATE ROLE \"{role}\" LOGIN")));
    let runner = owner.replace("slewplan@", &format!("{}@", role.replace(' ', "%20")));

    let told = refusal(&runner);
    assert!(told.contains("run slewplan migrate"), "{told}");
    let migrated = slewplan(&["migrate", "--database", &owner, "--grant-to", &role]);
    assert!(migrated.status.success(), "{migrated:?}");
    assert!(!executed(&runner, "CREATE TABLE mine (x INTEGER)"));
    assert!(!executed(
        &runner,
        "ALTER TABLE jobs ADD COLUMN mine INTEGER"
    ));
    assert!(!executed(&runner, "DELETE FROM _sqlx_migrations"));
    let service = Service::on_database(runner.as_ref(), &["--no-worker"]);
    let worker = Worker::on(&runner);
    let id = service.submit(&small());
    assert_eq!(service.wait_end(&id)["state"], "succeeded");
    service.get(&format!("/v1/plans/{id}/result")).expect(200);
    service.get("/metrics").expect(200);
    service.get("/health/ready").expect(200);
    drop((service, worker));

    // The next version of the program has one migration more, this one has one too many.
    let unknown = "INSERT INTO _sqlx_migrations \
         SELECT 9999, description, installed_on, success, checksum, execution_time \
         FROM _sqlx_migrations WHERE version = 1";
    assert!(executed(&owner, unknown));
    let told = refusal(&runner);
    assert!(told.contains("newer version"), "{told}");
    assert!(executed(
        &owner,
        "DELETE FROM _sqlx_migrations WHERE version >= 50"
    ));
    let told = refusal(&runner);
    assert!(told.contains("run slewplan migrate"), "{told}");
}

#[test]
fn a_file_has_no_roles() {
    let told = slewplan(&[
        "migrate",
        "--database",
        "there-is-none.db",
        "--grant-to",
        "me",
    ]);
    assert_eq!(told.status.code(), Some(2), "{told:?}");
}
