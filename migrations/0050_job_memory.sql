-- What a job may need of the memory that the jobs of a process share, bytes. Jobs that were submitted
-- before this fit beside any.
ALTER TABLE jobs ADD COLUMN memory_bytes INTEGER NOT NULL DEFAULT 0;
