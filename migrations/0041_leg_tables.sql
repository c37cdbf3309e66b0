-- Jobs that make a table of leg times: the query is in place of the scenario, the number of its
-- legs in place of the targets. Of the legs so far: found in the cache, solved, without a time.
ALTER TABLE jobs ADD COLUMN work TEXT NOT NULL DEFAULT 'plan' CHECK (work IN ('plan', 'leg_table'));
ALTER TABLE jobs ADD COLUMN legs_cached INTEGER;
ALTER TABLE jobs ADD COLUMN legs_computed INTEGER;
ALTER TABLE jobs ADD COLUMN legs_missing INTEGER;

CREATE INDEX jobs_by_work ON jobs (work, sequence);

-- Parts of the tables, as they are finished.
CREATE TABLE leg_table_parts (
    job      INTEGER NOT NULL REFERENCES jobs (sequence) ON DELETE CASCADE,
    first    INTEGER NOT NULL,                             -- position of its first leg in the table
    legs     INTEGER NOT NULL,
    cached   INTEGER NOT NULL,
    computed INTEGER NOT NULL,
    document BLOB    NOT NULL,                             -- rows as JSON, compressed
    packed   INTEGER NOT NULL,
    digest   TEXT    NOT NULL,                             -- SHA-256 of the JSON, hex
    PRIMARY KEY (job, first)
) STRICT;

-- Answers look-ups of times without a look at the motions beside them.
CREATE INDEX leg_times ON legs
    (key, solver_version, duration_s, certified_lower_bound_s, bound_version, solve_time_s);
