// Attitudes and pointings in their forms, read and written. Quaternions are [x, y, z, w] and map body
// vectors to the reference frame, angles are in degrees.

import { cross, dot, longitudeLatitude, rotate, scaled, unit, upward } from "../rotation.js";

const RADIANS = Math.PI / 180;
/** Digits of what is written: a thousandth of an arc second. */
const DIGITS = 9;

export const rounded = (value) => {
  const short = Number(value.toFixed(DIGITS));
  return Object.is(short, -0) ? 0 : short;
};

/** The product of two rotations, the right one first. */
export function product([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/** The turn about an axis. */
export function turn(axis, degrees) {
  const half = 0.5 * degrees * RADIANS;
  return [...scaled(unit(axis), Math.sin(half)), Math.cos(half)];
}

/** The direction of a right ascension and declination. */
export function skyDirection([ascension, declination]) {
  const flat = Math.cos(declination * RADIANS);
  return [flat * Math.cos(ascension * RADIANS), flat * Math.sin(ascension * RADIANS), Math.sin(declination * RADIANS)];
}

/** The shortest turn from one direction to another. */
export function arc(from, to) {
  const [a, b] = [unit(from), unit(to)];
  const axis = cross(a, b);
  const size = Math.hypot(...axis);
  if (size < 1e-12) return dot(a, b) > 0 ? [0, 0, 0, 1] : turn(upward(a), 180);
  return turn(axis, Math.atan2(size, dot(a, b)) / RADIANS);
}

/** The attitude whose columns are the body axes. */
function ofMatrix(m) {
  const trace = m[0][0] + m[1][1] + m[2][2];
  const squares = [m[0][0], m[1][1], m[2][2]].map((own) => 1 + 2 * own - trace).concat(1 + trace);
  const largest = squares.indexOf(Math.max(...squares));
  const [x, y, z] = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
  const [xy, xz, yz] = [m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] + m[2][1]];
  const parts = [[squares[0], xy, xz, x], [xy, squares[1], yz, y], [xz, yz, squares[2], z], [x, y, z, squares[3]]];
  // Entries that are rounded are not quite those of a rotation.
  return scaled(parts[largest], 1 / Math.hypot(...parts[largest]));
}

/** The columns are the body axes in the reference frame. */
function matrixOf(q) {
  const columns = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => rotate(q, axis));
  return [0, 1, 2].map((row) => columns.map((column) => column[row]));
}

/** The direction to north at a right ascension and declination, at the poles too. */
function northAt([ascension, declination]) {
  const [a, d] = [ascension * RADIANS, declination * RADIANS];
  return [-Math.sin(d) * Math.cos(a), -Math.sin(d) * Math.sin(a), Math.cos(d)];
}

/** The attitude that points a boresight at a direction with a roll. */
function pointed(direction, boresight, roll, north = upward(unit(direction))) {
  const [ahead, axis] = [unit(direction), unit(boresight)];
  const up = upward(axis);
  const frame = (a, b) => [a, b, cross(a, b)];
  const [reference, body] = [frame(ahead, north), frame(axis, up)];
  const matrix = [0, 1, 2].map((row) => [0, 1, 2].map((column) =>
    reference.reduce((total, one, index) => total + one[row] * body[index][column], 0)));
  return product(ofMatrix(matrix), turn(axis, roll));
}

/** The roll about a boresight, from where the body's up points to north. */
function rollOf(q, boresight) {
  const level = pointed(rotate(q, unit(boresight)), boresight, 0);
  const [up, now] = [rotate(level, upward(unit(boresight))), rotate(q, upward(unit(boresight)))];
  const ahead = rotate(q, unit(boresight));
  return Math.atan2(dot(ahead, cross(up, now)), dot(up, now)) / RADIANS;
}

const numbers = (list, length) => Array.isArray(list) && list.length === length && list.every((one) => Number.isFinite(one));
const isDirection = (list) => numbers(list, 3) && Math.hypot(...list) > 0;

/** The body axis of a boresight by its name or as it is; null where there is none. */
export function axisOf(choice, spacecraft) {
  const named = Array.isArray(spacecraft?.boresights) ? spacecraft.boresights.find((one) => one?.name === choice) : null;
  const axis = typeof choice === "string" ? named?.axis : choice;
  return isDirection(axis) ? unit(axis) : null;
}

/** The unit vector of a direction as scenarios write it; null where it cannot be told. */
export function directionOf(direction, sun) {
  if (isDirection(direction)) return unit(direction);
  if (numbers(direction?.ra_dec_deg, 2)) return skyDirection(direction.ra_dec_deg);
  return direction?.body === "sun" ? sun : null;
}

/**
 * What is known of where a target or state looks: {axis, boresight, direction} of a boresight that is
 * pointed, with the `attitude` where its roll is given, or an attitude alone; null without anything.
 */
export function orientationOf({ attitude, pointing } = {}, spacecraft, sun) {
  if (pointing) {
    const axis = axisOf(pointing.boresight, spacecraft);
    const direction = directionOf(pointing.direction ?? { ra_dec_deg: pointing.ra_dec_deg }, sun);
    if (!axis || !direction) return null;
    const limits = [pointing.roll_min_deg, pointing.roll_max_deg];
    const roll = numbers(limits, 2) ? (limits[0] + limits[1]) / 2 : 0;
    return { axis, boresight: pointing.boresight, direction, attitude: null, nearest: pointed(direction, axis, roll) };
  }
  if (numbers(attitude?.ra_dec_roll_deg, 3)) {
    const axis = axisOf(attitude.boresight, spacecraft);
    const [ascension, declination, roll] = attitude.ra_dec_roll_deg;
    if (!axis) return null;
    const direction = skyDirection([ascension, declination]);
    const q = pointed(direction, axis, roll, northAt([ascension, declination]));
    return { axis, boresight: attitude.boresight, direction, attitude: q, nearest: q };
  }
  const q = quaternionOf(attitude);
  return q && { axis: null, boresight: null, direction: null, attitude: q, nearest: q };
}

function quaternionOf(attitude) {
  const { quaternion, roll_pitch_yaw_deg: angles, mrp, matrix } = attitude ?? {};
  if (quaternion) {
    const q = [quaternion.x, quaternion.y, quaternion.z, quaternion.w];
    const size = Math.hypot(...q);
    return numbers(q, 4) && size > 0 ? scaled(q, 1 / size) : null;
  }
  if (numbers(angles, 3)) {
    return product(product(turn([0, 0, 1], angles[2]), turn([0, 1, 0], angles[1])), turn([1, 0, 0], angles[0]));
  }
  if (numbers(mrp, 3)) {
    const squared = dot(mrp, mrp);
    return [...scaled(mrp, 2 / (1 + squared)), (1 - squared) / (1 + squared)];
  }
  return Array.isArray(matrix) && matrix.length === 3 && matrix.every((row) => numbers(row, 3)) ? ofMatrix(matrix) : null;
}

/** An attitude in a form, as {attitude} or {pointing} of a document. */
export function written(form, q, { boresight, axis }) {
  const ahead = axis && rotate(q, axis);
  const radec = () => longitudeLatitude(ahead).map(rounded);
  const forms = {
    pointing: () => ({ pointing: { boresight, ra_dec_deg: radec() } }),
    pointing_direction: () => ({ pointing: { boresight, direction: ahead.map(rounded) } }),
    pointing_sun: () => ({ pointing: { boresight, direction: { body: "sun" } } }),
    ra_dec_roll: () => ({ attitude: { ra_dec_roll_deg: [...radec(), rounded(rollOf(q, axis))], boresight } }),
    roll_pitch_yaw: () => ({ attitude: { roll_pitch_yaw_deg: rollPitchYaw(q).map(rounded) } }),
    quaternion: () => ({ attitude: { quaternion: Object.fromEntries(q.map((part, index) => ["xyzw"[index], rounded(part)])) } }),
    mrp: () => ({ attitude: { mrp: shortMrp(q).map(rounded) } }),
    matrix: () => ({ attitude: { matrix: matrixOf(q).map((row) => row.map(rounded)) } }),
  };
  return forms[form]();
}

function rollPitchYaw(q) {
  const m = matrixOf(q);
  const pitch = Math.asin(Math.max(-1, Math.min(1, -m[2][0])));
  // Where pitch is a quarter turn only a sum of roll and yaw counts.
  const level = Math.hypot(m[0][0], m[1][0]) > 1e-9;
  const roll = level ? Math.atan2(m[2][1], m[2][2]) : 0;
  const yaw = level ? Math.atan2(m[1][0], m[0][0]) : Math.atan2(-m[0][1], m[1][1]);
  return [roll, pitch, yaw].map((angle) => angle / RADIANS);
}

/** The parameters of at most a half turn. */
function shortMrp(q) {
  const near = q[3] < 0 ? scaled(q, -1) : q;
  return scaled(near.slice(0, 3), 1 / (1 + near[3]));
}

/** What is written of a target or state after its boresight has been turned to another direction. */
export function moved(given, axis, direction, spacecraft, sun) {
  const { attitude, pointing } = given;
  const radec = longitudeLatitude(direction).map(rounded);
  if (pointing) {
    const { direction: former, ...rest } = pointing;
    if (former === undefined) return { pointing: { ...rest, ra_dec_deg: radec } };
    return { pointing: { ...pointing, direction: Array.isArray(former) ? direction.map(rounded) : { ra_dec_deg: radec } } };
  }
  if (attitude?.ra_dec_roll_deg) {
    return { attitude: { ...attitude, ra_dec_roll_deg: [...radec, attitude.ra_dec_roll_deg[2]] } };
  }
  const q = orientationOf(given, spacecraft, sun)?.attitude;
  const form = { quaternion: "quaternion", roll_pitch_yaw_deg: "roll_pitch_yaw", mrp: "mrp", matrix: "matrix" }[Object.keys(attitude ?? {})[0]];
  if (!q || !form) return null;
  return written(form, product(arc(rotate(q, axis), direction), q), {});
}

/** A direction moved east and north by degrees. */
export function shifted(direction, east, north) {
  const [longitude, latitude] = longitudeLatitude(direction);
  const up = Math.max(-90, Math.min(90, latitude + north));
  return skyDirection([longitude + east / Math.max(0.05, Math.cos(up * RADIANS)), up]);
}
