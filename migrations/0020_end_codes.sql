-- Why a job ended without a plan, as a stable code; NULL for jobs that ended before this.
ALTER TABLE jobs ADD COLUMN code TEXT;
