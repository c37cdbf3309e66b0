//! Stored spacecraft.

use crate::client::Request;
use crate::running::{Service, small};
use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, Connection};
use std::path::Path;

#[test]
fn a_spacecraft_is_stored_in_versions_and_used_by_name() {
    let service = Service::start();
    let put = |document: &Value| {
        service.send(&Request::new("PUT", "/v1/spacecraft/sat-1").json(document))
    };
    let mut document = small()["spacecraft"].clone();
    assert_eq!(put(&document).expect(201).json()["version"], 1);
    assert_eq!(put(&document).expect(200).json()["version"], 1);
    document["max_body_rate_rad_s"] = json!([0.01, 0.01, 0.01]);
    assert_eq!(put(&document).expect(200).json()["version"], 2);
    let newest = service.get("/v1/spacecraft/sat-1").expect(200).json();
    assert_eq!(
        (&newest["version"], &newest["spacecraft"]),
        (&json!(2), &document)
    );
    let first = service
        .get("/v1/spacecraft/sat-1?version=1")
        .expect(200)
        .json();
    assert_eq!(first["spacecraft"], small()["spacecraft"]);

    let plan = |spacecraft| {
        let mut scenario = small();
        scenario["spacecraft"] = spacecraft;
        let request = Request::new("POST", "/v1/plans").header("Prefer", "wait=60");
        service.send(&request.json(&scenario)).expect(200).json()
    };
    let (by_name, written_out) = (plan(json!({"ref": "sat-1"})), plan(document));
    assert_eq!(by_name["trajectory"], written_out["trajectory"]);
    let old = plan(json!({"ref": "sat-1", "version": 1}));
    assert!(old["total_time_s"].as_f64() < by_name["total_time_s"].as_f64());
}

#[test]
fn spacecraft_are_listed_by_name_page_by_page() {
    let service = Service::start();
    let mut document = small()["spacecraft"].clone();
    for name in ["sat-c", "sat-a", "Sat_b"] {
        let put = Request::new("PUT", &format!("/v1/spacecraft/{name}")).json(&document);
        service.send(&put).expect(201);
    }
    document["max_body_rate_rad_s"] = json!([0.01, 0.01, 0.01]);
    let put = Request::new("PUT", "/v1/spacecraft/sat-a").json(&document);
    let newest = service.send(&put).expect(200).json();

    let whole = service.get("/v1/spacecraft").expect(200).json();
    let listed = whole["spacecraft"].as_array().expect("a list");
    assert_eq!((listed.len(), &whole["next_cursor"]), (3, &Value::Null));
    let named = |name: &str| listed.iter().find(|one| one["name"] == name);
    let one = named("sat-a").expect("listed once");
    assert_eq!(
        (&one["version"], &one["created_at"]),
        (&json!(2), &newest["created_at"])
    );
    assert_eq!(named("Sat_b").expect("listed")["version"], 1);

    let mut paged = Vec::new();
    let mut path = "/v1/spacecraft?limit=1".to_owned();
    loop {
        let page = service.get(&path).expect(200).json();
        paged.extend(page["spacecraft"].as_array().expect("a list").clone());
        let Some(cursor) = page["next_cursor"].as_str() else {
            break;
        };
        path = format!("/v1/spacecraft?limit=1&cursor={cursor}");
    }
    assert_eq!(&paged, listed);
    for query in ["limit=0", "limit=201", "name=sat"] {
        service
            .get(&format!("/v1/spacecraft?{query}"))
            .expect_problem(400, "invalid_parameter");
    }
}

#[test]
fn wrong_spacecraft_and_unknown_names_are_refused() {
    let service = Service::start();
    let put = |name: &str, document: &Value| {
        service.send(&Request::new("PUT", &format!("/v1/spacecraft/{name}")).json(document))
    };
    let mut document = small()["spacecraft"].clone();
    put("-", &document).expect_problem(400, "invalid_parameter");
    document["wheels"][0]["max_torque_nm"] = json!(-1);
    let problem = put("sat", &document).expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/wheels/0/max_torque_nm");
    service
        .get("/v1/spacecraft/sat")
        .expect_problem(404, "not_found");
    service
        .get("/v1/spacecraft/sat?version=0")
        .expect_problem(400, "invalid_parameter");
    let mut scenario = small();
    scenario["spacecraft"] = json!({"ref": "sat"});
    let problem = service
        .post("/v1/plans", &scenario)
        .expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/spacecraft/ref");
    assert_eq!(problem["errors"][0]["code"], "unknown_reference");
}

#[test]
fn a_damaged_spacecraft_is_an_internal_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("damaged.db");
    let mut service = Service::on(&database, &[]);
    let put = Request::new("PUT", "/v1/spacecraft/sat").json(&small()["spacecraft"]);
    service.send(&put).expect(201);
    assert!(service.terminate());
    damage(&database);
    let service = Service::on(&database, &[]);
    let mut scenario = small();
    scenario["spacecraft"] = json!({"ref": "sat"});
    for answer in [
        service.get("/v1/spacecraft/sat"),
        service.post("/v1/plans", &scenario),
        service.post("/v1/verify", &json!({"scenario": scenario, "plan": {}})),
    ] {
        answer.expect_problem(500, "internal_error");
    }
}

/// Truncates the stored spacecraft.
fn damage(database: &Path) {
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    runtime.block_on(async {
        let options = SqliteConnectOptions::new().filename(database);
        let mut connection = options.connect().await.expect("a database");
        let cut = sqlx::query("UPDATE spacecraft SET document = substr(document, 1, 40)");
        let cut = cut.execute(&mut connection).await.expect("changed");
        assert_eq!(cut.rows_affected(), 1);
        connection.close().await.expect("written");
    });
}
