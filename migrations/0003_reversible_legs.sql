-- Whether a leg can be flown backwards. Of legs stored before this is not known; they are found in
-- the direction in which they were solved.
ALTER TABLE legs ADD COLUMN reversible INTEGER NOT NULL DEFAULT FALSE;
