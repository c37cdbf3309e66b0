// Vectors [x, y, z] and quaternions [x, y, z, w] that map body vectors to reference vectors.

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const scaled = (a, factor) => a.map((value) => factor * value);
export const sum = (a, b) => a.map((value, index) => value + b[index]);

/** The vector with length one; +x for the zero vector. */
export function unit(a) {
  const length = Math.hypot(...a);
  return length > 0 ? scaled(a, 1 / length) : [1, 0, 0];
}

/** The components of a quaternion as it stands in a plan. */
export const quaternion = ({ x, y, z, w }) => [x, y, z, w];

/** q v q*, by v + 2 w (u x v) + 2 u x (u x v) with u the vector part. */
export function rotate(q, v) {
  const turn = cross(q, v);
  return sum(v, sum(scaled(turn, 2 * q[3]), scaled(cross(q, turn), 2)));
}

/** The opposite rotation. */
export const conjugate = ([x, y, z, w]) => [-x, -y, -z, w];

/** The attitude at a fraction of the way, along the shorter great circle of quaternions. */
export function slerp(from, to, fraction) {
  let cosine = from.reduce((total, value, index) => total + value * to[index], 0);
  const end = cosine < 0 ? scaled(to, -1) : to;
  cosine = Math.min(1, Math.abs(cosine));
  const angle = Math.acos(cosine);
  if (angle < 1e-6) return from;
  const [a, b] = [Math.sin((1 - fraction) * angle), Math.sin(fraction * angle)];
  return sum(scaled(from, a / Math.sin(angle)), scaled(end, b / Math.sin(angle)));
}

/** The body axis that points to north at roll 0: +Z, or +X where the boresight lies along Z, across it. */
export function upward(boresight) {
  const axis = Math.hypot(boresight[0], boresight[1]) < 1e-6 ? [1, 0, 0] : [0, 0, 1];
  return unit(sum(axis, scaled(boresight, -dot(axis, boresight))));
}

/** Longitude and latitude of a direction, degrees. */
export function longitudeLatitude(v) {
  const [x, y, z] = unit(v);
  const degrees = 180 / Math.PI;
  return [(Math.atan2(y, x) * degrees + 360) % 360, Math.asin(Math.max(-1, Math.min(1, z))) * degrees];
}
