//! `slewplan health` beside a running service.

use crate::running::Service;
use std::process::{Command, Output};

fn health(address: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_slewplan"))
        .arg("health")
        .args(arguments)
        .env("SLEWPLAN_LISTEN", address)
        .output()
        .expect("the binary starts")
}

#[test]
fn a_service_is_healthy_until_it_ends() {
    let mut service = Service::start();
    for arguments in [&[][..], &["--live"]] {
        let asked = health(&service.address, arguments);
        assert_eq!(asked.status.code(), Some(0), "{asked:?}");
        assert!(
            asked.stdout.is_empty() && asked.stderr.is_empty(),
            "{asked:?}"
        );
    }
    // The flag takes precedence over the environment; no service answers at this address.
    let elsewhere = health(&service.address, &["--listen", "127.0.0.1:1"]);
    assert_eq!(elsewhere.status.code(), Some(1), "{elsewhere:?}");
    assert!(service.terminate());
    let gone = health(&service.address, &[]);
    assert_eq!(gone.status.code(), Some(1), "{gone:?}");
    let complaint = String::from_utf8_lossy(&gone.stderr);
    assert!(
        complaint.contains(&service.address) && complaint.contains("/health/ready"),
        "{complaint}"
    );
}

#[test]
fn a_service_with_a_full_queue_is_alive_but_not_ready() {
    // With a queue of size zero every submission finds it full.
    let service = Service::start_with(&["--queue-limit", "0"]);
    let asked = health(&service.address, &[]);
    assert_eq!(asked.status.code(), Some(1), "{asked:?}");
    let complaint = String::from_utf8_lossy(&asked.stderr);
    assert!(complaint.contains("503, the queue is full"), "{complaint}");
    assert_eq!(health(&service.address, &["--live"]).status.code(), Some(0));
}
