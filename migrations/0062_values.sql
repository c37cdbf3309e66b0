-- What the targets are worth that the best plan so far visits, and an upper bound of that; NULL where no
-- target has a value.
ALTER TABLE jobs ADD COLUMN value REAL;
ALTER TABLE jobs ADD COLUMN value_bound REAL;
ALTER TABLE incumbents ADD COLUMN value REAL;
