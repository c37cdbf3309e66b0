// What a spacecraft is drawn of, in body axes: box, wheels, boresights with the cones that belong to them.

import { dot, scaled, unit } from "../rotation.js";
import { boxOf, reachOf, sidesOf } from "./solid.js";

/** Wheels stand at this share of the way from the centre to the surface, on their axes. */
const WITHIN = 0.62;
const PARALLEL = 0.999;

/** The parts of a flight's spacecraft. */
export function partsOf(flight) {
  const { spacecraft } = flight.scenario;
  const box = boxOf(spacecraft.inertia_kg_m2);
  return {
    sides: sidesOf(box),
    wheels: wheels(spacecraft.wheels, flight, box),
    boresights: (spacecraft.boresights ?? []).map(({ name, axis }) => {
      const direction = unit(axis);
      return {
        name, direction, from: reachOf(box, direction),
        cones: flight.excluded.filter((cap) => cap.boresight === name).map(cone),
      };
    }),
    directions: directions(flight.excluded),
  };
}

/** Where wheels have the same axis, every second stands on the other side, and the next further inside. */
function wheels(list, flight, box) {
  const axes = list.map(({ axis }) => unit(axis));
  return list.map((wheel, index) => {
    const direction = axes[index];
    const before = axes.slice(0, index).filter((other) => Math.abs(dot(other, direction)) > PARALLEL).length;
    const away = (WITHIN * reachOf(box, direction) * (before % 2 ? -1 : 1)) / (1 + Math.floor(before / 2));
    const limit = wheel.max_speed_rad_s ?? null;
    const largest = flight.speeds[index].reduce((most, speed) => Math.max(most, Math.abs(speed)), 0);
    return {
      name: `wheel ${index}`, direction, centre: scaled(direction, away), enabled: wheel.enabled !== false,
      full: limit ?? (largest || 1), limited: limit !== null,
    };
  });
}

/**
 * A cone about a boresight. A boresight is at least the half angle away from a direction when the
 * direction is outside of the cone of that half angle about the boresight; the same holds for keep-in.
 */
function cone(cap) {
  const inward = cap.cone.startsWith("/keep_in");
  return {
    cone: cap.cone, inward,
    direction: inward ? scaled(cap.direction, -1) : cap.direction,
    halfAngle: inward ? Math.PI - cap.halfAngle : cap.halfAngle,
  };
}

/** The directions that cones are about, each once: the Sun by its name, others by their first cone. */
function directions(excluded) {
  const found = [];
  for (const cap of excluded) {
    const { direction, cone: pointer } = cone(cap);
    if (found.some((one) => dot(one.direction, direction) > 1 - 1e-9)) continue;
    found.push({ name: cap.body === "sun" ? "Sun" : pointer, sun: cap.body === "sun", direction });
  }
  return found;
}

/** Whether a boresight is on the wrong side of its cone, where its axis points in the reference frame. */
export function isViolated({ direction, halfAngle, inward }, pointing) {
  const angle = Math.acos(Math.max(-1, Math.min(1, dot(direction, pointing))));
  return inward ? angle > halfAngle : angle < halfAngle;
}
