// The figures that are read first.

import { el } from "./dom.js";

/** Figures as [name, value, note], beside each other; what is null or false is left out. */
export function strip(items) {
  return el("dl", { class: "facts" }, items.filter(Boolean).map(([name, value, note]) =>
    el("div", {}, el("dt", {}, name), el("dd", {}, el("span", { class: "figure" }, value),
      note ? el("span", { class: "note" }, note) : null))));
}
