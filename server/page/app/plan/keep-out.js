// Cones that a plan violates, and attitudes that violate one from the beginning.

import { fixed } from "../format.js";
import { dot, rotate, unit } from "../rotation.js";

/** What is said beside a plan that is good otherwise. */
export const VIOLATED = "keep-out violated";

/** More curves than these in one plot are hard to tell apart. */
const MOST_CURVES = 6;

const CODES = ["keep_out_violated", "attitude_in_keep_out"];

/** Whether a warning is about a cone that is only reported. */
export const isKeepOut = (warning) => CODES.includes(warning.code);

/** Every stay of a boresight on the wrong side of a cone. */
export function intrusionsOf(plan) {
  return plan.margins?.keep_out_intrusions ?? [];
}

/** The closest approach to every cone; plans of former versions have only the angles. */
export function clearancesOf(plan) {
  return (plan.margins?.keep_out_clearance_deg ?? []).filter((one) => one?.cone);
}

/** The closest approach to every cone, as names and values. */
export function clearanceItems(plan) {
  return clearancesOf(plan).map((one) =>
    [`${one.boresight} from ${one.cone}`, `${fixed(one.clearance_deg, 1)}° at ${fixed(one.time_s, 1)} s`]);
}

/** The spans of time on the wrong side of cones, for the timelines. */
export function alarmsOf(plan) {
  return intrusionsOf(plan).map((one) => {
    const cone = one.cone ?? `/keep_out/${one.keep_out}`;
    const side = cone.startsWith("/keep_in") ? "outside" : "inside";
    return { kind: "cone", begin: one.from_s, end: one.to_s, depth: one.depth_deg, name: `${one.boresight ?? "boresight"} ${side} ${cone}` };
  });
}

/** What the cones of a scenario exclude: around the opposite direction, what is outside a keep-in cone. */
export function excludedBy(scenario, plan) {
  const known = new Map(clearancesOf(plan ?? {}).map((one) => [one.cone, one.direction]));
  const cap = (list, cone, index) => {
    const direction = directionOf(cone.direction) ?? known.get(`/${list}/${index}`);
    if (!direction) return [];
    const half = (cone.half_angle_deg * Math.PI) / 180;
    const inward = list === "keep_in";
    return [{
      name: `${inward ? "keep-in" : "keep-out"} of ${cone.boresight}, ${cone.half_angle_deg}°`,
      boresight: cone.boresight,
      cone: `/${list}/${index}`,
      body: cone.direction.body ?? null,
      direction: inward ? direction.map((part) => -part) : direction,
      halfAngle: inward ? Math.PI - half : half,
    }];
  };
  return ["keep_out", "keep_in"].flatMap((list) => (scenario[list] ?? []).flatMap((cone, index) => cap(list, cone, index)));
}

/** The angle to the nearest cones over time, degrees: {name, values}; negative on the wrong side. */
export function clearanceCurves(excluded, scenario, attitudes) {
  const axes = new Map((scenario.spacecraft.boresights ?? []).map(({ name, axis }) => [name, unit(axis)]));
  const curves = excluded.filter((cap) => axes.has(cap.boresight)).map((cap) => {
    const values = attitudes.map((attitude) => {
      const cosine = dot(rotate(attitude, axes.get(cap.boresight)), cap.direction);
      return ((Math.acos(Math.max(-1, Math.min(1, cosine))) - cap.halfAngle) * 180) / Math.PI;
    });
    return { name: `${cap.boresight} ${cap.cone}`, values, least: values.reduce((a, b) => Math.min(a, b), Infinity) };
  });
  return curves.sort((a, b) => a.least - b.least).slice(0, MOST_CURVES);
}

/** The unit vector of a direction; nothing for a body of the sky, whose place a plan tells. */
function directionOf(direction) {
  if (Array.isArray(direction)) return unit(direction);
  if (!direction.ra_dec_deg) return undefined;
  const [ascension, declination] = direction.ra_dec_deg.map((angle) => (angle * Math.PI) / 180);
  const flat = Math.cos(declination);
  return [flat * Math.cos(ascension), flat * Math.sin(ascension), Math.sin(declination)];
}
