//! Injected failures for tests, in builds with the feature `faults` only. The name of a scenario
//! selects the failure.

use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use std::time::Duration;

/// Maximum memory taken by `fault:memory`, MiB.
const MAX_BALLAST: usize = 2048;

/// Fails if the name of a scenario selects a failure.
///
/// # Panics
///
/// For `fault:panic` on the worker's thread, for `fault:pool` on a thread of the pool, for
/// `fault:drop` while a value is dropped. `fault:abort` aborts the process; `fault:memory`
/// allocates memory until the solve is stopped.
#[expect(
    clippy::disallowed_methods,
    reason = "grows slowly, on a thread of the worker"
)]
pub(crate) fn strike(name: Option<&str>, pool: &SolverPool, stop: &StopSignal) {
    match name {
        Some("fault:panic") => panic!("a fault on purpose"),
        Some("fault:pool") => {
            pool.map(&[0; 8], |_| panic!("a fault on purpose in the pool"));
        }
        Some("fault:drop") => drop(FailsToDrop),
        Some("fault:memory") => {
            let mut ballast = Vec::new();
            while !stop.is_set() && ballast.len() < MAX_BALLAST {
                ballast.push(vec![1_u8; 1 << 20]);
                std::thread::sleep(Duration::from_millis(5));
            }
        }
        Some("fault:abort") => std::process::abort(),
        _ => {}
    }
}

/// Fails after the search.
///
/// # Panics
///
/// For scenarios of the name `fault:late`.
pub(crate) fn strike_late(name: Option<&str>) {
    assert!(name != Some("fault:late"), "a late fault on purpose");
}

struct FailsToDrop;

impl Drop for FailsToDrop {
    fn drop(&mut self) {
        panic!("a fault on purpose in a destructor");
    }
}

/// Fails a request.
///
/// # Panics
///
/// For requests with the header `X-Fault`.
pub(crate) fn strike_request(headers: &axum::http::HeaderMap) {
    assert!(
        !headers.contains_key("x-fault"),
        "a fault on purpose in a handler"
    );
}
