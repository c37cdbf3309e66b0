// What can be done with the rows of a table of the scenario, as changes of its text.

import { withCell } from "./cells.js";
import { arrange, insert, put, rawAt, replaceItems } from "./json-edit.js";
import { find, treeOf } from "./json-tree.js";
import { directionAs, kindOfOrientation, orientationAs, usualBoresight } from "./kinds.js";
import { flat } from "../pretty.js";
import { lengthIn, pathIn } from "./tables.js";

/** Where a new plan begins, until it is said. */
const START = '{"attitude": {"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}}}';
const USUAL_CONE_DEG = 30;

/** The rows of a table: their values; empty where the document has none. */
export function rowsOf(document, { path }) {
  const list = path.reduce((at, key) => at?.[key], document);
  return Array.isArray(list) ? list : [];
}

/** A name that no other row has, like another name. */
export function freeName(taken, like) {
  if (!taken.includes(like)) return like;
  const stem = like.replace(/-\d+$/, "");
  for (let number = 2; ; number += 1) if (!taken.includes(`${stem}-${number}`)) return `${stem}-${number}`;
}

/** The text with one more row after another one, of its kind; at the end without one. */
export function added({ draft, document, spacecraft }, table, after) {
  const rows = rowsOf(document, table);
  const row = fresh(table, rows, rows[after ?? rows.length - 1], spacecraft);
  const index = after === null ? rows.length : after + 1;
  return { text: insert(begun(draft.text, document), table.path, index, [flat(row)]), index };
}

/** A text without a start gets one: every scenario has it. */
export function begun(text, { start }) {
  return start === undefined ? put(text, ["start"], START) : text;
}

/** A new row like another one. */
export function fresh(table, rows, like, spacecraft) {
  if (table.fresh) return table.fresh(rows.length);
  if (table.kinds && table.named) {
    const kind = kindOfOrientation(like);
    const usual = kind === "none" ? "pointing" : kind;
    const blank = orientationAs(usual === "pointing_sky" ? "pointing" : usual, {}, spacecraft, null);
    if (like?.pointing?.boresight !== undefined && blank.pointing) blank.pointing.boresight = like.pointing.boresight;
    return { [table.named]: freeName(rows.map((row) => row?.[table.named]), `${table.noun}-${rows.length + 1}`), ...blank };
  }
  return { boresight: like?.boresight ?? usualBoresight(spacecraft), direction: { body: "sun" }, half_angle_deg: USUAL_CONE_DEG };
}

/** The text with copies of rows after them, under other names. */
export function doubled({ draft, document }, table, [low, high]) {
  const rows = rowsOf(document, table);
  const taken = rows.map((row) => row?.[table.named]);
  const copies = rows.slice(low, high + 1).map((row, offset) => {
    const raw = rawAt(draft.text, draft.tree, [...table.path, low + offset]);
    if (!table.named) return raw;
    const name = freeName(taken, String(row?.[table.named] ?? table.noun));
    taken.push(name);
    return put(raw, [table.named], JSON.stringify(name));
  });
  return insert(draft.text, table.path, high + 1, copies);
}

/** The text without rows. */
export function removed({ draft, document }, table, [low, high]) {
  const kept = rowsOf(document, table).map((_, index) => index).filter((index) => index < low || index > high);
  return arrange(draft.text, table.path, kept);
}

/** The text with rows one place further up (-1) or down (1); null where they cannot go. */
export function shifted({ draft, document }, table, [low, high], by) {
  const order = rowsOf(document, table).map((_, index) => index);
  if (low + by < 0 || high + by >= order.length) return null;
  order.splice(low + by, 0, ...order.splice(low, high - low + 1));
  return arrange(draft.text, table.path, order);
}

/** The text with a row of another kind, which looks where it looked. */
export function rekinded({ draft, document, spacecraft, sun }, { path, members }, index, kind) {
  return withMembers(draft.text, [...path, index], members, as(kind, at(document, [...path, index]), members, { spacecraft, sun }));
}

const at = (document, path) => path.reduce((value, key) => value?.[key], document) ?? {};
const as = (kind, former, members, { spacecraft, sun }) =>
  members.includes("attitude") ? orientationAs(kind, former, spacecraft, sun) : directionAs(kind, former, sun);

/** The text with some members of an object replaced by others: the first of them keeps its place. */
export function withMembers(text, path, members, values) {
  const raw = rawAt(text, treeOf(text), path) ?? "{}";
  const tree = treeOf(raw);
  const name = members.find((member) => find(tree, [member])) ?? Object.keys(values)[0];
  const [key] = Object.keys(values);
  if (name === key) return put(text, [...path, key], flat(values[key]));
  const entry = tree.entries.findLast((one) => one.key === name);
  return put(text, path, entry
    ? `${raw.slice(0, entry.begin)}${JSON.stringify(key)}: ${flat(values[key])}${raw.slice(entry.node.end)}`
    : put(raw, [key], flat(values[key])));
}

/** The text of a row with cells written, as [column, cell]; how many had no place is counted. */
export function withCells(raw, table, cells) {
  const kind = table.kindOf(JSON.parse(raw));
  return cells.reduce(({ text, left }, [column, cell]) => {
    const path = column && pathIn(column, kind);
    if (!path) return { text, left: left + (cell.trim() ? 1 : 0) };
    return { text: withCell(text, treeOf(text), path, { ...column, length: lengthIn(column, kind) }, cell), left };
  }, { text: raw, left: 0 });
}

/** The text with a block of cells from a row and a column on; more rows are added as they are needed. */
export function withBlock({ draft, document, spacecraft }, table, columns, [row, column], block) {
  const rows = [...rowsOf(document, table)];
  const [changed, more] = [new Map(), []];
  let left = 0;
  for (const [offset, line] of block.entries()) {
    const index = row + offset;
    let raw = rawAt(draft.text, draft.tree, [...table.path, index]);
    if (raw === undefined) {
      rows.push(fresh(table, rows, rows.at(-1), spacecraft));
      raw = flat(rows.at(-1));
    }
    const done = withCells(raw, table, line.map((cell, place) => [columns[column + place], cell]));
    left += done.left;
    if (rowsOf(document, table)[index] === undefined) more.push(done.text);
    else changed.set(index, done.text);
  }
  const text = changed.size ? replaceItems(draft.text, table.path, changed) : begun(draft.text, document);
  return { text: insert(text, table.path, rows.length, more), left };
}
