//! Streams of events.

use crate::client::Request;
use crate::running::{Service, small};
use serde_json::Value;

/// Identifier, kind and content of every event of a stream.
fn events(stream: &str) -> Vec<(u64, String, Value)> {
    let field = |block: &str, name: &str| {
        let line = block.lines().find_map(|line| line.strip_prefix(name));
        line.unwrap_or_else(|| panic!("no {name} in {block:?}"))
            .trim()
            .to_owned()
    };
    stream
        .split("\n\n")
        .filter(|block| block.contains("data:"))
        .map(|block| {
            let data = serde_json::from_str(&field(block, "data:")).expect("JSON");
            (
                field(block, "id:").parse().expect("a number"),
                field(block, "event:"),
                data,
            )
        })
        .collect()
}

#[test]
fn a_stream_has_all_events_and_ends_with_the_job() {
    let service = Service::start();
    let id = service.submit(&small());
    let answer = service.get(&format!("/v1/plans/{id}/events")).expect(200);
    assert_eq!(answer.header("content-type"), Some("text/event-stream"));
    let events = events(&answer.body);
    let ids: Vec<u64> = events.iter().map(|(id, _, _)| *id).collect();
    assert_eq!(ids, (1..=events.len() as u64).collect::<Vec<_>>());
    for (_, kind, data) in &events {
        assert!(kind == "state" || kind == "progress");
        for field in [
            "state",
            "incumbent_s",
            "lower_bound_s",
            "relative_gap",
            "at",
        ] {
            assert!(data.get(field).is_some(), "{field} in {data}");
        }
    }
    assert_eq!(events[0].2["state"], "queued");
    let last = &events.last().expect("events").2;
    assert_eq!(last["state"], "succeeded");
    assert!(last["incumbent_s"].is_number() && last["lower_bound_s"].is_number());
    assert!(events.iter().any(|(_, _, data)| data["stage"] == "legs"));
}

#[test]
fn a_broken_stream_is_resumed_after_the_last_received_event() {
    let service = Service::start();
    let id = service.submit(&small());
    service.wait_end(&id);
    let path = format!("/v1/plans/{id}/events");
    let all = events(&service.get(&path).expect(200).body);
    let resume =
        |known: &str| service.send(&Request::new("GET", &path).header("Last-Event-ID", known));
    assert_eq!(events(&resume("2").expect(200).body), all[2..]);
    // With status 200 and an empty stream an EventSource would reconnect without end.
    for known in [all.len().to_string(), "999".to_owned()] {
        assert_eq!(resume(&known).expect(204).body, "");
    }
    assert_eq!(events(&resume("yesterday").expect(200).body), all);
}
