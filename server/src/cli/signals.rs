//! Signals of the operating system as stop requests.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use slewplan_solver::run::stop::StopSignal;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};

/// The first signal that was received.
#[derive(Debug, Clone, Default)]
pub(crate) struct Received(Arc<AtomicI32>);

impl Received {
    /// The exit code that shells use for the end by a signal (128 + its number), if there was one.
    pub(crate) fn exit_code(&self) -> Option<u8> {
        match self.0.load(Ordering::Relaxed) {
            0 => None,
            signal => u8::try_from(128 + signal).ok(),
        }
    }
}

/// Turns SIGINT and SIGTERM into stop requests from now on.
///
/// The first asks for the best plan so far, the second cancels the solve, the third ends the
/// program at once, in case a computation does not react.
///
/// # Errors
///
/// When the operating system refuses the handlers or the thread that waits for them.
pub(crate) fn listen(stop: &StopSignal) -> io::Result<Received> {
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    let received = Received::default();
    let (first, stop) = (Arc::clone(&received.0), stop.clone());
    std::thread::Builder::new()
        .name("slewplan-signals".into())
        .spawn(move || {
            for (count, signal) in signals.forever().enumerate() {
                match count {
                    0 => {
                        first.store(signal, Ordering::Relaxed);
                        stop.request();
                    }
                    1 => stop.cancel(),
                    #[expect(clippy::disallowed_methods, reason = "the third ends at once")]
                    _ => std::process::exit(128 + signal),
                }
            }
        })?;
    Ok(received)
}
