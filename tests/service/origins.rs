//! What a hostile page can have a browser send: foreign names and foreign origins.

use crate::client::{Answer, Request};
use crate::running::{Service, small};
use std::process::Command;

/// The list of plans, asked for under hosts.
fn under(service: &Service, hosts: &[&str]) -> Answer {
    let request = Request::bare("GET /v1/plans HTTP/1.1");
    let named = |request: Request, host: &&str| request.header("Host", host);
    service.send(&hosts.iter().fold(request, named))
}

/// A scenario, posted with headers under a host.
fn posted(service: &Service, host: &str, headers: &[(&str, &str)]) -> Answer {
    let request = Request::bare("POST /v1/plans HTTP/1.1").header("Host", host);
    let with = |request: Request, (name, value): &(&str, &str)| request.header(name, value);
    service.send(&headers.iter().fold(request, with).json(&small()))
}

fn port_of(service: &Service) -> &str {
    service.address.rsplit(':').next().expect("a port")
}

#[test]
fn without_keys_only_own_names_are_served() {
    let service = Service::start_with(&[
        "--allowed-host",
        "Plan.example,10.1.2.3",
        "--allowed-host",
        "fd00::1",
    ]);
    let address = &*service.address;
    for host in [
        "localhost",
        "LOCALHOST",
        "localhost.",
        "localhost:8080",
        "localhost:",
        "plans.localhost:1",
        "127.0.0.1",
        "127.200.3.4:99",
        "[::1]",
        "[::1]:8080",
        "[0:0:0:0:0:0:0:1]",
        "[::ffff:127.0.0.1]",
        "plan.example",
        "PLAN.EXAMPLE.:443",
        "10.1.2.3:8080",
        "[fd00::1]:8080",
        address,
    ] {
        under(&service, &[host]).expect(200);
    }
    for host in [
        "evil.example",
        "evil.example:8080",
        "evil.example.",
        "localhost.evil.example",
        "notlocalhost",
        "127.0.0.1.evil.example",
        "sub.plan.example",
        "128.0.0.1",
        "0.0.0.0",
        "10.1.2.4",
        "[::2]",
        "[fd00::2]",
    ] {
        let problem = under(&service, &[host]).expect_problem(403, "foreign_host");
        let detail = problem["detail"].as_str().expect("text");
        let name = host.trim_end_matches(":8080").trim_end_matches('.');
        assert!(
            detail.contains(&format!("--allowed-host {name}")),
            "{detail}"
        );
    }
    for host in [
        "",
        "a b",
        "user@localhost",
        "localhost:80:80",
        "localhost:port",
        "localhost:65536",
        "[::1",
        "lo*al",
        "löcalhost",
    ] {
        under(&service, &[host]).expect_problem(400, "bad_request");
    }
    for hosts in [
        &[][..],
        &["localhost", "localhost"],
        &["localhost", "evil.example"],
    ] {
        under(&service, hosts).expect_problem(400, "bad_request");
    }
}

#[test]
fn the_address_that_the_service_listens_on_is_its_own() {
    for listen in ["127.0.0.1:0", "0.0.0.0:0"] {
        let service = Service::start_with(&["--listen", listen, "--no-keys"]);
        let address = &*service.address;
        assert!(!address.ends_with(":0"), "{address}");
        under(&service, &[address]).expect(200);
        under(&service, &["192.0.2.1"]).expect_problem(403, "foreign_host");
    }
}

#[test]
fn the_target_of_a_request_counts_like_its_host() {
    let service = Service::start();
    let send = |line: &str, host: &str| service.send(&Request::bare(line).header("Host", host));
    send("GET http://localhost/v1/plans HTTP/1.1", "localhost").expect(200);
    send("GET http://evil.example/v1/plans HTTP/1.1", "localhost")
        .expect_problem(403, "foreign_host");
    send("GET http://localhost/v1/plans HTTP/1.1", "evil.example")
        .expect_problem(403, "foreign_host");
    // HTTP/1.0 has no Host; every browser sends it.
    service
        .send(&Request::bare("GET /v1/plans HTTP/1.0"))
        .expect(200);
    send("GET /v1/plans HTTP/1.0", "evil.example").expect_problem(403, "foreign_host");
}

#[test]
fn every_route_is_closed_to_foreign_names() {
    let service = Service::start();
    let paths = [
        "/",
        "/docs/",
        "/docs/errors",
        "/openapi.yaml",
        "/v1/limits",
        "/v1/version",
        "/metrics",
        "/none",
    ];
    for path in paths.into_iter().chain(["/health/live", "/health/ready"]) {
        let get = |host| {
            service.send(&Request::bare(&format!("GET {path} HTTP/1.1")).header("Host", host))
        };
        get("evil.example").expect_problem(403, "foreign_host");
        // Probes come to the address of a pod, which cannot be a name that was pointed here.
        if path.starts_with("/health/") {
            get("192.0.2.7:8080").expect(200);
        } else {
            get("192.0.2.7:8080").expect_problem(403, "foreign_host");
        }
    }
}

#[test]
fn pages_from_elsewhere_change_nothing() {
    let service = Service::start();
    let port = port_of(&service);
    let host = format!("127.0.0.1:{port}");
    let own = format!("http://{host}");
    posted(&service, &host, &[("Origin", &own)]).expect(202);
    // The one port that is not written is that of the scheme.
    for (host, origin) in [
        ("localhost", "http://localhost"),
        ("localhost", "https://localhost:443"),
        ("localhost:80", "http://localhost"),
    ] {
        posted(&service, host, &[("Origin", origin)]).expect(202);
    }
    let foreign = [
        "null".to_owned(),
        String::new(),
        "http://evil.example".to_owned(),
        format!("http://evil.example:{port}"),
        format!("http://localhost:{port}"),
        "http://127.0.0.1".to_owned(),
        "http://127.0.0.1:1".to_owned(),
        format!("http://{host}.evil.example"),
        format!("http://user@{host}"),
        format!("http://{host}/"),
        format!("ftp://{host}"),
        host.clone(),
        format!("{own} http://evil.example"),
        "file://".to_owned(),
    ];
    for origin in &foreign {
        posted(&service, &host, &[("Origin", origin)]).expect_problem(403, "foreign_origin");
        for (method, path) in [
            ("GET", "/v1/plans"),
            ("OPTIONS", "/v1/plans"),
            ("DELETE", "/v1/plans/x"),
            ("GET", "/health/live"),
            ("GET", "/"),
        ] {
            let request = Request::bare(&format!("{method} {path} HTTP/1.1"))
                .header("Host", &host)
                .header("Origin", origin);
            let answer = service.send(&request);
            assert_eq!(answer.header("access-control-allow-origin"), None);
            answer.expect_problem(403, "foreign_origin");
        }
    }
    posted(
        &service,
        &host,
        &[("Origin", &own), ("Origin", "http://evil.example")],
    )
    .expect_problem(403, "foreign_origin");
    posted(
        &service,
        &host,
        &[("Origin", "http://evil.example"), ("Origin", &own)],
    )
    .expect_problem(403, "foreign_origin");
    let plans = service.get("/v1/plans").expect(200).json();
    assert_eq!(plans["plans"].as_array().map(Vec::len), Some(4), "{plans}");
}

#[test]
fn what_the_browser_says_of_the_sender_counts() {
    let service = Service::start();
    let get = |path: &str, headers: &[(&str, &str)]| {
        let with = |request: Request, (name, value): &(&str, &str)| request.header(name, value);
        service.send(&headers.iter().fold(Request::new("GET", path), with))
    };
    for site in ["same-origin", "none"] {
        get("/v1/plans", &[("Sec-Fetch-Site", site)]).expect(200);
        posted(&service, "localhost", &[("Sec-Fetch-Site", site)]).expect(202);
    }
    let link = [
        ("Sec-Fetch-Mode", "navigate"),
        ("Sec-Fetch-Dest", "document"),
    ];
    for site in ["same-site", "cross-site"] {
        let site = ("Sec-Fetch-Site", site);
        get("/v1/plans", &[site]).expect_problem(403, "foreign_origin");
        get("/v1/plans", &[site, ("Sec-Fetch-Mode", "no-cors")])
            .expect_problem(403, "foreign_origin");
        get("/health/live", &[site]).expect_problem(403, "foreign_origin");
        // The user follows a link, which is not how pages are put into frames or sent.
        for path in ["/", "/docs/", "/v1/plans"] {
            get(path, &[site, link[0], link[1]]).expect(200);
            get(path, &[site, link[0], ("Sec-Fetch-Dest", "iframe")])
                .expect_problem(403, "foreign_origin");
        }
        posted(&service, "localhost", &[site, link[0], link[1]])
            .expect_problem(403, "foreign_origin");
        // A page of the same host under another scheme.
        posted(
            &service,
            "localhost",
            &[site, ("Origin", "https://localhost")],
        )
        .expect_problem(403, "foreign_origin");
    }
}

#[test]
fn with_keys_any_name_is_served_and_no_foreign_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("keys.db");
    let made = Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .args(["keys", "create", "planner", "--database"])
        .arg(&database)
        .output()
        .expect("the binary starts");
    let key = String::from_utf8(made.stdout).expect("ASCII");
    let key = format!("Bearer {}", key.trim());
    let service = Service::on(&database, &[]);
    let key = ("Authorization", &*key);
    let foreign = ("Origin", "https://evil.example");
    // Behind a proxy that passes Host on, and ends TLS.
    posted(
        &service,
        "plan.example",
        &[key, ("Origin", "https://plan.example")],
    )
    .expect(202);
    posted(&service, "plan.example", &[key, foreign]).expect_problem(403, "foreign_origin");
    posted(&service, "plan.example", &[foreign]).expect_problem(403, "foreign_origin");
    // Behind a proxy that does not.
    let own = ("Origin", "https://plan.example");
    let problem =
        posted(&service, "10.0.0.9:8080", &[key, own]).expect_problem(403, "foreign_origin");
    let detail = problem["detail"].as_str().expect("text");
    assert!(detail.contains("--allowed-host plan.example"), "{detail}");
    drop(service);

    let service = Service::on(
        &database,
        &[
            "--allowed-host",
            "plan.example",
            "--allowed-host",
            "inside.example:8443",
        ],
    );
    posted(&service, "127.0.0.1:8080", &[key, own]).expect(202);
    posted(&service, "inside.example", &[key, own]).expect(202);
    posted(
        &service,
        "localhost",
        &[key, own, ("Sec-Fetch-Site", "cross-site")],
    )
    .expect(202);
    posted(
        &service,
        "localhost",
        &[key, ("Origin", "https://inside.example:8443")],
    )
    .expect(202);
    for origin in [
        "https://plan.example:8443",
        "https://inside.example",
        "https://evil.example",
    ] {
        posted(&service, "localhost", &[key, ("Origin", origin)])
            .expect_problem(403, "foreign_origin");
    }
    posted(&service, "evil.example", &[key]).expect_problem(403, "foreign_host");
}

#[test]
fn hosts_to_allow_are_names_or_addresses() {
    for host in [
        "https://plan.example",
        "*.example",
        "",
        "plan.example/",
        "a b",
    ] {
        let refused = Command::new(env!("CARGO_BIN_EXE_slewplan"))
            .args(["serve", "--allowed-host", host])
            .output()
            .expect("the binary starts");
        assert_eq!(refused.status.code(), Some(2), "{host}");
        let said = String::from_utf8_lossy(&refused.stderr);
        assert!(
            said.contains("--allowed-host") && said.contains("plan.example"),
            "{said}"
        );
    }
}
