//! Keys without a service.

use crate::run::{Ended, names_in, slewplan};

fn keys(arguments: &[&str], database: &str) -> Ended {
    slewplan(&[&["keys"], arguments, &["--database", database]].concat())
}

#[test]
fn only_create_creates_a_database() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("none.db");
    let database = database.to_str().expect("UTF-8");
    for arguments in [&["list"][..], &["revoke", "1f0c9a5e77d2"]] {
        let ended = keys(arguments, database).expect_code(2);
        assert!(
            ended
                .stderr
                .contains(&format!("cannot read the database {database}: ")),
            "{ended:?}"
        );
        assert_eq!(
            (ended.stderr.lines().count(), &*ended.stdout),
            (1, ""),
            "{ended:?}"
        );
        assert!(names_in(folder.path()).is_empty());
    }
    keys(&["create", "mission-a"], database).expect_code(0);
    let listed = keys(&["list"], database).expect_code(0);
    assert!(
        listed.stdout.contains("  mission-a  read write  created "),
        "{listed:?}"
    );
}

#[test]
fn the_first_key_and_the_last_say_what_they_mean() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("keys.db");
    let database = database.to_str().expect("UTF-8");
    let first = keys(&["create", "mission-a"], database).expect_code(0);
    assert!(first.stderr.contains("first key"), "{first:?}");
    assert!(!first.stderr.contains("made without keys"), "{first:?}");
    assert_eq!(first.stdout.lines().count(), 1, "{first:?}");
    let second = keys(&["create", "mission-b", "--adopt"], database).expect_code(0);
    assert!(!second.stderr.contains("first key"), "{second:?}");
    assert!(
        second
            .stderr
            .contains("mission-b now owns 0 plans and 0 spacecraft"),
        "{second:?}"
    );
    let ids = [first, second].map(|made| {
        made.stderr
            .split(' ')
            .nth(2)
            .expect("an identifier")
            .to_owned()
    });
    let revoked = keys(&["revoke", &ids[0]], database).expect_code(0);
    assert_eq!(revoked.stderr, "");
    let last = keys(&["revoke", &ids[1]], database).expect_code(0);
    assert!(
        last.stderr.contains("no valid key is left") && last.stderr.contains("keys create"),
        "{last:?}"
    );
    let twice = keys(&["revoke", &ids[1]], database).expect_code(2);
    assert!(twice.stderr.contains("could be revoked"), "{twice:?}");
}

#[test]
fn a_wrong_address_of_a_database_is_refused_without_its_password() {
    let refused = keys(&["list"], "postgres://me:secret@db.example:port/plans").expect_code(2);
    assert!(
        refused.stderr.contains("--database: not an address"),
        "{refused:?}"
    );
    assert!(!refused.stderr.contains("secret"), "{refused:?}");
}
