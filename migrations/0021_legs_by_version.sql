-- Finds the legs of other versions of the solver, and counts legs without reading them.
CREATE INDEX legs_by_version ON legs (solver_version);
