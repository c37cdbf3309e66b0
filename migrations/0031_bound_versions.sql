-- The version of the mathematics that gave a bound. A bound of another version, or of none, which was
-- stored before, is not used.
ALTER TABLE legs ADD COLUMN bound_version INTEGER;
ALTER TABLE jobs ADD COLUMN bound_version INTEGER;
