//! `slewplan copy`: from SQLite to Postgres and back.

use crate::postgres;
use crate::running::{Service, slewplan, small};
use std::ffi::OsStr;

/// Copies a database; the message when it was refused.
fn copied(from: &OsStr, to: &OsStr) -> Result<String, String> {
    let arguments = [
        OsStr::new("copy"),
        OsStr::new("--from"),
        from,
        OsStr::new("--to"),
        to,
    ];
    let told = slewplan(&arguments);
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    if told.status.success() {
        Ok(text(told.stdout))
    } else {
        Err(text(told.stderr))
    }
}

#[test]
fn a_service_goes_on_with_everything_on_another_database() {
    let Some(server) = postgres::new_database() else {
        return println!("not run: Postgres is not installed");
    };
    let folder = tempfile::tempdir().expect("a folder");
    let [file, back] = ["there.db", "back.db"].map(|name| folder.path().join(name));
    let (file, back, server) = (file.as_os_str(), back.as_os_str(), OsStr::new(&server));

    let mut service = Service::on_database(file, &[]);
    let id = service.submit(&small());
    service.wait_end(&id);
    let path = format!("/v1/plans/{id}/result");
    let plan = service.get(&path).expect(200).body;
    let events = service
        .get(&format!("/v1/plans/{id}/events"))
        .expect(200)
        .body;
    let refused = copied(file, server).expect_err("the file is in use");
    assert!(
        refused.contains("does another service use this database?"),
        "{refused}"
    );
    assert!(service.terminate());
    let told = copied(file, server).expect("copied");
    assert!(told.contains("           1  jobs\n"), "{told}");
    assert!(
        copied(file, server)
            .expect_err("not empty")
            .contains("is not empty")
    );

    let mut service = Service::on_database(server, &[]);
    assert_eq!(service.get(&path).expect(200).body, plan);
    assert_eq!(
        service
            .get(&format!("/v1/plans/{id}/events"))
            .expect(200)
            .body,
        events
    );
    // Its legs are known.
    let next = service.submit(&small());
    service.wait_end(&next);
    let again = service.get(&format!("/v1/plans/{next}/result")).json();
    assert_eq!(again["statistics"]["legs_solved"], 0);
    let refused = copied(server, back).expect_err("the server is in use");
    assert!(
        refused.contains("services or workers use the database"),
        "{refused}"
    );
    assert!(service.terminate());
    let told = copied(server, back).expect("copied");
    assert!(told.contains("           2  jobs\n"), "{told}");
    let service = Service::on_database(back, &[]);
    assert_eq!(service.get(&path).expect(200).body, plan);
}

#[test]
fn there_is_something_to_copy() {
    let folder = tempfile::tempdir().expect("a folder");
    let [nothing, copy] = ["nothing.db", "copy.db"].map(|name| folder.path().join(name));
    let refused = copied(nothing.as_os_str(), copy.as_os_str()).expect_err("it does not exist");
    assert!(refused.contains("cannot read the database"), "{refused}");
    assert!(!nothing.exists() && !copy.exists());
}
