-- The claims on queued jobs are looked through every few seconds, and few of a long queue are claimed.
CREATE INDEX jobs_by_claim ON jobs (claimed_until_us) WHERE claimed_until_us IS NOT NULL;
