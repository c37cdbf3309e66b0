// Which column of a table from elsewhere is which column of the targets, and what cannot be read in it.

import { flat } from "../pretty.js";
import { numberText, written } from "./cells.js";
import { orientationAs } from "./kinds.js";
import { freeName, withCells } from "./rows.js";
import { pathIn, TARGETS } from "./tables.js";
import { windowsOf } from "./windows.js";

/** Names of columns, as `slewplan` reads tables; those of further columns are their keys. */
const NAMES = {
  id: ["id", "name", "target"],
  ra: ["ra", "ra_deg", "right_ascension", "right_ascension_deg"],
  dec: ["dec", "dec_deg", "declination", "declination_deg"],
  roll: ["roll", "roll_deg"], pitch: ["pitch", "pitch_deg"], yaw: ["yaw", "yaw_deg"],
  roll_min: ["roll_min", "roll_min_deg"], roll_max: ["roll_max", "roll_max_deg"],
  qx: ["qx", "q_x", "x"], qy: ["qy", "q_y", "y"], qz: ["qz", "q_z", "z"], qw: ["qw", "q_w", "w"],
  dwell: ["dwell", "dwell_s"], settle: ["settle", "settle_s"], windows: ["windows", "window"], value: ["value"],
};

/** The kinds in the order in which columns mean them; a roll alone belongs to two of them. */
const MEANT = [
  ["roll_pitch_yaw", ["pitch", "yaw"]], ["quaternion", ["qx", "qy", "qz", "qw"]], ["mrp", ["mrp_x", "mrp_y", "mrp_z"]],
  ["matrix", ["matrix_0", "matrix_1", "matrix_2"]], ["pointing_direction", ["direction_x", "direction_y", "direction_z"]],
  ["ra_dec_roll", ["roll"]], ["pointing", ["ra", "dec"]],
];

/** A name of a column as it is compared: `RA [deg]` is `ra_deg`. */
const plain = (name) => name.toLowerCase().split(/[^\p{L}\p{N}]+/u).filter(Boolean).join("_");

/** The key of the column that a name means; null for none. */
export function columnNamed(name) {
  const wanted = plain(name);
  const found = TARGETS.columns.find(({ key, at }) => key === wanted || NAMES[key]?.includes(wanted)
    || (Array.isArray(at) && at.at(-1) === wanted));
  return found?.key ?? null;
}

/** Whether a line is the head of a table: at least one column is known by its name, and nothing is a number. */
export function isHead(line) {
  return line.some(columnNamed) && line.every((cell) => numberText(cell) === null);
}

/** What is meant by a table without more being said: {head, keys, kind}. */
export function guess(rows) {
  const head = rows.length > 0 && isHead(rows[0]);
  const width = rows.reduce((most, row) => Math.max(most, row.length), 0);
  const named = head ? rows[0].map(columnNamed) : ["id", "ra", "dec", "roll"];
  const keys = Array.from({ length: width }, (_, index) => named[index] ?? null)
    .map((key, index, all) => (all.indexOf(key) === index ? key : null));
  return { head, keys, kind: kindMeant(keys) };
}

/** The kind of rows that columns mean. */
export function kindMeant(keys) {
  return MEANT.find(([, wanted]) => wanted.some((key) => keys.includes(key)))?.[0] ?? "pointing";
}

const columnOf = (key) => TARGETS.columns.find((column) => column.key === key);

/**
 * The targets of a table as JSON texts, and the problems of its cells as {row, column, message}: `keys`
 * has the column of the targets for each of its columns, or null; `taken` are the names that are there.
 */
export function targetsOf(rows, keys, { kind, boresight, spacecraft, taken }) {
  const problems = [];
  const names = [...taken];
  const texts = rows.map((cells, row) => {
    const report = (column, message) => problems.push({ row, column, message });
    keys.forEach((key, column) => {
      const message = key && problemOf(columnOf(key), cells[column] ?? "", kind);
      if (message) report(column, message);
    });
    const place = keys.indexOf("id");
    const given = place >= 0 ? cells[place] ?? "" : "";
    if (place >= 0 && given && names.includes(given)) report(place, "another target has this name");
    if (place >= 0 && !given) report(place, "the name is missing");
    const name = given || freeName(names, `target-${names.length + 1}`);
    names.push(name);
    const blank = orientationAs(kind, {}, spacecraft, null);
    const whole = blank.pointing ?? blank.attitude;
    if ("boresight" in whole) whole.boresight = boresight;
    const filled = keys.flatMap((key, column) => (key && key !== "id" ? [[columnOf(key), cells[column] ?? ""]] : []));
    return withCells(flat({ id: name, ...blank }), TARGETS, filled).text;
  });
  return { texts, problems };
}

/** What is wrong with a cell by itself; null for nothing. */
function problemOf(column, cell, kind) {
  if (!pathIn(column, kind)) return null;
  if (cell === "") return column.kept ? "a number is missing" : null;
  if (column.type === "number" && numberText(cell) === null) return "this is no number";
  if (column.type === "windows" && !windowsOf(cell)) return "these are no windows: write from..to";
  if (column.type === "vector" && written("vector", cell).startsWith('"')) return "these are no numbers";
  if (column.key === "dec" && Math.abs(Number(numberText(cell))) > 90) return "the declination is beyond a pole";
  return null;
}

/** The columns that a table can be mapped to for a kind of rows, as [key, title]. */
export function choices(kind) {
  return TARGETS.columns.filter((column) => pathIn(column, kind))
    .map(({ key, title, unit }) => [key, unit ? `${title}, ${unit}` : title]);
}
