// Cones of a slew in the form in which a plan has them.

/** What the flight of a slew found about cones. */
export function conesOf({ flight }) {
  const { keep_out_clearance_deg, keep_out_intrusions, warnings } = flight;
  return { margins: { keep_out_clearance_deg, keep_out_intrusions }, warnings };
}
