//! Keys and scopes.

use crate::client::{Answer, Request};
use crate::running::{Service, pause, small};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};
use tempfile::TempDir;

fn slewplan(arguments: &[&str], database: &Path) -> Output {
    let ended = Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .args(arguments)
        .arg("--database")
        .arg(database)
        .output();
    ended.expect("the binary starts")
}

/// A new key.
fn key(database: &Path, arguments: &[&str]) -> String {
    let made = slewplan(&[&["keys", "create"], arguments].concat(), database);
    assert!(made.status.success(), "{made:?}");
    String::from_utf8(made.stdout)
        .expect("ASCII")
        .trim()
        .to_owned()
}

fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("keys.db");
    (folder, database)
}

fn request(method: &str, path: &str, key: &str) -> Request {
    Request::new(method, path).header("Authorization", &format!("Bearer {key}"))
}

/// Every operation of the description, with an identifier in the place of each parameter.
fn operations(id: &str) -> Vec<(String, String)> {
    let description = slewplan_openapi();
    let paths = description["paths"].as_object().expect("paths");
    let methods = |(path, item): (&String, &Value)| {
        let path = path
            .replace("{id}", id)
            .replace("{key}", &"0".repeat(64))
            .replace("{name}", "some");
        let item = item.as_object().expect("operations").clone();
        item.into_iter()
            .map(move |(method, _)| (method.to_uppercase(), path.clone()))
    };
    paths.iter().flat_map(methods).collect()
}

fn slewplan_openapi() -> Value {
    let text = include_str!("../../openapi.yaml");
    yaml_serde::from_str(text).expect("the description is YAML")
}

const PUBLIC: [&str; 7] = [
    "/",
    "/health/live",
    "/health/ready",
    "/openapi.yaml",
    "/docs/errors",
    "/v1/version",
    "/v1/limits",
];

#[test]
fn every_route_needs_a_valid_key() {
    let (_folder, database) = folder();
    let owner = key(&database, &["owner"]);
    let revoked = key(&database, &["owner"]);
    let list = slewplan(&["keys", "list"], &database).stdout;
    let list = String::from_utf8(list).expect("ASCII");
    let last = list.lines().last().expect("two keys");
    let id = last.split(' ').next().expect("its name");
    assert!(
        slewplan(&["keys", "revoke", id], &database)
            .status
            .success()
    );
    assert!(
        !slewplan(&["keys", "revoke", id], &database)
            .status
            .success()
    );

    let service = Service::on(&database, &[]);
    let submission = request("POST", "/v1/plans", &owner).json(&small());
    let job = service.send(&submission).expect(202).json();
    let job = job["id"].as_str().expect("an identifier");
    for (method, path) in operations(job) {
        let without = service.send(&Request::new(&method, &path));
        if PUBLIC.contains(&&*path) {
            without.expect(200);
            continue;
        }
        assert_eq!(without.header("www-authenticate"), Some("Bearer"));
        without.expect_problem(401, "unauthorized");
        for wrong in ["", "slewplan_00", &owner[1..], &revoked] {
            let answer = service.send(&request(&method, &path, wrong));
            answer.expect_problem(401, "unauthorized");
        }
    }
    let ended = |job: &Value| !job["finished_at"].is_null();
    let path = format!("/v1/plans/{job}");
    while !ended(
        &service
            .send(&request("GET", &path, &owner))
            .expect(200)
            .json(),
    ) {}
    let stored = std::fs::read(&database).expect("the database");
    let log = std::fs::read(database.with_extension("db-wal")).unwrap_or_default();
    for secret in [&owner, &revoked] {
        let secret = secret.as_bytes();
        let found = |bytes: &[u8]| bytes.windows(secret.len()).any(|part| part == secret);
        assert!(!found(&stored) && !found(&log));
    }
}

#[test]
fn the_page_opens_without_a_key_and_then_asks_for_one() {
    let (_folder, database) = folder();
    key(&database, &["owner"]);
    let service = Service::on(&database, &[]);
    let page = service.get("/").expect(200).body;
    let file = page.split('"').find(|text| text.ends_with("main.js"));
    service.get(file.expect("its script")).expect(200);
    service.get("/v1/plans").expect_problem(401, "unauthorized");
}

#[test]
fn clients_do_not_see_each_others_jobs_and_spacecraft() {
    let (_folder, database) = folder();
    let mine = key(&database, &["mine"]);
    let replacement = key(&database, &["mine"]);
    let other = key(&database, &["other", "--scopes", "read,write,operate"]);
    let service = Service::on(&database, &[]);
    let keyed = |key: &str| request("POST", "/v1/plans", key).header("Idempotency-Key", "same");
    let submit = |key: &str| -> Answer { service.send(&keyed(key).json(&small())).expect(202) };
    let job = submit(&mine).json()["id"].as_str().expect("id").to_owned();
    assert_ne!(submit(&other).json()["id"], json!(job));
    let path = format!("/v1/plans/{job}");
    service
        .send(&request("GET", &path, &replacement))
        .expect(200);
    for (method, path) in operations(&job) {
        if path.starts_with("/v1/plans/") {
            let answer = service.send(&request(&method, &path, &other));
            answer.expect_problem(404, "not_found");
        }
    }
    let list = |key: &str| {
        service
            .send(&request("GET", "/v1/plans", key))
            .expect(200)
            .json()
    };
    assert_eq!(list(&other)["plans"].as_array().map(Vec::len), Some(1));
    assert_eq!(list(&mine)["plans"][0]["id"], json!(job));

    let spacecraft = small()["spacecraft"].clone();
    let put = request("PUT", "/v1/spacecraft/some", &mine).json(&spacecraft);
    service.send(&put).expect(201);
    let get = |key: &str| service.send(&request("GET", "/v1/spacecraft/some", key));
    get(&mine).expect(200);
    get(&other).expect_problem(404, "not_found");
    let names = |key: &str| {
        let listed = service.send(&request("GET", "/v1/spacecraft", key));
        let listed = listed.expect(200).json();
        let names = listed["spacecraft"].as_array().expect("a list").iter();
        names.map(|one| one["name"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&mine), ["some"]);
    assert!(names(&other).is_empty());
    let mut scenario = small();
    scenario["spacecraft"] = json!({"ref": "some"});
    let submission = request("POST", "/v1/plans", &other).json(&scenario);
    service
        .send(&submission)
        .expect_problem(422, "invalid_input");
}

#[test]
fn a_key_grants_its_scopes_only() {
    let (_folder, database) = folder();
    let reader = key(&database, &["one", "--scopes", "read", "--expires", "1"]);
    let operator = key(&database, &["one", "--scopes", "operate"]);
    let writer = key(&database, &["one"]);
    let service = Service::on(&database, &[]);
    let send = |method, path, key: &str| service.send(&request(method, path, key));
    send("GET", "/v1/plans", &reader).expect(200);
    send("POST", "/v1/plans", &reader).expect_problem(403, "scope_missing");
    send("GET", "/metrics", &reader).expect_problem(403, "scope_missing");
    send("GET", "/metrics", &operator).expect(200);
    send("GET", "/v1/plans", &operator).expect_problem(403, "scope_missing");
    send("POST", "/v1/legs/import", &writer).expect_problem(403, "scope_missing");
    send("POST", "/v1/legs/import", &operator).expect_problem(415, "unsupported_media_type");
}

#[test]
fn a_client_has_its_own_queue_limit() {
    let (_folder, database) = folder();
    let [greedy, modest] = ["greedy", "modest"].map(|client| key(&database, &[client]));
    let service = Service::on(&database, &["--client-queue-limit", "0"]);
    for key in [greedy, modest] {
        let answer = service.send(&request("POST", "/v1/plans", &key).json(&small()));
        assert!(answer.header("retry-after").is_some());
        answer.expect_problem(429, "quota_exceeded");
    }
}

#[test]
fn public_addresses_need_keys() {
    let (_folder, database) = folder();
    let anywhere = ["serve", "--listen", "0.0.0.0:0"];
    let refused = slewplan(&anywhere, &database);
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8_lossy(&refused.stderr);
    assert!(said.contains("slewplan keys create"), "{said}");
    let open = Service::on(&database, &["--listen", "0.0.0.0:0", "--no-keys"]);
    drop(open);
    key(&database, &["somebody"]);
    let closed = Service::on(&database, &["--listen", "0.0.0.0:0"]);
    closed.get("/v1/plans").expect_problem(401, "unauthorized");
}

#[test]
fn a_running_service_requires_keys_after_the_first_one() {
    let (_folder, database) = folder();
    let service = Service::on(&database, &[]);
    service.get("/v1/plans").expect(200);
    let secret = key(&database, &["someone"]);
    let begin = Instant::now();
    while service.get("/v1/plans").status != 401 {
        assert!(begin.elapsed() < Duration::from_secs(30), "still open");
        pause();
    }
    service
        .send(&request("GET", "/v1/plans", &secret))
        .expect(200);
}

/// What a key of a client is told on its making, besides the key.
fn told(database: &Path, arguments: &[&str]) -> (String, String) {
    let made = slewplan(&[&["keys", "create"], arguments].concat(), database);
    assert!(made.status.success(), "{made:?}");
    let [key, told] =
        [made.stdout, made.stderr].map(|text| String::from_utf8(text).expect("ASCII"));
    (key.trim().to_owned(), told)
}

#[test]
fn plans_made_without_keys_are_hidden_until_a_client_adopts_them() {
    let (_folder, database) = folder();
    let keyed = Request::new("POST", "/v1/plans").header("Idempotency-Key", "once");
    let mut spacecraft = small()["spacecraft"].clone();
    let service = Service::on(&database, &[]);
    let job = service.send(&keyed.json(&small())).expect(202).json();
    let job = job["id"].as_str().expect("an identifier").to_owned();
    let result = format!("/v1/plans/{job}/result");
    service.wait_end(&job);
    for name in ["one", "two"] {
        let path = format!("/v1/spacecraft/{name}");
        service
            .send(&Request::new("PUT", &path).json(&spacecraft))
            .expect(201);
    }
    spacecraft["boresights"][0]["name"] = json!("imager");
    service
        .send(&Request::new("PUT", "/v1/spacecraft/one").json(&spacecraft))
        .expect(200);
    drop(service);

    let (first, said) = told(&database, &["first"]);
    for part in [
        "1 plan and 2 spacecraft",
        "keys create first --adopt",
        "first key",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let service = Service::on(&database, &[]);
    let get = |path: &str, key: &str| service.send(&request("GET", path, key));
    get(&result, &first).expect_problem(404, "not_found");
    get("/v1/spacecraft/one", &first).expect_problem(404, "not_found");
    // This name is the client's own, so that nothing may take its place.
    service
        .send(&request("PUT", "/v1/spacecraft/two", &first).json(&spacecraft))
        .expect(201);

    let (second, said) = told(&database, &["first", "--adopt"]);
    for part in [
        "first now owns 1 plan and 1 spacecraft",
        "0 plans and 1 spacecraft",
        "stay hidden",
    ] {
        assert!(said.contains(part), "{said}");
    }
    assert!(!said.contains("first key"), "{said}");
    for key in [&first, &second] {
        get(&result, key).expect(200);
        let version = |path: &str| get(path, key).expect(200).json()["version"].clone();
        assert_eq!(version("/v1/spacecraft/one"), 2);
        assert_eq!(version("/v1/spacecraft/one?version=1"), 1);
        assert_eq!(version("/v1/spacecraft/two"), 1);
        let own = get("/v1/spacecraft/two", key).json();
        assert_eq!(own["spacecraft"]["boresights"][0]["name"], "imager");
    }
    // The same request as before the keys is answered with the same job.
    let again = request("POST", "/v1/plans", &second).header("Idempotency-Key", "once");
    let again = service.send(&again.json(&small())).expect(202);
    assert_eq!(again.json()["id"], json!(job));

    let (other, said) = told(&database, &["other", "--adopt"]);
    assert!(
        said.contains("other now owns 0 plans and 1 spacecraft"),
        "{said}"
    );
    get(&result, &other).expect_problem(404, "not_found");
    get("/v1/spacecraft/two", &other).expect(200);
    assert!(!told(&database, &["other"]).1.contains("without keys"));
}

#[test]
fn a_service_whose_last_key_is_revoked_says_the_way_back() {
    let (_folder, database) = folder();
    let keys = [&["owner"][..], &["owner", "--expires", "1"]].map(|arguments| {
        let (key, said) = told(&database, arguments);
        let id = said.split(' ').nth(2).expect("its identifier").to_owned();
        (key, id)
    });
    let mut service = Service::on(&database, &[]);
    let submission = request("POST", "/v1/plans", &keys[0].0).json(&small());
    let job = service.send(&submission).expect(202).json();
    let path = format!("/v1/plans/{}", job["id"].as_str().expect("an identifier"));
    let revoke = |id: &str| {
        let ended = slewplan(&["keys", "revoke", id], &database);
        assert!(ended.status.success(), "{ended:?}");
        String::from_utf8(ended.stderr).expect("ASCII")
    };
    assert_eq!(revoke(&keys[0].1), "");
    let said = revoke(&keys[1].1);
    for part in [
        "no valid key is left",
        "slewplan keys create",
        "serve --no-keys",
    ] {
        assert!(said.contains(part), "{said}");
    }
    for _ in 0..2 {
        for (key, _) in &keys {
            let answer = service.send(&request("GET", &path, key));
            answer.expect_problem(401, "unauthorized");
        }
        drop(service);
        service = Service::on(&database, &[]);
    }
    // As it says: a new key of the same client, or no keys at all.
    let (key, said) = told(&database, &["owner"]);
    assert!(!said.contains("first key"), "{said}");
    service.send(&request("GET", &path, &key)).expect(200);
    drop(service);
    let open = Service::on(&database, &["--no-keys"]);
    open.get(&path).expect(200);
}
