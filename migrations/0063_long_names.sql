-- Postgres refuses an entry of an index beyond some 2,700 bytes, and no query has read this index: a name may be
-- as long as its scenario.
DROP INDEX jobs_by_name;
