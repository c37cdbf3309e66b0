//! The page and its files.

use crate::client::Request;
use crate::running::{Service, fixture, small};
use serde_json::Value;

/// The addresses of files in the page.
fn files(page: &str) -> Vec<String> {
    page.split('"')
        .filter(|text| text.starts_with("/page/"))
        .map(str::to_owned)
        .collect()
}

/// The folder of the files of a page.
fn folder(page: &str) -> String {
    let files = files(page);
    let parts: Vec<_> = files[0].splitn(4, '/').take(3).collect();
    parts.join("/")
}

#[test]
fn the_page_loads_its_files_from_the_service_and_nothing_inline() {
    let service = Service::start();
    let answer = service.get("/").expect(200);
    assert_eq!(
        answer.header("content-type"),
        Some("text/html; charset=utf-8")
    );
    let policy = answer.header("content-security-policy").expect("a policy");
    for part in [
        "default-src 'none'",
        "script-src 'self';",
        "style-src 'self';",
        "frame-ancestors 'none'",
    ] {
        assert!(policy.contains(part), "{policy}");
    }
    assert!(!policy.contains("unsafe"), "{policy}");
    let files = files(&answer.body);
    assert!(files.len() >= 6, "{files:?}");
    for path in files {
        let file = service.get(&path).expect(200);
        let form = file.header("content-type").expect("a media type");
        let known = ["text/css", "text/javascript", "image/svg+xml"];
        assert!(
            known.iter().any(|known| form.starts_with(known)),
            "{path}: {form}"
        );
        assert_eq!(file.header("x-content-type-options"), Some("nosniff"));
        assert_eq!(file.header("content-security-policy"), Some(policy));
        assert_eq!(
            file.header("cache-control"),
            Some("public, max-age=31536000, immutable")
        );
    }
}

#[test]
fn files_of_the_page_are_compressed_for_who_takes_it() {
    let service = Service::start();
    let path = files(&service.get("/").expect(200).body)
        .into_iter()
        .find(|path| path.ends_with("main.js"))
        .expect("its script");
    let plain = service.get(&path).expect(200);
    assert_eq!(plain.header("content-encoding"), None);
    let request = Request::new("GET", &path).header("Accept-Encoding", "gzip");
    let packed = service.send(&request).expect(200);
    assert_eq!(packed.header("content-encoding"), Some("gzip"));
    assert_eq!(packed.header("vary"), Some("accept-encoding"));
    assert!(packed.bytes.len() < plain.bytes.len());
    assert_eq!(
        packed.header("cache-control"),
        plain.header("cache-control")
    );
}

#[test]
fn the_page_is_revalidated_by_its_entity_tag() {
    let service = Service::start();
    let first = service.get("/").expect(200);
    assert_eq!(first.header("cache-control"), Some("private, no-cache"));
    let tag = first.header("etag").expect("a tag");
    let again = Request::new("GET", "/").header("If-None-Match", tag);
    let again = service.send(&again).expect(304);
    assert_eq!((again.header("etag"), again.body.as_str()), (Some(tag), ""));
}

#[test]
fn only_files_of_this_version_are_served() {
    let service = Service::start();
    let page = service.get("/").expect(200).body;
    let folder = folder(&page);
    service.get(&format!("{folder}/app/main.js")).expect(200);
    for path in [
        "app/missing.js",
        "app/",
        "index.html",
        "../Cargo.toml",
        "%2e%2e/Cargo.toml",
        "app/../../Cargo.toml",
        "app/..%2f..%2fCargo.toml",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "app/main.js%00",
    ] {
        service
            .get(&format!("{folder}/{path}"))
            .expect_problem(404, "not_found");
    }
    let other = format!("/page/{}/app/main.js", "0".repeat(64));
    service.get(&other).expect_problem(404, "not_found");
    let posted = service.post("/", &small());
    posted.expect_problem(405, "method_not_allowed");
}

#[test]
fn the_examples_of_the_page_are_valid_scenarios() {
    let service = Service::start();
    let page = service.get("/").expect(200).body;
    let folder = folder(&page);
    let view = format!("{folder}/app/views/submit.js");
    let view = service.get(&view).expect(200).body;
    for name in [
        "two-targets",
        "olivares-a",
        "olivares-b",
        "olivares-c",
        "pyramid-momentum-bias",
    ] {
        assert!(view.contains(&format!("[\"{name}\",")), "{name}");
        let path = format!("{folder}/examples/{name}.json");
        let example = service.get(&path).expect(200).json();
        assert_eq!(example, fixture(&format!("{name}.json")));
        service
            .post("/v1/plans?validate_only=true", &example)
            .expect(200);
    }
}

#[test]
fn the_slew_and_study_examples_of_the_page_are_answered() {
    let service = Service::start();
    let page = service.get("/").expect(200).body;
    let folder = folder(&page);
    for (view, path, name, place) in [
        (
            "views/slew",
            "/v1/slews",
            "quarter-turn",
            "slews/quarter-turn",
        ),
        (
            "views/slew",
            "/v1/slews",
            "olrac-four-wheels",
            "slews/olrac-four-wheels",
        ),
        (
            "views/slew",
            "/v1/slews",
            "biros-sampled",
            "slews/biros-sampled",
        ),
        (
            "views/slew",
            "/v1/slews",
            "lro-least-bill",
            "slews/lro-least-bill",
        ),
        (
            "studies/registry",
            "/v1/studies/authority",
            "study-authority",
            "studies/authority",
        ),
        (
            "studies/registry",
            "/v1/studies/envelopes",
            "study-envelopes",
            "studies/pyramid-envelopes",
        ),
        (
            "studies/registry",
            "/v1/studies/comparison",
            "study-comparison",
            "studies/comparison",
        ),
        (
            "studies/registry",
            "/v1/studies/flight",
            "study-flight",
            "studies/flight",
        ),
    ] {
        let view = service
            .get(&format!("{folder}/app/{view}.js"))
            .expect(200)
            .body;
        assert!(view.contains(&format!("[\"{name}\",")), "{name}");
        let example = format!("{folder}/examples/{name}.json");
        let example = service.get(&example).expect(200).json();
        assert_eq!(example, fixture(&format!("{place}.json")));
        let answer = service.post(path, &example).expect(200).json();
        assert_ne!(answer["complete"], false, "{name}");
    }
}

/// All enumerated values in a schema.
fn listed(schema: &Value) -> Vec<String> {
    match schema {
        Value::Object(members) => members
            .iter()
            .flat_map(|(name, value)| match (name.as_str(), value) {
                ("enum", Value::Array(values)) => values
                    .iter()
                    .filter_map(|value| Some(value.as_str()?.to_owned()))
                    .collect(),
                _ => listed(value),
            })
            .collect(),
        Value::Array(items) => items.iter().flat_map(listed).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn the_page_offers_every_form_of_a_plan() {
    let service = Service::start();
    let page = service.get("/").expect(200).body;
    let view = format!("{}/app/plan/downloads.js", folder(&page));
    let view = service.get(&view).expect(200).body;
    let description = service.get("/openapi.yaml").expect(200).body;
    let description: Value = yaml_serde::from_str(&description).expect("YAML");
    let parameters = &description["paths"]["/v1/plans/{id}/result"]["get"]["parameters"];
    let format = parameters
        .as_array()
        .and_then(|all| all.iter().find(|one| one["name"] == "format"));
    let forms = listed(format.expect("the parameter"));
    assert!(forms.contains(&"csv".to_owned()), "{forms:?}");
    for form in forms {
        assert!(view.contains(&format!("[\"{form}\",")), "{form}");
    }
}
