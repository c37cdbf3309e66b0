-- Whether a plan is compressed (zlib): its JSON is mostly digits and takes less than half of its size.
-- The digest is of the JSON itself. Plans that were stored before are not compressed.
ALTER TABLE results ADD COLUMN packed INTEGER NOT NULL DEFAULT FALSE;
ALTER TABLE incumbents ADD COLUMN packed INTEGER NOT NULL DEFAULT FALSE;
