//! Exports of results.

use crate::client::Request;
use crate::running::{Service, small};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, Connection};
use std::path::Path;

const TYPES: [(&str, &str, &str); 7] = [
    ("csv", "text/csv", "time_s,"),
    ("aem-kvn", "text/x.ccsds.aem.kvn", "CCSDS_AEM_VERS"),
    ("aem-xml", "application/x.ccsds.aem+xml", "<?xml "),
    ("basilisk", "text/x.basilisk.waypoints", "0.000000000,"),
    ("open-mct", "application/x.open-mct.plan+json", "{"),
    ("stk", "text/x.stk.attitude", "stk.v.8.0"),
    ("wheel-rpm", "text/tab-separated-values", "0\t"),
];

#[test]
fn every_format_is_selected_by_name_and_by_media_type() {
    let service = Service::start();
    let id = service.submit(&small());
    service.wait_end(&id);
    let path = format!("/v1/plans/{id}/result");
    let mut tags = vec![
        service
            .get(&path)
            .expect(200)
            .header("etag")
            .map(str::to_owned),
    ];
    for (name, media_type, begin) in TYPES {
        let named = service.get(&format!("{path}?format={name}")).expect(200);
        assert!(named.body.starts_with(begin), "{name}");
        let told = named.header("content-type").expect("a media type");
        assert_eq!(told.split(';').next(), Some(media_type));
        let file = named.header("content-disposition").expect("a file name");
        assert!(
            file.starts_with(&format!("attachment; filename=\"{id}.")),
            "{file}"
        );
        let accepting = Request::new("GET", &path).header("Accept", media_type);
        // Byte for byte, because they have the same entity tag.
        assert_eq!(service.send(&accepting).expect(200).body, named.body);
        let tag = named.header("etag").expect("a tag").to_owned();
        let again = Request::new("GET", &format!("{path}?format={name}"));
        service
            .send(&again.header("If-None-Match", &tag))
            .expect(304);
        tags.push(Some(tag));
    }
    tags.sort();
    tags.dedup();
    assert_eq!(tags.len(), TYPES.len() + 1);
}

#[test]
fn options_of_formats_are_applied() {
    let service = Service::start();
    let id = service.submit(&small());
    service.wait_end(&id);
    let path = format!("/v1/plans/{id}/result");
    let get = |query: &str| service.get(&format!("{path}?{query}"));
    let rows = |query: &str| get(query).expect(200).body.lines().count();
    assert!(rows("format=csv&step_s=1") < rows("format=csv&step_s=0.1"));
    assert!(rows("format=csv&tolerance=1e-3") < rows("format=csv"));
    let named = get("format=aem-kvn&object_id=2026-001A&rates=false").expect(200);
    assert!(named.body.contains("OBJECT_ID = 2026-001A"));
    assert!(named.body.contains("ATTITUDE_TYPE = QUATERNION\n"));
    assert_ne!(
        named.header("etag"),
        get("format=aem-kvn").expect(200).header("etag")
    );
    for wrong in [
        "format=xml",
        "format=csv&step_s=0",
        "format=csv&tolerance=2",
        "format=csv&wheel=x",
        // Each is valid alone, but not together.
        "format=csv&step_s=1&tolerance=1e-3",
        "format=csv&wheel=0",
        "format=wheel-rpm&wheel=9",
        "format=stk&object_name=a",
        "step_s=1",
    ] {
        get(wrong).expect_problem(400, "invalid_parameter");
    }
}

#[test]
fn labels_that_a_format_cannot_represent_are_told() {
    let service = Service::start();
    let mut scenario = small();
    scenario["time_system"] = "TAI".into();
    scenario["epoch"] = "2026-01-01T00:00:00".into();
    let id = service.submit(&scenario);
    service.wait_end(&id);
    let path = format!("/v1/plans/{id}/result");
    let refused = service.get(&format!("{path}?format=stk"));
    let problem = refused.expect_problem(422, "not_exportable");
    assert!(
        problem["detail"]
            .as_str()
            .is_some_and(|text| text.contains("/time_system"))
    );
    let message = service.get(&format!("{path}?format=aem-kvn")).expect(200);
    assert!(message.body.contains("TIME_SYSTEM = TAI"));
}

#[test]
fn a_stored_plan_with_an_epoch_of_before_is_read_but_not_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let mut service = Service::on(&database, &[]);
    let mut scenario = small();
    scenario["epoch"] = "2026-01-01T00:00:00".into();
    let id = service.submit(&scenario);
    service.wait_end(&id);
    assert!(service.terminate());
    // As it was taken by a version that did not look at epochs.
    let bad = scenario.to_string().replace("2026-01-01T00:00:00", "soon");
    replace_scenario(&database, bad);
    let service = Service::on(&database, &[]);
    let path = format!("/v1/plans/{id}/result");
    let plan = service.get(&path).expect(200).json();
    assert_eq!(plan["status"], "optimal");
    let stored = service.get(&format!("/v1/plans/{id}/scenario")).expect(200);
    assert_eq!(stored.json()["epoch"], "soon");
    for format in ["aem-kvn", "csv"] {
        let refused = service.get(&format!("{path}?format={format}"));
        let problem = refused.expect_problem(422, "not_exportable");
        let detail = problem["detail"].as_str().expect("a text");
        assert!(detail.starts_with("/epoch of the scenario"), "{detail}");
        assert_eq!(problem["errors"][0]["code"], "invalid_epoch");
    }
}

/// Puts another scenario in the place of the only one.
fn replace_scenario(database: &Path, scenario: String) {
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    runtime.block_on(async {
        let options = SqliteConnectOptions::new().filename(database);
        let mut connection = options.connect().await.expect("a database");
        let put = sqlx::query("UPDATE jobs SET scenario = ?").bind(scenario.into_bytes());
        let put = put.execute(&mut connection).await.expect("changed");
        assert_eq!(put.rows_affected(), 1);
        connection.close().await.expect("written");
    });
}
