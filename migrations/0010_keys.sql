-- Keys of clients. A key cannot be read back: only its hash is here.
CREATE TABLE api_keys (
    id         TEXT    PRIMARY KEY,                        -- names the key, is no secret
    client     TEXT    NOT NULL,                           -- for whom the key acts
    digest     TEXT    NOT NULL UNIQUE,                    -- SHA-256 of the key, hex
    scopes     TEXT    NOT NULL,                           -- separated by spaces
    created_us INTEGER NOT NULL,
    expires_us INTEGER,
    revoked_us INTEGER
) STRICT, WITHOUT ROWID;

-- The client whose job it is; NULL where no keys are asked for.
ALTER TABLE jobs ADD COLUMN client TEXT;

CREATE INDEX jobs_by_client ON jobs (client, state, sequence);
