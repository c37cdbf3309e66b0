// The box that has the proportions of an inertia.

import { cross, dot, scaled, sum } from "../rotation.js";

const SWEEPS = 12;
/** What an inertia says nothing about, or contradicts, has this share of the longest edge. */
const LEAST = 0.12;

/**
 * The homogeneous box with the principal moments of an inertia: `axes`, its edges' directions in body
 * axes, and `half`, half their lengths, scaled so that the corners are at the distance 1. Of edges a, b, c
 * and mass m the moments are m (b^2 + c^2) / 12 and so on.
 */
export function boxOf(inertia) {
  const { moments, axes } = principal(inertia);
  const total = moments[0] + moments[1] + moments[2];
  const squares = moments.map((moment) => Math.max(0, total - 2 * moment));
  const edges = squares.map(Math.sqrt);
  const longest = Math.max(...edges) || 1;
  const half = edges.map((edge) => Math.max(LEAST, edge / longest));
  const size = Math.hypot(...half);
  return { axes, half: half.map((length) => length / size) };
}

/** Principal moments and axes of a symmetric matrix, each near the body axis of its place (Jacobi). */
function principal(matrix) {
  const a = matrix.map((row) => [...row]);
  const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < SWEEPS; sweep += 1) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (Math.abs(a[p][q]) < 1e-15 * (Math.abs(a[p][p]) + Math.abs(a[q][q]))) continue;
      // The smaller of the two angles, so that axes keep their places.
      const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.hypot(theta, 1));
      const c = 1 / Math.hypot(t, 1);
      turn(a, v, [p, q], [c, c * t]);
    }
  }
  return { moments: [0, 1, 2].map((i) => a[i][i]), axes: [0, 1, 2].map((i) => v.map((row) => row[i])) };
}

function turn(a, v, [p, q], [c, s]) {
  for (const row of a) [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
  [a[p], a[q]] = [
    a[p].map((value, i) => c * value - s * a[q][i]),
    a[p].map((value, i) => s * value + c * a[q][i]),
  ];
  for (const row of v) [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
}

/** The six sides of a box: {normal, corners}, corners once around. */
export function sidesOf({ axes, half }) {
  return [0, 1, 2].flatMap((i) => [1, -1].map((sign) => {
    const [j, k] = [(i + 1) % 3, (i + 2) % 3];
    const corner = (a, b) => [scaled(axes[i], sign * half[i]), scaled(axes[j], a * half[j]), scaled(axes[k], b * half[k])]
      .reduce(sum);
    return { normal: scaled(axes[i], sign), corners: [corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)] };
  }));
}

/** How far the box reaches from its centre in a direction. */
export function reachOf({ axes, half }, direction) {
  const parts = axes.map((axis, i) => Math.abs(dot(axis, direction)) / half[i]);
  return 1 / Math.max(...parts);
}

/** Two unit vectors across a direction and each other. */
export function across(direction) {
  const aside = cross(direction, Math.abs(direction[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]);
  const first = scaled(aside, 1 / Math.hypot(...aside));
  return [first, cross(direction, first)];
}
