//! Shutdown of the service on signals.

use std::io;
use std::time::Duration;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::watch;

/// Time that open requests and the running job have to end.
pub(crate) const GRACE: Duration = Duration::from_secs(20);

/// Signals the shutdown to all parts of the service.
#[derive(Debug, Clone)]
pub(crate) struct Shutdown(watch::Receiver<bool>);

impl Shutdown {
    /// Shuts down at the first SIGTERM or SIGINT; the second ends the process at once.
    ///
    /// # Errors
    ///
    /// When the operating system refuses the handlers.
    pub(crate) fn on_signals() -> io::Result<Self> {
        let mut terminate = signal(SignalKind::terminate())?;
        let mut interrupt = signal(SignalKind::interrupt())?;
        let (sender, receiver) = watch::channel(false);
        tokio::spawn(async move {
            for first in [true, false] {
                let code = tokio::select! {
                    _ = terminate.recv() => 143,
                    _ = interrupt.recv() => 130,
                };
                if !first {
                    #[expect(
                        clippy::disallowed_methods,
                        reason = "the second signal ends at once"
                    )]
                    std::process::exit(code);
                }
                tracing::info!("the service shuts down");
                sender.send_replace(true);
            }
        });
        Ok(Self(receiver))
    }

    /// Whether the shutdown has begun.
    pub(crate) fn has_begun(&self) -> bool {
        *self.0.borrow()
    }

    /// Waits until the shutdown has begun.
    pub(crate) async fn begun(&mut self) {
        // The sender is gone only when the runtime ends.
        if self.0.wait_for(|begun| *begun).await.is_err() {
            std::future::pending::<()>().await;
        }
    }
}
