-- What the search of a running job has solved of its tours, so that another attempt does not solve
-- it again; gone some time after the end of the job.
CREATE TABLE segments (
    sequence       INTEGER PRIMARY KEY,
    job            INTEGER NOT NULL REFERENCES jobs (sequence) ON DELETE CASCADE,
    name           TEXT    NOT NULL,                       -- of the solver, within the job
    solver_version TEXT    NOT NULL,
    intervals      INTEGER NOT NULL,
    motion         BLOB    NOT NULL,                       -- little-endian binary64
    UNIQUE (job, name)
) STRICT;
