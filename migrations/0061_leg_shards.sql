-- Parts of a table of legs that the job `parent` works on: jobs for workers that have nothing else to do,
-- which callers do not see. Legs that they solve are stored as all others. The part is in place of the
-- scenario, the number of its legs in place of the targets.
ALTER TABLE jobs ADD COLUMN parent INTEGER REFERENCES jobs (sequence) ON DELETE CASCADE;

CREATE INDEX jobs_by_parent ON jobs (parent) WHERE parent IS NOT NULL;
