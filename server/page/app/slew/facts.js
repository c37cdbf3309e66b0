// The figures of a slew that are read first, and what its independent flight found.

import { ALLOWED, checks, messages, pairs, verdict } from "../checks.js";
import { el, section } from "../dom.js";
import { count, fixed, seconds, significant } from "../format.js";
import { VIOLATED, clearanceItems, intrusionsOf } from "../plan/keep-out.js";
import { strip } from "../strip.js";
import { conesOf } from "./cones.js";

/** What is minimised where it is not the duration. */
const OBJECTIVES = {
  time_and_effort: "duration plus weighted effort",
  energy: "energy in the given time",
};

/** The figures. */
export function slewFacts(slew, request) {
  const kind = request.objective?.kind ?? "minimum_time";
  const joules = (value) => (value === null ? null : `${significant(value)} J`);
  return strip([
    ["Duration", seconds(slew.time_s, 3), slew.solved ? null : `not solved: ${slew.status}`],
    kind in OBJECTIVES ? ["Objective", `${fixed(slew.objective, 3)} ${slew.objective_unit}`, OBJECTIVES[kind]] : null,
    slew.continuous_time_s === null ? null
      : ["Without samples", seconds(slew.continuous_time_s, 3), "the minimum in continuous time"],
    slew.energy_bill_j === null ? null
      : ["Energy bill", joules(slew.energy_bill_j), `${joules(slew.energy_proxy_j)} if braking fed back`],
    ["Effort", `${significant(slew.effort_nm2_s)} N²m²s`, "integral of the squared torques"],
    ["Solved with", count(slew.iterations, "iteration"), `from ${count(slew.starts, "start")}`],
  ]);
}

/** The section with the errors of the flight. */
export function slewVerification(slew) {
  const { flight } = slew;
  const cones = conesOf(slew);
  const doubt = intrusionsOf(cones).length ? VIOLATED : null;
  return section("Verification", { head: verdict(flight.failures.length === 0, doubt), class: "card" },
    checks([
      ["attitude error, rad", flight.attitude_error_rad, ALLOWED.attitude],
      ["rate error, rad/s", flight.rate_error_rad_s, ALLOWED.rate],
      ["wheel speed excess", flight.wheel_speed_excess, ALLOWED.excess],
      ["torque excess", flight.torque_excess, ALLOWED.excess],
      ["body rate excess", flight.rate_excess, ALLOWED.excess],
      ["final wheel speed error, rad/s", flight.wheel_speed_error_rad_s, "10⁻⁶ of limit"],
    ]),
    pairs(clearanceItems(cones)),
    messages("Failures", flight.failures),
    messages("Warnings", flight.warnings),
    el("p", { class: "quiet" }, "Flown from the start by code that shares nothing with the optimiser."));
}
