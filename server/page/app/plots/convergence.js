// How a search went: the best plan and the bound as steps over time.

import { disclosure, el, table } from "../dom.js";
import { fixed, percent } from "../format.js";
import { colour } from "./palette.js";
import { plot } from "./plot.js";

const HEIGHT = 190;
/** Share of the values above and below them, so that equal ones are not magnified into noise. */
const LEAST_ROOM = 0.005;

/** A chart that takes events of a job. */
export function convergence(signal) {
  const rows = [];
  const place = el("div", { class: "plot", role: "img", "aria-label": "Best plan and lower bound over the time of the search" });
  const key = el("ul", { class: "key" },
    el("li", {}, el("span", { class: "swatch incumbent", "aria-hidden": "true" }), "best plan, s"),
    el("li", {}, el("span", { class: "swatch bound", "aria-hidden": "true" }), "lower bound, s"));
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
      disclosure("Progress as a table", () => asTable(rows))),
    add(event) {
      if (event.elapsed_s === null || (event.incumbent_s === null && event.lower_bound_s === null)) return;
      // A new attempt begins at zero again.
      if (rows.length && event.elapsed_s < rows.at(-1).time) rows.length = 0;
      const row = { time: event.elapsed_s, incumbent: event.incumbent_s, bound: event.lower_bound_s, gap: event.relative_gap };
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

function asTable(rows) {
  const columns = [
    { title: "Time, s", number: true }, { title: "Best plan, s", number: true },
    { title: "Lower bound, s", number: true }, { title: "Gap", number: true },
  ];
  return table("Progress of the search", columns, rows.map((row) =>
    [fixed(row.time, 3), fixed(row.incumbent), fixed(row.bound), percent(row.gap)]));
}
