-- What is proved of a leg: no slew with its conditions takes less. NULL where nothing is, and of legs
-- that were stored before.
ALTER TABLE legs ADD COLUMN certified_lower_bound_s REAL;
