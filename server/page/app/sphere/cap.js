// The part of a spherical cap that is in front, as a polygon.

import { cross, scaled, sum, unit } from "../rotation.js";
import { seen } from "./projection.js";

const STEPS = 72;

/** Directions on the rim of a cap, once around. */
export function rim(centre, halfAngle) {
  const axis = unit(centre);
  const aside = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  const other = cross(axis, aside);
  return Array.from({ length: STEPS + 1 }, (_, index) => {
    const turn = (2 * Math.PI * index) / STEPS;
    const away = sum(scaled(aside, Math.cos(turn)), scaled(other, Math.sin(turn)));
    return sum(scaled(axis, Math.cos(halfAngle)), scaled(away, Math.sin(halfAngle)));
  });
}

/**
 * The outline of what is in front of a cap, as points [right, up]; empty when nothing is.
 *
 * The rim meets the limb where the cap's centre c and the limb direction l(a) = (cos a, sin a, 0)
 * enclose the half angle: cos(a - azimuth of c) = cos(half angle) / |(c_x, c_y)|. The limb between
 * these two directions belongs to the cap.
 */
export function front(view, centre, halfAngle) {
  const c = seen(view, unit(centre));
  const flat = Math.hypot(c[0], c[1]);
  const points = rim(centre, halfAngle).map((direction) => seen(view, direction));
  if (Math.cos(halfAngle) >= flat) return points[0][2] >= 0 ? points : [];
  if (Math.cos(halfAngle) <= -flat) {
    // The limb is inside: the whole disc, less what the rim leaves free in front.
    const disc = arc(0, 2 * Math.PI);
    return points[0][2] >= 0 ? [...disc, ...points.reverse()] : disc;
  }
  const azimuth = Math.atan2(c[1], c[0]);
  const half = Math.acos(Math.cos(halfAngle) / flat);
  const visible = rotated(points.slice(0, -1)).filter((point) => point[2] >= 0);
  const ends = [azimuth - half, azimuth + half];
  const from = visible.length ? Math.atan2(visible.at(-1)[1], visible.at(-1)[0]) : ends[0];
  const near = (a) => Math.cos(from - a);
  const limb = near(ends[0]) >= near(ends[1]) ? arc(ends[0], ends[1]) : arc(ends[1], ends[0]);
  return [...visible, ...limb];
}

/** The points of the rim, beginning with the first in front after one behind. */
function rotated(points) {
  const begin = points.findIndex((point, index) => point[2] >= 0 && points.at(index - 1)[2] < 0);
  return begin < 0 ? points : [...points.slice(begin), ...points.slice(0, begin)];
}

function arc(from, to) {
  return Array.from({ length: STEPS + 1 }, (_, index) => {
    const angle = from + ((to - from) * index) / STEPS;
    return [Math.cos(angle), Math.sin(angle), 0];
  });
}
