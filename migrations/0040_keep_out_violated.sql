-- Whether a boresight is on the wrong side of a cone in the plan: cones may be only reported. NULL for
-- jobs without a plan, and for those that ended before this.
ALTER TABLE jobs ADD COLUMN keep_out_violated INTEGER;
ALTER TABLE incumbents ADD COLUMN keep_out_violated INTEGER;
