-- Until when a queued job is kept for the process that has claimed it (boot_id) and has not stored its
-- begin. Processes of the version before pass over no such job: they take it, with the next fence.
ALTER TABLE jobs ADD COLUMN claimed_until_us INTEGER;
