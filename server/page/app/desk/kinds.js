// The kinds of rows: in which form an orientation or a direction is written, and how it becomes another.

import { axisOf, directionOf, orientationOf, rounded, written } from "./orientation.js";
import { longitudeLatitude } from "../rotation.js";

/** The forms with their names, as [kind, title]. */
export const KIND_TITLES = {
  orientation: [
    ["pointing", "RA Dec, roll free"], ["pointing_direction", "Vector, roll free"], ["pointing_sun", "Sun, roll free"],
    ["ra_dec_roll", "RA Dec roll"], ["roll_pitch_yaw", "Roll pitch yaw"], ["quaternion", "Quaternion"],
    ["mrp", "MRP"], ["matrix", "Matrix"],
  ],
  direction: [["sun", "Sun"], ["ra_dec", "RA Dec"], ["vector", "Vector"]],
};

const OF_MEMBER = {
  ra_dec_roll_deg: "ra_dec_roll", roll_pitch_yaw_deg: "roll_pitch_yaw", quaternion: "quaternion", mrp: "mrp", matrix: "matrix",
};

/** The kind of a target or state; "none" where nothing is given that is known. */
export function kindOfOrientation({ attitude, pointing } = {}) {
  if (pointing !== null && typeof pointing === "object") {
    const { direction } = pointing;
    if (direction === undefined || direction === null) return "pointing";
    if (Array.isArray(direction)) return "pointing_direction";
    if (direction.ra_dec_deg !== undefined) return "pointing_sky";
    return direction.body === "sun" ? "pointing_sun" : "none";
  }
  const name = Object.keys(attitude ?? {}).find((member) => member in OF_MEMBER);
  return OF_MEMBER[name] ?? "none";
}

/** The kind of the direction of a cone. */
export function kindOfDirection({ direction } = {}) {
  if (Array.isArray(direction)) return "vector";
  if (direction?.ra_dec_deg !== undefined) return "ra_dec";
  return direction?.body === "sun" ? "sun" : "none";
}

/** The boresight that is meant where none is named: the first one, or the +Z axis. */
export function usualBoresight(spacecraft) {
  const name = spacecraft?.boresights?.[0]?.name;
  return typeof name === "string" && name ? name : [0, 0, 1];
}

const BLANK = {
  pointing: (boresight) => ({ pointing: { boresight, ra_dec_deg: [null, null] } }),
  pointing_direction: (boresight) => ({ pointing: { boresight, direction: [null, null, null] } }),
  pointing_sun: (boresight) => ({ pointing: { boresight, direction: { body: "sun" } } }),
  ra_dec_roll: (boresight) => ({ attitude: { ra_dec_roll_deg: [null, null, null], boresight } }),
  roll_pitch_yaw: () => ({ attitude: { roll_pitch_yaw_deg: [null, null, null] } }),
  quaternion: () => ({ attitude: { quaternion: {} } }),
  mrp: () => ({ attitude: { mrp: [null, null, null] } }),
  matrix: () => ({ attitude: { matrix: [[null, null, null], [null, null, null], [null, null, null]] } }),
};

/** An orientation of a kind: {attitude} or {pointing}, with the values of a former one where they are known. */
export function orientationAs(kind, former, spacecraft, sun) {
  const known = orientationOf(former, spacecraft, sun);
  const kept = former?.pointing?.boresight ?? former?.attitude?.boresight;
  const boresight = axisOf(kept, spacecraft) ? kept : usualBoresight(spacecraft);
  if (!known) return BLANK[kind](boresight);
  const now = written(kind, known.nearest, { boresight, axis: axisOf(boresight, spacecraft) ?? [0, 0, 1] });
  if (!now.pointing || !former.pointing) return now;
  // Limits of the roll stay with a pointing that stays one.
  const { roll_min_deg: least, roll_max_deg: most } = former.pointing;
  const limits = Object.entries({ roll_min_deg: least, roll_max_deg: most }).filter(([, value]) => value !== undefined);
  return { pointing: { ...now.pointing, ...Object.fromEntries(limits) } };
}

/** The direction of a cone in another form. */
export function directionAs(kind, former, sun) {
  if (kind === "sun") return { direction: { body: "sun" } };
  const known = directionOf(former?.direction, sun);
  if (kind === "vector") return { direction: known ? known.map(rounded) : [null, null, null] };
  return { direction: { ra_dec_deg: known ? longitudeLatitude(known).map(rounded) : [null, null] } };
}

