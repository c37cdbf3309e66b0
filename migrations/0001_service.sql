-- Jobs, what came of them, and everything that must be committed together with them.
CREATE TABLE jobs (
    sequence            INTEGER PRIMARY KEY AUTOINCREMENT, -- order of submission
    id                  TEXT    NOT NULL UNIQUE,
    state               TEXT    NOT NULL CHECK (state IN
        ('queued', 'running', 'succeeded', 'stopped', 'infeasible', 'failed', 'cancelled', 'dead')),
    name                TEXT,
    scenario            BLOB    NOT NULL,                  -- with stored spacecraft written out
    targets             INTEGER NOT NULL,
    stage               TEXT,
    done                INTEGER,
    total               INTEGER,
    incumbent_s         REAL,
    lower_bound_s       REAL,
    detail              TEXT,                              -- why there is no plan
    attempt             INTEGER NOT NULL DEFAULT 0,
    fence               INTEGER NOT NULL DEFAULT 0,        -- of the newest claim
    boot_id             TEXT,                              -- process that holds the claim
    lease_until_us      INTEGER,
    stop_requested_us   INTEGER,
    cancel_requested_us INTEGER,
    submitted_us        INTEGER NOT NULL,
    started_us          INTEGER,
    finished_us         INTEGER,
    CHECK ((state = 'running') = (lease_until_us IS NOT NULL))
) STRICT;

CREATE INDEX jobs_by_state ON jobs (state, sequence);
CREATE INDEX jobs_by_name ON jobs (name, sequence);

CREATE TABLE results (
    job      INTEGER PRIMARY KEY REFERENCES jobs (sequence) ON DELETE CASCADE,
    document BLOB    NOT NULL,                             -- the plan as JSON
    digest   TEXT    NOT NULL                              -- SHA-256 of the document, hex
) STRICT;

CREATE TABLE events (
    job   INTEGER NOT NULL REFERENCES jobs (sequence) ON DELETE CASCADE,
    id    INTEGER NOT NULL,                                -- counts from 1 within the job
    kind  TEXT    NOT NULL CHECK (kind IN ('state', 'progress')),
    data  TEXT    NOT NULL,
    PRIMARY KEY (job, id)
) STRICT, WITHOUT ROWID;

CREATE TABLE idempotency_keys (
    key         TEXT    PRIMARY KEY,
    fingerprint TEXT    NOT NULL,                          -- SHA-256 of the request, hex
    job         INTEGER NOT NULL REFERENCES jobs (sequence) ON DELETE CASCADE,
    created_us  INTEGER NOT NULL
) STRICT;

CREATE INDEX idempotency_keys_by_job ON idempotency_keys (job);

CREATE TABLE spacecraft (
    name       TEXT    NOT NULL,
    version    INTEGER NOT NULL,
    document   TEXT    NOT NULL,
    created_us INTEGER NOT NULL,
    PRIMARY KEY (name, version)
) STRICT, WITHOUT ROWID;

-- One row that readiness writes.
CREATE TABLE readiness (
    one        INTEGER PRIMARY KEY CHECK (one = 1),
    checked_us INTEGER NOT NULL
) STRICT;

-- Solved legs, found by the hash of the canonical text of their problem.
CREATE TABLE leg_spacecraft (
    key      TEXT PRIMARY KEY,                             -- SHA-256 of the text, hex
    document TEXT NOT NULL                                 -- canonical text of the solver
) STRICT, WITHOUT ROWID;

CREATE TABLE legs (
    sequence       INTEGER PRIMARY KEY,
    key            TEXT    NOT NULL UNIQUE,                -- SHA-256 of the identity, hex
    identity       TEXT    NOT NULL,                       -- canonical text of the problem
    spacecraft     TEXT    NOT NULL REFERENCES leg_spacecraft (key),
    kind           TEXT    NOT NULL,
    turn_x         REAL    NOT NULL,
    turn_y         REAL    NOT NULL,
    turn_z         REAL    NOT NULL,
    turn_w         REAL    NOT NULL,
    momentum_x     REAL    NOT NULL,
    momentum_y     REAL    NOT NULL,
    momentum_z     REAL    NOT NULL,
    duration_s     REAL    NOT NULL,
    solve_time_s   REAL    NOT NULL,
    status         TEXT    NOT NULL,
    solver_version TEXT    NOT NULL,
    trajectory     BLOB    NOT NULL,                       -- JSON
    created_us     INTEGER NOT NULL
) STRICT;

CREATE INDEX legs_by_spacecraft ON legs (spacecraft, sequence);
