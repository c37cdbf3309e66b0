// What the plots draw of a slew.

import { motion } from "../flight.js";
import { alarmsOf } from "../plan/keep-out.js";
import { excessAlarms } from "../plan/violations.js";
import { checkedSlew } from "./checked.js";

/** The flight of a slew; null when it could not be flown. */
export function slewFlight(slew, request) {
  const { states, controls } = slew.trajectory;
  if (!states.length) return null;
  const checked = checkedSlew(slew);
  const moved = motion(states, request, checked);
  const torques = {
    times: ends(controls),
    curves: request.spacecraft.wheels.map((_, wheel) => controls.flatMap((ramp) =>
      [ramp.wheel_torque_begin_nm[wheel], ramp.wheel_torque_end_nm[wheel]])),
  };
  const excesses = checked.failures.length ? excessAlarms({ ...moved, torques }) : [];
  return { ...moved, torques, alarms: [...alarmsOf(checked), ...excesses] };
}

/** Begin and end of every interval: curves may jump between two of them. */
export function ends(intervals) {
  return intervals.flatMap(({ start_s, duration_s }) => [start_s, start_s + duration_s]);
}
