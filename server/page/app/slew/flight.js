// What the plots draw of a slew.

import { motion } from "../flight.js";
import { alarmsOf } from "../plan/keep-out.js";
import { conesOf } from "./cones.js";

/** The flight of a slew; null when it could not be flown. */
export function slewFlight(slew, request) {
  const { states, controls } = slew.trajectory;
  if (!states.length) return null;
  const cones = conesOf(slew);
  const moved = motion(states, request, cones);
  const wheels = request.spacecraft.wheels;
  return {
    ...moved,
    alarms: alarmsOf(cones),
    torques: {
      times: ends(controls),
      curves: wheels.map((_, wheel) => controls.flatMap((ramp) =>
        [ramp.wheel_torque_begin_nm[wheel], ramp.wheel_torque_end_nm[wheel]])),
    },
  };
}

/** Begin and end of every interval: curves may jump between two of them. */
export function ends(intervals) {
  return intervals.flatMap(({ start_s, duration_s }) => [start_s, start_s + duration_s]);
}
