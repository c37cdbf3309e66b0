//! Failures on purpose, for tests of what they cost. Only in builds with the feature `faults`,
//! which nobody ships: a scenario with one of these names does what it says.

use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use std::time::Duration;

/// Most memory that is taken on purpose, MiB.
const MAX_BALLAST: usize = 2048;

/// Fails if the name of a scenario asks for it.
///
/// # Panics
///
/// For `fault:panic`, `fault:pool` and `fault:drop`, on the worker's thread, on a thread of the
/// pool, and while a value is dropped. `fault:abort` ends the process; `fault:memory` takes more and
/// more of it until it is stopped.
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

/// Fails when the search is over, with whatever plans it has found.
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

/// Fails a request that asks for it.
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
