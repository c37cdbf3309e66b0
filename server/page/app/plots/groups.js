// The curves that every flight has, in the units of the reader, and their samples as a table.

import { el, table } from "../dom.js";
import { valueAt } from "../flight.js";
import { fixed } from "../format.js";
import { rateUnit, speedUnit } from "../units.js";

/** More rows than this are for a program: the CSV has them. */
const MOST_ROWS = 3000;
const MILLI = 1000;

const inUnit = (lists, factor) => lists.map((values) => values && values.map((value) => factor * value));

/**
 * Groups of curves: {title, unit, names, times, curves, limits, text, steps}, of which `text` writes a
 * value; violations belong to the group by its `of`; `column` and `digits` are those of the table of samples.
 */
export function groupsOf({ times, rates, speeds, torques, limits, clearances }) {
  const wheels = speeds.map((_, wheel) => `wheel ${wheel}`);
  const numbers = speeds.map((_, wheel) => String(wheel));
  const [rate, speed] = [rateUnit(), speedUnit()];
  const group = (more, shown) => ({ times, text: (value) => fixed(value, shown), ...more });
  return [
    group({ of: "rates", title: "Body rates", unit: rate.unit, names: ["x", "y", "z"], curves: inUnit(rates, rate.factor),
      limits: inUnit(limits.rates, rate.factor), column: ["Rate", ["x", "y", "z"]], digits: rate.digits }, rate.shown),
    group({ of: "speeds", title: "Wheel speeds", unit: speed.unit, names: wheels, curves: inUnit(speeds, speed.factor),
      limits: inUnit(limits.speeds, speed.factor), column: ["Speed", numbers], digits: speed.digits }, speed.shown),
    group({ of: "torques", title: "Wheel torques", unit: "mN m", names: wheels, ...torques, curves: inUnit(torques.curves, MILLI),
      limits: inUnit(limits.torques, MILLI), column: ["Torque", numbers], digits: 3 }, 2),
    ...(clearances.length ? [group({ title: "Clearance of cones", unit: "deg", names: clearances.map(({ name }) => name),
      curves: clearances.map(({ values }) => values), limits: clearances.map(() => null),
      column: ["Clearance", clearances.map(({ name }) => name)], digits: 2 }, 1)] : []),
  ];
}

/** The value of a curve of a group at a moment. */
export const valueOf = ({ times, curves, steps }, which, time) => valueAt({ times, samples: curves[which], steps }, time);

/** All samples of a flight. */
export function samples(flight, groups, clock) {
  const columns = groups.flatMap(({ unit, column: [what, names] }) =>
    names.map((name) => ({ title: `${what} ${name}, ${unit}`, number: true })));
  const shown = flight.times.slice(0, MOST_ROWS);
  const rows = shown.map((time) => [fixed(time, 3), ...clock ? [clock.time(time, 3)] : [], ...groups.flatMap((group) =>
    group.curves.map((_, which) => fixed(valueOf(group, which, time), group.digits)))]);
  const more = flight.times.length - shown.length;
  const first = [{ title: "Time, s", number: true }, ...clock ? [{ title: clock.name, number: true }] : []];
  return el("div", {}, table("Samples of the trajectory", [...first, ...columns], rows),
    more > 0 ? el("p", { class: "quiet" }, `${more} more rows are in the CSV.`) : null);
}
