// What was found about a slew in the form in which a plan has it.

/** Failures of the flight of a slew, and what it found about cones. */
export function checkedSlew({ flight }) {
  const { keep_out_clearance_deg, keep_out_intrusions, warnings, failures } = flight;
  return { margins: { keep_out_clearance_deg, keep_out_intrusions }, warnings, failures };
}
