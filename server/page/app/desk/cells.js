// What cells show of a JSON value, and the JSON of what is written into them.
//
// What cannot be read as its type goes into the document as a string: nothing that was typed is lost,
// and the service says what is wrong with it.

import { flat } from "../pretty.js";
import { find } from "./json-tree.js";
import { drop, put, rawAt } from "./json-edit.js";
import { cellOf, windowsOf } from "./windows.js";

const NUMBER = /^-?(0|[1-9]\d*)(\.\d+)?(e[+-]?\d+)?$/i;
const LOOSE = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const NONE = /^(-|–|null|none)$/i;

/** The JSON of a number as people write it; null for anything else. */
export function numberText(cell) {
  let plain = cell.trim().replace(/^[−–]/, "-").replace(/e[−–]/i, "e-");
  if (/^[+-]?\d+,\d+$/.test(plain)) plain = plain.replace(",", ".");
  if (NUMBER.test(plain)) return plain;
  return LOOSE.test(plain) && Number.isFinite(Number(plain)) ? JSON.stringify(Number(plain)) : null;
}

const words = (cell) => cell.split(/[\s,;]+/).filter(Boolean);

function vector(cell) {
  const parts = words(cell).map((part) => (NONE.test(part) ? "null" : numberText(part)));
  return parts.length && !parts.includes(null) ? `[${parts.join(", ")}]` : null;
}

const quoted = (cell) => JSON.stringify(cell);
const isString = (raw) => raw.startsWith('"');
const plain = (raw) => (isString(raw) ? JSON.parse(raw) : raw);
const items = (raw) => {
  const list = JSON.parse(raw);
  return Array.isArray(list) ? list : null;
};

/** How a type is shown and written: `read` takes JSON, `write` what is in a cell that is not empty. */
const TYPES = {
  text: { read: plain, write: quoted },
  number: { read: plain, write: (cell) => numberText(cell) ?? quoted(cell.trim()) },
  vector: {
    read: (raw) => items(raw)?.map((item) => (item === null ? "–" : plain(JSON.stringify(item)))).join(" ") ?? plain(raw),
    write: (cell) => vector(cell) ?? quoted(cell.trim()),
  },
  names: {
    read: (raw) => items(raw)?.map((item) => plain(JSON.stringify(item))).join(", ") ?? plain(raw),
    write: (cell) => JSON.stringify(cell.split(/[,;]/).map((name) => name.trim()).filter(Boolean)),
  },
  windows: {
    read: (raw) => cellOf(JSON.parse(raw)) ?? plain(raw),
    write: (cell) => flat(windowsOf(cell) ?? cell.trim()),
  },
  // The name of a boresight, or an axis of the body.
  boresight: {
    read: (raw) => items(raw)?.join(" ") ?? plain(raw),
    write: (cell) => (words(cell).length === 3 ? vector(cell) : null) ?? quoted(cell.trim()),
  },
  // One of `options`, whose values are JSON texts; another value is shown as it is.
  choice: { read: (raw) => JSON.stringify(JSON.parse(raw)), write: (cell) => cell },
};

/** What a cell of a type shows of a JSON text. */
export function shown(type, raw) {
  return raw === undefined || raw === "null" ? "" : TYPES[type].read(raw);
}

/** The JSON of what is in a cell of a type; null for an empty one. */
export function written(type, cell) {
  return cell.trim() === "" ? null : TYPES[type].write(cell);
}

/** What a cell shows of the value at a path. */
export function cellAt(text, tree, path, type) {
  return shown(type, rawAt(text, tree, path));
}

/**
 * The text with a cell written at a path. With a `length` the path leads to an item of an array of that
 * many, which is made where it is missing, and goes when it is empty unless it must be `kept`.
 */
export function withCell(text, tree, path, { type, length, kept }, cell) {
  const value = written(type, cell);
  if (!length) return value === null ? drop(text, path) : put(text, path, value);
  const array = path.slice(0, -1);
  const known = find(tree, array)?.kind === "array" ? find(tree, array).entries : [];
  const parts = Array.from({ length: Math.max(length, known.length) }, (_, index) =>
    known[index] ? text.slice(known[index].begin, known[index].node.end) : "null");
  parts[Number(path.at(-1))] = value ?? "null";
  if (!kept && parts.every((part) => part === "null")) return drop(text, array);
  return put(text, array, `[${parts.join(", ")}]`);
}
