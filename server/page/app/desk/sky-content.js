// What the sky before planning shows of a scenario.

import { excludedBy } from "../plan/keep-out.js";
import { rotate } from "../rotation.js";
import { axisOf, orientationOf } from "./orientation.js";

/** Named boresights first, then the axes of the body, as {name, boresight, axis}. */
export function axesOf(spacecraft) {
  const list = Array.isArray(spacecraft?.boresights) ? spacecraft.boresights : [];
  const named = list.filter((one) => axisOf(one?.axis, null)).map(({ name, axis }) => ({ name, boresight: name, axis: axisOf(axis, null) }));
  const plain = [["+Z", [0, 0, 1]], ["+X", [1, 0, 0]], ["+Y", [0, 1, 0]]].map(([name, axis]) => ({ name: `${name} body`, boresight: null, axis }));
  return [...named, ...plain];
}

/**
 * Targets, start and end as {name, index, direction, boresight}, where each points: its own boresight,
 * or the chosen axis of one that is given as an attitude.
 */
export function placesOf(document, { spacecraft, sun }, chosen) {
  const place = (given, name, index) => {
    const known = given && orientationOf(given, spacecraft, sun);
    if (!known) return null;
    const axis = known.axis ?? chosen.axis;
    const direction = known.direction ?? rotate(known.attitude, axis);
    return { name, index, direction, axis, boresight: known.axis ? known.boresight : chosen.boresight };
  };
  const targets = (Array.isArray(document.targets) ? document.targets : [])
    .map((target, index) => place(target ?? {}, String(target?.id ?? index + 1), index)).filter(Boolean);
  const ends = ["start", "end"].map((name) => place(document[name], name, null)).filter(Boolean);
  return { targets, ends };
}

/** The cones of all boresights, those of the chosen one apply. */
export function capsOf(document, sun, chosen) {
  const list = (cones) => (Array.isArray(cones) ? cones : []).map((cone) =>
    (cone?.direction?.body === "sun" && sun ? { ...cone, direction: sun } : cone));
  const isWhole = (cone) => cone?.direction && Number.isFinite(cone.half_angle_deg)
    && (Array.isArray(cone.direction) ? axisOf(cone.direction, null) : cone.direction.ra_dec_deg?.every?.(Number.isFinite));
  // Indices of pointers do not matter to what is drawn.
  const whole = { keep_out: list(document.keep_out).filter(isWhole), keep_in: list(document.keep_in).filter(isWhole) };
  return excludedBy(whole, null).map((cap) => ({ ...cap, applies: cap.boresight === chosen.boresight }));
}

