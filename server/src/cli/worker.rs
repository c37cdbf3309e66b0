//! Options of the process that solves jobs.

/// What `serve` and `work` solve with.
#[derive(Debug, clap::Args)]
pub(super) struct WorkerOptions {
    /// Threads of the solver, which all jobs share [default: one per core]
    #[arg(long, env = "SLEWPLAN_THREADS", value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Maximum number of connections to a Postgres server, beside two for notices between processes
    #[arg(long, env = "SLEWPLAN_DATABASE_CONNECTIONS", value_name = "N", default_value_t = 10,
        value_parser = clap::value_parser!(u16).range(4..=1000))]
    database_connections: u16,
    /// Jobs that are solved at once: they get equal shares of the threads, so that a short one does not
    /// wait behind a long one
    #[arg(long, env = "SLEWPLAN_JOBS", value_name = "N", default_value_t = 2,
        value_parser = clap::value_parser!(u8).range(1..=64))]
    jobs: u8,
    /// Memory limit of one job, and of those together that are solved at once, MiB
    #[arg(long, env = "SLEWPLAN_JOB_MEMORY", value_name = "MIB", default_value_t = 1024,
        value_parser = clap::value_parser!(u32).range(16..))]
    job_memory: u32,
    /// Offer parts of large tables of legs to other processes on the same database of Postgres that have
    /// nothing else to do
    #[arg(long, env = "SLEWPLAN_SPREAD_LEGS")]
    spread_legs: bool,
}

impl WorkerOptions {
    /// Whether parts of large tables of legs are offered to other processes.
    pub(super) fn spread_legs(&self) -> bool {
        self.spread_legs
    }

    /// Threads of the solver; one per core without it.
    pub(super) fn threads(&self) -> Option<usize> {
        self.threads.map(usize::from)
    }

    /// Maximum number of connections to a server of databases, beside those for notices.
    pub(super) fn database_connections(&self) -> u32 {
        self.database_connections.into()
    }

    /// Number of jobs that are solved at once.
    pub(super) fn jobs(&self) -> usize {
        self.jobs.into()
    }

    /// Memory limit of the jobs that are solved at once, bytes.
    pub(super) fn job_memory(&self) -> u64 {
        u64::from(self.job_memory) << 20
    }
}
