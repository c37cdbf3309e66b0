// What an independent flight found, beside what it may find.

import { el, table } from "./dom.js";
import { small } from "./format.js";

/** The tolerances that a verification passes with. */
export const ALLOWED = { attitude: 1e-6, rate: 1e-7, excess: 1e-6 };

/** Whether it passed, as a coloured word; `doubt` says what is wrong all the same. */
export function verdict(passed, doubt = null) {
  if (passed && doubt) return el("span", { class: "chip waits" }, `Passed, but ${doubt}`);
  return el("span", { class: `chip ${passed ? "good" : "bad"}` }, passed ? "Passed" : "Not passed");
}

/** Errors and excesses as [name, found, allowed]; texts stay as they are. */
export function checks(rows) {
  const columns = [{ title: "Largest", head: true }, { title: "Found", number: true }, { title: "Allowed", number: true }];
  const text = (value) => (typeof value === "string" ? value : small(value));
  return table("Errors and excesses of the flight", columns, rows.map(([name, ...values]) => [name, ...values.map(text)]));
}

/** A titled list of sentences or problems; nothing without any. */
export function messages(title, list) {
  if (!list?.length) return null;
  const text = (entry) => (typeof entry === "string" ? entry : entry.message ?? JSON.stringify(entry));
  return el("div", { class: "messages" }, el("h3", {}, title), el("ul", {}, list.map((entry) => el("li", {}, text(entry)))));
}

/** Names with their values; nothing without any. */
export function pairs(items) {
  if (!items.length) return null;
  return el("dl", { class: "pairs" }, items.map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))));
}
