// The tables of a scenario, described: which kinds of rows there are, and which columns they have.
//
// A column is {key, title, unit, type, at, ...}: `at` is the pointer in a row, or one for each kind of
// row that has it. `length` is that of the array which the last part of the pointer counts. Columns
// that are `optional` are shown where they hold something, or are asked for. A further field of a
// target is a further entry here.

import { pathOf } from "./json-tree.js";
import { WINDOWS_HINT } from "./windows.js";
import { KIND_TITLES, kindOfDirection, kindOfOrientation } from "./kinds.js";

const column = (key, title, type, at, more = {}) => ({
  key, title, type, ...more,
  at: typeof at === "string" ? pathOf(at) : Object.fromEntries(Object.entries(at).map(([kind, pointer]) => [kind, pathOf(pointer)])),
});

/** The path of a column in a row of a kind; undefined where such rows have none. */
export function pathIn(column, kind) {
  return Array.isArray(column.at) ? column.at : column.at[kind];
}

/** The length of the array that a column counts in a row of a kind; undefined where it counts none. */
export function lengthIn({ length }, kind) {
  return typeof length === "object" ? length[kind] : length;
}

const degrees = { unit: "°" };
const quantity = (key, title, at, more) => column(key, title, "number", at, more);

const POINTED = {
  pointing: "/pointing/boresight", pointing_direction: "/pointing/boresight", pointing_sky: "/pointing/boresight",
  pointing_sun: "/pointing/boresight", ra_dec_roll: "/attitude/boresight",
};
const sky = (index) => ({
  pointing: `/pointing/ra_dec_deg/${index}`, pointing_sky: `/pointing/direction/ra_dec_deg/${index}`,
  ra_dec_roll: `/attitude/ra_dec_roll_deg/${index}`,
});
const limit = (name) => Object.fromEntries(["pointing", "pointing_direction", "pointing_sky", "pointing_sun"]
  .map((kind) => [kind, `/pointing/${name}`]));
const lengthOfSky = { pointing: 2, pointing_sky: 2, ra_dec_roll: 3 };
const three = { length: 3, kept: true };

/** Where something looks: an attitude in one of its forms, or a boresight that is pointed. */
export const ORIENTATION = [
  column("boresight", "Boresight", "boresight", POINTED),
  column("ra", "RA", "number", sky(0), { ...degrees, length: lengthOfSky, kept: true }),
  column("dec", "Dec", "number", sky(1), { ...degrees, length: lengthOfSky, kept: true }),
  ...["x", "y", "z"].map((axis, index) => column(`direction_${axis}`, axis.toUpperCase(), "number",
    { pointing_direction: `/pointing/direction/${index}` }, three)),
  column("roll", "Roll", "number", { ra_dec_roll: "/attitude/ra_dec_roll_deg/2", roll_pitch_yaw: "/attitude/roll_pitch_yaw_deg/0" }, { ...degrees, ...three }),
  column("pitch", "Pitch", "number", { roll_pitch_yaw: "/attitude/roll_pitch_yaw_deg/1" }, { ...degrees, ...three }),
  column("yaw", "Yaw", "number", { roll_pitch_yaw: "/attitude/roll_pitch_yaw_deg/2" }, { ...degrees, ...three }),
  column("roll_min", "Roll from", "number", limit("roll_min_deg"), { ...degrees, optional: true }),
  column("roll_max", "Roll to", "number", limit("roll_max_deg"), { ...degrees, optional: true }),
  ...["x", "y", "z", "w"].map((part) => column(`q${part}`, `q ${part}`, "number", { quaternion: `/attitude/quaternion/${part}` })),
  ...["x", "y", "z"].map((part, index) => column(`mrp_${part}`, `MRP ${part}`, "number", { mrp: `/attitude/mrp/${index}` }, three)),
  ...[0, 1, 2].map((row) => column(`matrix_${row}`, `Row ${row + 1}`, "vector", { matrix: `/attitude/matrix/${row}` }, { ...three, wide: true })),
];

const AXES = [["[]", "none"], ...[["x"], ["y"], ["z"], ["x", "y"], ["x", "z"], ["y", "z"], ["x", "y", "z"]]
  .map((axes) => [JSON.stringify(axes), axes.join(" ")])];

const rows = (key, noun, path, more) => ({ key, noun, path, kindOf: () => "row", kinds: null, members: [], ...more });

export const TARGETS = rows("targets", "target", ["targets"], {
  title: "Targets", kinds: KIND_TITLES.orientation, kindOf: kindOfOrientation, members: ["attitude", "pointing"], named: "id",
  columns: [
    column("id", "Name", "text", "/id", { names: ["id", "name", "target"], head: true }),
    ...ORIENTATION,
    column("zero_rate_axes", "Rates zero", "choice", "/zero_rate_axes", { options: AXES, unset: "all", optional: true }),
    column("rate_min", "Rate from", "vector", "/rate_min_rad_s", { unit: "rad/s", optional: true, wide: true, hint: "x y z, – for none" }),
    column("rate_max", "Rate to", "vector", "/rate_max_rad_s", { unit: "rad/s", optional: true, wide: true, hint: "x y z, – for none" }),
    column("settle", "Settle", "number", "/settle_s", { unit: "s", optional: true }),
    column("dwell", "Dwell", "number", "/dwell_s", { unit: "s", optional: true }),
    column("windows", "Windows", "windows", "/windows", { optional: true, wide: true, hint: WINDOWS_HINT }),
    column("value", "Value", "number", "/value", { optional: true, hint: "may be left out for this; without one it must be visited" }),
    column("position", "Position", "number", "/position", { optional: true }),
    column("after", "After", "names", "/after", { optional: true, wide: true, hint: "names, with commas between" }),
  ],
});

const vector = (title, name, kind, more) => ["x", "y", "z"].map((axis, index) =>
  column(`${name}_${axis}`, `${title} ${axis}`.trim(), "number", kind ? { [kind]: `/${name}/${index}` } : `/${name}/${index}`, { length: 3, kept: true, ...more }));

export const WHEELS = rows("wheels", "wheel", ["spacecraft", "wheels"], {
  title: "Wheels", fresh: () => ({ axis: [null, null, null] }),
  columns: [
    ...vector("Axis", "axis"),
    quantity("inertia", "Inertia", "/inertia_kg_m2", { unit: "kg m²" }),
    quantity("torque", "Torque", "/max_torque_nm", { unit: "N m" }),
    quantity("least", "Least torque", "/min_torque_nm", { unit: "N m", optional: true }),
    quantity("speed", "Speed", "/max_speed_rad_s", { unit: "rad/s" }),
    column("enabled", "Enabled", "choice", "/enabled", { options: [["true", "yes"], ["false", "no: locked"]], unset: "yes", optional: true }),
    column("normalize", "Axis scaled", "choice", "/normalize_axis", { options: [["true", "yes"], ["false", "as given"]], unset: "yes", optional: true }),
  ],
});

export const BORESIGHTS = rows("boresights", "boresight", ["spacecraft", "boresights"], {
  title: "Boresights", named: "name", fresh: (index) => ({ name: index ? `boresight-${index + 1}` : "camera", axis: [0, 0, 1] }),
  columns: [column("name", "Name", "text", "/name", { head: true }), ...vector("Axis", "axis")],
});

/** Keep-out or keep-in cones. */
export function cones(key, title) {
  const sky = (index) => ({ ra_dec: `/direction/ra_dec_deg/${index}` });
  return rows(key, "cone", [key], {
    title, kinds: KIND_TITLES.direction, kindOf: kindOfDirection, members: ["direction"],
    columns: [
      column("boresight", "Boresight", "boresight", "/boresight", { head: true }),
      column("ra", "RA", "number", sky(0), { ...degrees, length: 2, kept: true }),
      column("dec", "Dec", "number", sky(1), { ...degrees, length: 2, kept: true }),
      ...vector("", "direction", "vector"),
      column("half", "Half angle", "number", "/half_angle_deg", degrees),
      column("applies", "Applies", "choice", "/applies", {
        unset: "always", options: [['"always"', "always"], ['"at_targets"', "at targets"], ['"report"', "report only"]],
      }),
    ],
  });
}
