//! The memory limit of the jobs of this process: which may run beside others, and when one is stopped.

use slewplan_solver::run::stop::StopSignal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::runtime::Handle;
use tokio::task::AbortHandle;

/// Interval between two looks at the memory.
const INTERVAL: Duration = Duration::from_millis(100);

/// The memory that the running jobs of a process share.
#[derive(Debug, Clone)]
pub(super) struct JobMemory(Arc<SharedMemory>);

#[derive(Debug)]
struct SharedMemory {
    limit: u64,
    running: Mutex<Running>,
    admission: tokio::sync::Mutex<()>,
}

#[derive(Debug, Default)]
struct Running {
    /// Memory of the process before the first of the running jobs, bytes.
    before: u64,
    /// The running jobs in the order of their begin: number, and what it may need, bytes.
    jobs: Vec<(u64, u64)>,
    /// Number of the newest job.
    newest: u64,
}

impl Running {
    /// The job that is stopped when the memory does not suffice: the one that may need most.
    fn greatest(&self) -> Option<u64> {
        let most = self.jobs.iter().max_by_key(|(_, needed)| *needed)?;
        Some(most.0)
    }
}

impl JobMemory {
    /// Memory of a size, bytes.
    pub(super) fn new(limit: u64) -> Self {
        Self(Arc::new(SharedMemory {
            limit,
            running: Mutex::default(),
            admission: tokio::sync::Mutex::default(),
        }))
    }

    /// The size, bytes.
    pub(super) fn limit(&self) -> u64 {
        self.0.limit
    }

    /// Keeps others from admitting jobs until the guard is dropped.
    pub(super) async fn admission(&self) -> tokio::sync::MutexGuard<'_, ()> {
        self.0.admission.lock().await
    }

    fn running(&self) -> MutexGuard<'_, Running> {
        let running = self.0.running.lock();
        running.unwrap_or_else(PoisonError::into_inner)
    }

    /// What the running jobs leave of the memory, bytes; `None` when there are none, and any job may
    /// begin.
    pub(super) fn free(&self) -> Option<u64> {
        let running = self.running();
        let needed: u64 = running.jobs.iter().map(|(_, needed)| needed).sum();
        (!running.jobs.is_empty()).then(|| self.0.limit.saturating_sub(needed))
    }

    /// Takes what a job may need, bytes, until the guard is dropped.
    pub(super) fn admit(&self, needed: u64) -> MemoryGuard {
        let mut running = self.running();
        if running.jobs.is_empty() {
            running.before = resident().unwrap_or(u64::MAX);
        }
        running.newest += 1;
        let number = running.newest;
        running.jobs.push((number, needed));
        MemoryGuard {
            memory: self.clone(),
            number,
            exceeded: Arc::default(),
            task: None,
        }
    }

    /// Whether the memory of the process has grown beyond the limit since the first of the running jobs
    /// began, and this is the one to be stopped.
    fn is_too_much(&self, number: u64) -> bool {
        let Some(now) = resident() else { return false };
        let running = self.running();
        now > running.before.saturating_add(self.0.limit) && running.greatest() == Some(number)
    }
}

/// The memory of one job. Without effect where the operating system does not report the memory.
#[derive(Debug)]
pub(super) struct MemoryGuard {
    memory: JobMemory,
    number: u64,
    exceeded: Arc<AtomicBool>,
    task: Option<AbortHandle>,
}

impl MemoryGuard {
    /// From now on stops the solve with its best plan so far when the memory does not suffice and this
    /// job may need most of it.
    pub(super) fn watch(&mut self, runtime: &Handle, stop: StopSignal) {
        let (memory, number) = (self.memory.clone(), self.number);
        let exceeded = Arc::clone(&self.exceeded);
        let watching = runtime.spawn(async move {
            loop {
                tokio::time::sleep(INTERVAL).await;
                if memory.is_too_much(number) {
                    break;
                }
            }
            exceeded.store(true, Ordering::SeqCst);
            stop.request();
        });
        self.task = Some(watching.abort_handle());
    }

    /// The limit, bytes, if the job was stopped because of it.
    pub(super) fn exceeded(&self) -> Option<u64> {
        let exceeded = self.exceeded.load(Ordering::SeqCst);
        exceeded.then(|| self.memory.limit())
    }
}

impl Drop for MemoryGuard {
    fn drop(&mut self) {
        if let Some(task) = &self.task {
            task.abort();
        }
        let mut running = self.memory.running();
        running.jobs.retain(|(number, _)| *number != self.number);
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

    fn runtime() -> tokio::runtime::Runtime {
        tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .expect("a runtime")
    }

    /// Waits until a solve is to stop.
    #[expect(clippy::disallowed_methods, reason = "polls what another thread does")]
    fn await_stop(stop: &StopSignal) {
        let begin = std::time::Instant::now();
        while !stop.is_set() && begin.elapsed() < Duration::from_mins(1) {
            std::thread::sleep(INTERVAL);
        }
        assert!(stop.is_set());
    }

    #[test]
    fn of_jobs_beyond_their_limit_only_the_one_that_may_need_most_is_stopped() {
        let runtime = runtime();
        let stops = [(); 4].map(|()| StopSignal::new());
        let (tight, wide) = (JobMemory::new(16 << 20), JobMemory::new(1 << 40));
        let needed = [(&tight, 1), (&tight, 3), (&tight, 2), (&wide, 9)];
        let guards = std::array::from_fn::<_, 4, _>(|index| {
            let (memory, needed) = needed[index];
            let mut guard = memory.admit(needed);
            guard.watch(runtime.handle(), stops[index].clone());
            guard
        });
        let ballast = vec![1_u8; 64 << 20];
        await_stop(&stops[1]);
        let set = stops.each_ref().map(StopSignal::is_set);
        assert_eq!(set, [false, true, false, false]);
        let exceeded = guards.each_ref().map(MemoryGuard::exceeded);
        assert_eq!(exceeded, [None, Some(16 << 20), None, None]);
        // It has ended and its memory is still there: the next.
        let [first, second, third, last] = guards;
        drop(second);
        await_stop(&stops[2]);
        assert!(!stops[0].is_set() && !stops[3].is_set());
        assert_eq!(
            ballast.iter().map(|byte| usize::from(*byte)).sum::<usize>(),
            ballast.len()
        );
        drop((first, third, last));
    }

    #[test]
    fn jobs_take_their_memory_while_they_run() {
        let memory = JobMemory::new(100);
        assert_eq!(memory.free(), None);
        let first = memory.admit(70);
        assert_eq!(memory.free(), Some(30));
        let second = memory.admit(20);
        assert_eq!(memory.free(), Some(10));
        drop(first);
        assert_eq!(memory.free(), Some(80));
        drop(second);
        assert_eq!(memory.free(), None);
        // One that was accepted under a greater limit runs alone.
        let _large = memory.admit(200);
        assert_eq!(memory.free(), Some(0));
    }
}
