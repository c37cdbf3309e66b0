//! What a job may take of the memory, watched while it runs.

use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// How often the memory is looked at.
const LOOK: Duration = Duration::from_millis(100);

/// Ends a solve with the best so far when the process has grown too much since its begin. Watches
/// as long as it lives. Where the operating system does not tell, nothing is watched.
pub(super) struct MemoryGuard {
    exceeded: Arc<AtomicBool>,
    limit: u64,
    task: Option<AbortHandle>,
}

impl MemoryGuard {
    /// Watches from now on.
    pub(super) fn watch(runtime: &Handle, limit: u64, stop: StopSignal) -> Self {
        let exceeded = Arc::new(AtomicBool::new(false));
        let task = resident().map(|before| {
            let told = Arc::clone(&exceeded);
            let watching = runtime.spawn(async move {
                while resident().is_none_or(|now| now <= before.saturating_add(limit)) {
                    tokio::time::sleep(LOOK).await;
                }
                told.store(true, Ordering::SeqCst);
                stop.request();
            });
            watching.abort_handle()
        });
        Self {
            exceeded,
            limit,
            task,
        }
    }

    /// The limit, bytes, once the process has grown beyond it.
    pub(super) fn exceeded(&self) -> Option<u64> {
        let exceeded = self.exceeded.load(Ordering::SeqCst);
        exceeded.then_some(self.limit)
    }
}

impl Drop for MemoryGuard {
    fn drop(&mut self) {
        if let Some(task) = &self.task {
            task.abort();
        }
    }
}

/// Memory of this process that is really there, bytes.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(kib << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::disallowed_methods, reason = "polls what another thread does")]
    fn a_solve_that_grows_is_stopped_and_one_that_does_not_is_left_alone() {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .expect("a runtime");
        let (growing, calm) = (StopSignal::new(), StopSignal::new());
        let tight = MemoryGuard::watch(runtime.handle(), 16 << 20, growing.clone());
        let wide = MemoryGuard::watch(runtime.handle(), 1 << 40, calm.clone());
        let ballast = vec![1_u8; 64 << 20];
        let begin = std::time::Instant::now();
        while !growing.is_set() && begin.elapsed() < Duration::from_mins(1) {
            std::thread::sleep(LOOK);
        }
        assert!(growing.is_set() && !calm.is_set());
        assert_eq!(
            ballast.iter().map(|byte| usize::from(*byte)).sum::<usize>(),
            ballast.len()
        );
        assert_eq!((tight.exceeded(), wide.exceeded()), (Some(16 << 20), None));
    }
}
