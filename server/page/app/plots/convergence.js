// How a search went: the best plan and the bound as steps over time. Where targets have values these are
// drawn, which count first, else the times.

import { disclosure, el, table } from "../dom.js";
import { fixed, percent, significant } from "../format.js";
import { colour } from "./palette.js";
import { plot } from "./plot.js";

const HEIGHT = 190;
/** Share of the values above and below them, so that equal ones are not magnified into noise. */
const LEAST_ROOM = 0.005;

const TIMES = {
  names: ["best plan, s", "lower bound, s"], titles: ["Best plan, s", "Lower bound, s"], text: (value) => fixed(value),
  of: ({ incumbent_s: incumbent, lower_bound_s: bound, relative_gap: gap }) => ({ incumbent, bound, gap }),
};
const VALUES = {
  names: ["value of the best plan", "upper bound of the value"], titles: ["Value", "Upper bound of it"], text: (value) => significant(value, 6),
  of: ({ value = null, value_bound: bound = null }) => ({ incumbent: value, bound, gap: bound > 0 ? (bound - (value ?? 0)) / bound : null }),
};

/** A chart that takes events of a job. */
export function convergence(signal) {
  const rows = [];
  let measure = TIMES;
  const place = el("div", { class: "plot", role: "img", "aria-label": "Best plan and bound over the time of the search" });
  const names = [el("span", {}, TIMES.names[0]), el("span", {}, TIMES.names[1])];
  const key = el("ul", { class: "key" }, ["incumbent", "bound"].map((kind, index) =>
    el("li", {}, el("span", { class: `swatch ${kind}`, "aria-hidden": "true" }), names[index])));
  const note = el("p", { class: "quiet" }, "Nothing is known so far.");
  place.hidden = true;
  let drawn = null;
  let asked = false;

  function renew() {
    asked = false;
    if (signal.aborted || !rows.length) return;
    note.hidden = true;
    place.hidden = false;
    const data = [rows.map((row) => row.time), rows.map((row) => row.incumbent), rows.map((row) => row.bound)];
    if (drawn) drawn.setData(data);
    else if (place.isConnected) drawn = plot(place, options(), data, signal);
  }
  return {
    node: el("div", { class: "chart" }, el("div", { class: "chart-head" }, key), place, note,
      disclosure("Progress as a table", () => asTable(rows, measure))),
    add(event) {
      if (measure === TIMES && event.value_bound > 0) {
        measure = VALUES;
        rows.length = 0;
        names.forEach((node, index) => (node.textContent = measure.names[index]));
      }
      const known = measure.of(event);
      if (event.elapsed_s === null || (known.incumbent === null && known.bound === null)) return;
      // A new attempt begins at zero again.
      if (rows.length && event.elapsed_s < rows.at(-1).time) rows.length = 0;
      const row = { time: event.elapsed_s, ...known };
      const same = (other) => other && other.incumbent === row.incumbent && other.bound === row.bound;
      // Of a time without news only its begin and end are kept.
      if (same(rows.at(-1)) && same(rows.at(-2))) rows.pop();
      rows.push(row);
      if (!asked) requestAnimationFrame(renew);
      asked = true;
    },
  };
}

function options() {
  const steps = () => uPlot.paths.stepped({ align: 1 });
  const points = (name) => ({ show: true, size: 5, fill: () => colour(name), stroke: () => colour(name) });
  return {
    height: HEIGHT,
    scales: { x: { time: false, range: (_, min, max) => [0, Math.max(max, min + 1e-3)] }, y: { range: padded } },
    series: [
      {},
      { stroke: () => colour("incumbent"), width: 2, isStepped: true, paths: steps(), points: points("incumbent") },
      { stroke: () => colour("bound"), width: 2, isStepped: true, paths: steps(), points: points("bound") },
    ],
    axes: [{ values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, {}],
  };
}

function padded(_, min, max) {
  const room = Math.max(0.08 * (max - min), LEAST_ROOM * Math.abs(max), 1e-3);
  return [min - room, max + room];
}

function asTable(rows, { titles, text }) {
  const columns = ["Time, s", ...titles, "Gap"].map((title) => ({ title, number: true }));
  return table("Progress of the search", columns, rows.map((row) =>
    [fixed(row.time, 3), text(row.incumbent), text(row.bound), percent(row.gap)]));
}
