// Any answer: its figures as tables, those inside of others below them.

import { disclosure, el, section, table } from "../dom.js";
import { significant } from "../format.js";
import { named } from "./names.js";

/** Longest list of plain values that stands in a cell. */
const FEW = 8;

/** The name of the table of what stands in nothing else. */
const ALL = "Answer";

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const isPlain = (value) => value === null || typeof value !== "object"
  || (Array.isArray(value) && value.length <= FEW && value.every((item) => item === null || typeof item !== "object"));

/** The nodes of an answer. */
export function generic({ document }) {
  return section("Figures", { class: "wide" }, figures(ALL, document));
}

/** A value and everything in it; `path` names it among the others. */
function figures(path, value) {
  if (Array.isArray(value)) return list(path, value);
  if (!isObject(value)) return el("p", {}, text(value));
  const flat = Object.entries(flattened(value));
  const plain = flat.filter(([, item]) => isPlain(item));
  const nested = flat.filter(([, item]) => !isPlain(item));
  const columns = [{ title: "Figure", head: true }, { title: "Value", number: true }];
  return el("div", {},
    plain.length ? table(path, columns, plain.map(([name, item]) => [named(name), text(item)])) : null,
    nested.map(([name, item]) => (path === ALL ? below(named(name), item, true) : below(`${path}: ${named(name)}`, item))));
}

/** Rows of a table; what does not fit into cells stands below it. */
function list(path, items) {
  if (!items.length) return el("p", { class: "quiet" }, "None.");
  const rows = items.map((item) => (isObject(item) ? flattened(item) : { value: item }));
  const names = [...new Set(rows.flatMap((row) => Object.keys(row)))];
  const fits = names.filter((name) => rows.every((row) => isPlain(row[name] ?? null)));
  const columns = [{ title: "No.", head: true }, ...fits.map((name) =>
    ({ title: named(name), number: rows.some((row) => typeof row[name] === "number") }))];
  const nested = rows.flatMap((row, index) => names.filter((name) => !fits.includes(name) && row[name] !== undefined)
    .map((name) => below(`${path}, no. ${index + 1}: ${named(name)}`, row[name])));
  return el("div", {}, table(path, columns, rows.map((row, index) =>
    [String(index + 1), ...fits.map((name) => text(row[name] ?? null))])), nested);
}

function below(path, value, open = false) {
  const node = disclosure(path, () => figures(path, value));
  node.open = open;
  return node;
}

/** An object with the members of its objects beside its own, each under its whole name. */
function flattened(value, before = "") {
  return Object.assign({}, ...Object.entries(value).map(([name, item]) =>
    (isObject(item) ? flattened(item, `${before}${name}.`) : { [`${before}${name}`]: item })));
}

function text(value) {
  if (value === null) return "–";
  if (Array.isArray(value)) return value.length ? value.map(text).join(", ") : "–";
  if (typeof value === "number") return significant(value);
  if (typeof value === "boolean") return value ? "yes" : "no";
  return String(value);
}
