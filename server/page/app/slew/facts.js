// The figures of a slew that are read first, and what its independent flight found.

import { ALLOWED, checks, messages, pairs, verdict } from "../checks.js";
import { el, section } from "../dom.js";
import { count, fixed, seconds, significant } from "../format.js";
import { clearanceItems, isKeepOut } from "../plan/keep-out.js";
import { doubtOf } from "../plan/violations.js";
import { strip } from "../strip.js";
import { checkedSlew } from "./checked.js";

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
  const checked = checkedSlew(slew);
  return section("Verification", { head: verdict(flight.failures.length === 0, doubtOf(checked)), class: "card" },
    checks([
      ["attitude error, rad", flight.attitude_error_rad, ALLOWED.attitude],
      ["rate error, rad/s", flight.rate_error_rad_s, ALLOWED.rate],
      ["wheel speed excess", flight.wheel_speed_excess, ALLOWED.excess],
      ["torque excess", flight.torque_excess, ALLOWED.excess],
      ["body rate excess", flight.rate_excess, ALLOWED.excess],
      ["final wheel speed error, rad/s", flight.wheel_speed_error_rad_s, "10⁻⁶ of limit"],
    ]),
    pairs(clearanceItems(checked)),
    messages("Warnings", flight.warnings.filter((warning) => !isKeepOut(warning))),
    el("p", { class: "quiet" }, "Flown from the start by code that shares nothing with the optimiser."));
}
