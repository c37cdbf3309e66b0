-- The best plan so far of a job that has not ended; gone when it ends.
CREATE TABLE incumbents (
    job           INTEGER PRIMARY KEY REFERENCES jobs (sequence) ON DELETE CASCADE,
    total_time_s  REAL    NOT NULL,
    lower_bound_s REAL    NOT NULL,                        -- when the plan was found
    document      BLOB    NOT NULL,                        -- the plan as JSON
    digest        TEXT    NOT NULL                         -- SHA-256 of the document, hex
) STRICT;
