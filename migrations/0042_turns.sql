-- In which order jobs are leased: the greatest priority first, then the smallest turn. The jobs of a
-- client get turns one after another, beginning with that of the job to be leased next, so that those
-- of several clients alternate. Jobs that were submitted before this come first.
ALTER TABLE jobs ADD COLUMN priority INTEGER NOT NULL DEFAULT 0 CHECK (priority BETWEEN -10 AND 10);
ALTER TABLE jobs ADD COLUMN turn INTEGER NOT NULL DEFAULT 0;

CREATE INDEX jobs_by_turn ON jobs (priority DESC, turn, sequence) WHERE state = 'queued';
