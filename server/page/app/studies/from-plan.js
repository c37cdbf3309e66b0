// Requests for studies of a plan that there is.

/** What is not as planned, where nobody has said it: inertia by 2 %, the first attitude by 0.1°, three sigma. */
const ERRORS = { inertia_3_sigma: 0.02, initial_attitude_3_sigma_rad: 0.001745 };
const TOLERANCE_DEG = 0.1;
const SETTLE_S = 30;
/** Shares that are held back, and flights of each. */
const SHARES = [1, 0.95, 0.9, 0.8];
const RUNS = 50;

/** One flight of the plan itself. */
export function flightOfPlan(plan, scenario) {
  const { total_time_s, sequence, passages, trajectory } = plan;
  return {
    scenario,
    simulation: { errors: ERRORS, settle_s: SETTLE_S, tolerance_deg: TOLERANCE_DEG },
    plan: { total_time_s, sequence, passages, trajectory: { controls: trajectory.controls } },
  };
}

/** Plans of the scenario with shares of torque and speed, each flown many times. */
export function authorityOfPlan(_, scenario) {
  return {
    scenario,
    simulation: { errors: ERRORS, settle_s: SETTLE_S, runs: RUNS, tolerance_deg: TOLERANCE_DEG },
    authorities: SHARES.map((share) => ({ torque_authority: share, momentum_authority: share })),
  };
}
