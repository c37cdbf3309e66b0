// The unit sphere as seen from outside and far away, the pole of the frame upwards.

import { dot } from "../rotation.js";

const RADIANS = Math.PI / 180;

/** A view on the direction at a longitude and latitude, degrees. */
export function viewOn(longitude, latitude) {
  const [cl, sl] = [Math.cos(longitude * RADIANS), Math.sin(longitude * RADIANS)];
  const [cb, sb] = [Math.cos(latitude * RADIANS), Math.sin(latitude * RADIANS)];
  return { right: [-sl, cl, 0], up: [-sb * cl, -sb * sl, cb], ahead: [cb * cl, cb * sl, sb] };
}

/** Right, up and towards the viewer; what is towards the viewer is in front. */
export function seen(view, direction) {
  return [dot(view.right, direction), dot(view.up, direction), dot(view.ahead, direction)];
}

/** A curve on the sphere as two paths of an SVG: what is in front, and what is behind. */
export function paths(view, directions, place) {
  const parts = { front: "", back: "" };
  let before = null;
  for (const direction of directions) {
    const point = seen(view, direction);
    const side = point[2] >= 0 ? "front" : "back";
    if (!before) {
      parts[side] += `M${place(point)}`;
    } else if (before.side === side) {
      parts[side] += `L${place(point)}`;
    } else {
      const limb = place(crossing(before.point, point));
      parts[before.side] += `L${limb}`;
      parts[side] += `M${limb}L${place(point)}`;
    }
    before = { point, side };
  }
  return parts;
}

/** Where the way between two points crosses the limb. */
function crossing(a, b) {
  const fraction = a[2] / (a[2] - b[2]);
  const [x, y] = [0, 1].map((axis) => a[axis] + fraction * (b[axis] - a[axis]));
  const length = Math.hypot(x, y) || 1;
  return [x / length, y / length, 0];
}

/** Meridians and parallels every so many degrees. */
export function graticule(step) {
  const direction = (longitude, latitude) => viewOn(longitude, latitude).ahead;
  const range = (from, to, by) => Array.from({ length: Math.round((to - from) / by) + 1 }, (_, index) => from + by * index);
  const meridians = range(0, 360 - step, step).map((longitude) =>
    range(-90, 90, 5).map((latitude) => direction(longitude, latitude)));
  const parallels = range(step - 90, 90 - step, step).map((latitude) =>
    range(0, 360, 5).map((longitude) => direction(longitude, latitude)));
  return [...meridians, ...parallels];
}
