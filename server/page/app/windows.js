// The windows of targets, in seconds from the start.

import { clockOf } from "./units.js";

/** The windows of every target of a scenario by its name, each {begin, end}; empty without any. */
export function windowsByTarget(scenario) {
  const clock = clockOf(scenario);
  const end = (seconds, date) => seconds ?? clock?.seconds(date) ?? NaN;
  const spans = (target) => (target.windows ?? [])
    .map((one) => ({ begin: end(one.from_s, one.from), end: end(one.to_s, one.to) }))
    .filter((one) => one.end >= one.begin);
  return new Map(scenario.targets.map((target) => [target.id, spans(target)]));
}

/** Those in which the stops of a flight lie, one for each stop that has any, with its name. */
export function windowsUsed(stops, windows) {
  const holds = ({ time }) => ({ begin, end }) => begin <= time + 1e-6 && time <= end + 1e-6;
  return stops.flatMap((stop) => {
    const found = windows.get(stop.name)?.find(holds(stop));
    return found ? [{ ...found, name: stop.name }] : [];
  });
}
