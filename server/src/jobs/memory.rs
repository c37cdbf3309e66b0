//! The memory limit of a job, enforced while it runs.

use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// Interval between two looks at the memory.
const INTERVAL: Duration = Duration::from_millis(100);

/// Stops a solve with its best plan so far when the memory of the process has grown beyond a limit
/// since its begin, until the guard is dropped. Without effect where the operating system does not
/// report the memory.
pub(super) struct MemoryGuard {
    exceeded: Arc<AtomicBool>,
    limit: u64,
    task: Option<AbortHandle>,
}

impl MemoryGuard {
    /// Starts watching.
    pub(super) fn watch(runtime: &Handle, limit: u64, stop: StopSignal) -> Self {
        let exceeded = Arc::new(AtomicBool::new(false));
        let task = resident().map(|before| {
            let exceeded_by_task = Arc::clone(&exceeded);
            let watching = runtime.spawn(async move {
                while resident().is_none_or(|now| now <= before.saturating_add(limit)) {
                    tokio::time::sleep(INTERVAL).await;
                }
                exceeded_by_task.store(true, Ordering::SeqCst);
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

    /// The limit, bytes, if the process has grown beyond it.
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

/// Resident memory of this process, bytes.
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
    fn only_a_solve_beyond_its_memory_limit_is_stopped() {
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
            std::thread::sleep(INTERVAL);
        }
        assert!(growing.is_set() && !calm.is_set());
        assert_eq!(
            ballast.iter().map(|byte| usize::from(*byte)).sum::<usize>(),
            ballast.len()
        );
        assert_eq!((tight.exceeded(), wide.exceeded()), (Some(16 << 20), None));
    }
}
