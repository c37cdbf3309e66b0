-- Finds the jobs that ended longest ago.
CREATE INDEX jobs_by_end ON jobs (finished_us) WHERE finished_us IS NOT NULL;
