// Changes of a JSON text that leave all other letters of it as they are.
//
// Paths are lists of names and indices, values are JSON texts. A text without anything is an empty object.

import { find, treeOf } from "./json-tree.js";

const EMPTY = "{\n}\n";

/** The text with a value at a path; what is missing on the way are objects. */
export function put(text, path, value) {
  const source = text.trim() ? text : EMPTY;
  let node = treeOf(source);
  for (const [depth, key] of path.entries()) {
    const rest = path.slice(depth + 1);
    if (!node.entries) return splice(source, node.begin, node.end, nested(path.slice(depth), value));
    const next = find(node, [key]);
    if (!next) return append(source, node, key, nested(rest, value));
    node = next;
  }
  return splice(source, node.begin, node.end, value);
}

/** The text without the value at a path; the same text where there is none. */
export function drop(text, path) {
  const around = find(treeOf(text), path.slice(0, -1));
  const entries = around?.entries ?? [];
  const index = entries.findLastIndex((entry) => entry.key === String(path.at(-1)));
  if (index < 0) return text;
  if (entries.length === 1) return splice(text, around.begin + 1, around.end - 1, "");
  if (index > 0) return splice(text, entries[index - 1].node.end, entries[index].node.end, "");
  return splice(text, entries[0].begin, entries[1].begin, "");
}

/** The text with values inserted before an item of the array at a path; at its end without such an item. */
export function insert(text, path, index, values) {
  if (!values.length) return text;
  const source = withArray(text, path);
  const array = find(treeOf(source), path);
  if (!array.entries.length) {
    const first = append(source, array, 0, values[0]);
    return insert(first, path, 1, values.slice(1));
  }
  const gap = separator(source, array);
  const before = array.entries[index];
  if (before) return splice(source, before.begin, before.begin, values.map((value) => value + gap).join(""));
  const { end } = array.entries.at(-1).node;
  return splice(source, end, end, values.map((value) => gap + value).join(""));
}

/** The text with other items in the array at a path, as a map from indices to values. */
export function replaceItems(text, path, values) {
  const { entries } = find(treeOf(text), path);
  return [...values].sort(([a], [b]) => b - a).reduce((source, [index, value]) =>
    splice(source, entries[index].begin, entries[index].node.end, value), text);
}

/** The text with the items of the array at a path in another order, or some of them, given by index. */
export function arrange(text, path, order) {
  const array = find(treeOf(text), path);
  const { entries } = array;
  if (!order.length) return splice(text, array.begin + 1, array.end - 1, "");
  const items = order.map((index) => text.slice(entries[index].begin, entries[index].node.end));
  const gaps = items.slice(1).map((_, index) => text.slice(entries[index].node.end, entries[index + 1].begin));
  const all = items.reduce((joined, item, index) => joined + gaps[index - 1] + item);
  return splice(text, entries[0].begin, entries.at(-1).node.end, all);
}

/** The text of the value at a path; undefined where there is none. */
export function rawAt(text, tree, path) {
  const node = find(tree, path);
  return node && text.slice(node.begin, node.end);
}

function splice(text, begin, end, value) {
  return text.slice(0, begin) + value + text.slice(end);
}

function nested(path, value) {
  return path.reduceRight((inner, key) => `{${JSON.stringify(key)}: ${inner}}`, value);
}

/** An empty array over two lines, so that its items get lines of their own. */
function withArray(text, path) {
  const node = text.trim() ? find(treeOf(text), path) : undefined;
  return node?.kind === "array" ? text : put(text, path, "[\n  ]");
}

function append(source, node, key, value) {
  const entry = node.kind === "object" ? `${JSON.stringify(key)}: ${value}` : value;
  if (node.entries.length) {
    const end = node.entries.at(-1).node.end;
    return splice(source, end, end, `${separator(source, node)}${entry}`);
  }
  const inner = source.slice(node.begin + 1, node.end - 1);
  if (!inner.includes("\n")) return splice(source, node.begin + 1, node.end - 1, entry);
  const margin = inner.slice(inner.lastIndexOf("\n") + 1);
  return splice(source, node.begin + 1, node.end - 1, `\n${margin}  ${entry}\n${margin}`);
}

/** What stands between two entries of an object or array. */
function separator(source, { begin, entries }) {
  if (entries.length > 1) return source.slice(entries[0].node.end, entries[1].begin);
  const lead = source.slice(begin + 1, entries[0].begin);
  return lead.includes("\n") ? `,${lead}` : ", ";
}
