//! Slow, silent and many clients.

use crate::client::Request;
use crate::running::{Service, large};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// Longer than every time limit of the service on its clients.
const PATIENCE: Duration = Duration::from_mins(1);

fn connected(service: &Service) -> TcpStream {
    let stream = TcpStream::connect(&service.address).expect("the service listens");
    stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    stream
}

/// The rest of a stream; nothing from a closed connection.
fn rest(mut stream: TcpStream) -> String {
    let mut text = Vec::new();
    match stream.read_to_end(&mut text) {
        Ok(_) => {}
        Err(error) => assert_eq!(error.kind(), ErrorKind::ConnectionReset, "{error}"),
    }
    String::from_utf8_lossy(&text).into_owned()
}

#[test]
fn truncated_and_malformed_bodies_have_different_errors() {
    let service = Service::start();
    let mut broken = connected(&service);
    broken
        .write_all(
            b"POST /v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n\
              Transfer-Encoding: chunked\r\n\r\n5\r\n{\"a\":\r\nno length\r\n",
        )
        .expect("sent");
    let answer = rest(broken);
    assert!(
        answer.starts_with("HTTP/1.1 400 ") && answer.contains("bad_request"),
        "{answer}"
    );
}

#[test]
fn clients_that_do_not_send_are_cut_off() {
    let service = Service::start();
    let silent = connected(&service);
    let mut half_head = connected(&service);
    half_head
        .write_all(b"GET /v1/version HTTP/1.1\r\nHost:")
        .expect("sent");
    let mut half_body = connected(&service);
    half_body
        .write_all(
            b"POST /v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n\
              Content-Length: 100\r\n\r\n{",
        )
        .expect("sent");
    let answer = rest(half_body);
    assert!(
        answer.starts_with("HTTP/1.1 408 ") && answer.contains("body_too_slow"),
        "{answer}"
    );
    assert_eq!(rest(silent), "");
    assert_eq!(rest(half_head), "");
}

#[test]
fn idle_connections_do_not_block_other_clients() {
    let service = Service::start_with(&["--max-connections", "4"]);
    let idle: Vec<TcpStream> = (0..20).map(|_| connected(&service)).collect();
    for _ in 0..4 {
        service.get("/health/live").expect(200);
    }
    drop(idle);
}

#[test]
fn event_streams_leave_connections_for_requests() {
    let service = Service::start_with(&["--max-connections", "4"]);
    let id = service.submit(&large());
    let events = Request::new("GET", &format!("/v1/plans/{id}/events"));
    let open: Vec<TcpStream> = (0..2)
        .map(|_| {
            let mut stream = events.open(&service.address);
            // The headers of the answer have arrived: the stream is open.
            stream.read_exact(&mut [0; 1]).expect("an answer");
            stream
        })
        .collect();
    let refused = service.send(&events);
    assert!(refused.header("retry-after").is_some());
    refused.expect_problem(503, "busy");
    service.get("/health/live").expect(200);
    drop(open);
}

#[test]
fn every_answer_has_security_headers() {
    let service = Service::start();
    for path in [
        "/none",
        "/v1/plans",
        "/v1/plans/none",
        "/docs/",
        "/health/ready",
    ] {
        let answer = service.get(path);
        assert_eq!(answer.header("x-content-type-options"), Some("nosniff"));
        assert_eq!(answer.header("cache-control"), Some("no-store"), "{path}");
        let policy = answer.header("content-security-policy").expect("a policy");
        assert!(policy.contains("frame-ancestors 'none'"), "{policy}");
        assert_eq!(answer.header("access-control-allow-origin"), None);
    }
}
