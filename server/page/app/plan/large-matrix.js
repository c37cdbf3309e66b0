// The matrix of more places than a table has room for: a picture, and the legs of one place as a table.

import { request } from "../api.js";
import { el, table } from "../dom.js";
import { failure } from "../failure.js";
import { count, fixed, seconds } from "../format.js";
import { heatMap } from "./heat-map.js";

const KINDS = [["rest_to_rest", "solved, as far as known"], ["certified", "proved bounds"]];

/**
 * Fills `body` with the matrix of places {name} as `query` asks for them, and `tools` with its controls;
 * `isFlown` tells which legs the plan has.
 */
export function largeMatrix({ places, query, isFlown, body, tools }, signal) {
  const kind = el("select", { id: "matrix-kind" }, KINDS.map(([value, text]) => el("option", { value }, text)));
  const buttons = el("span", { class: "tools" });
  tools.append(el("label", { for: kind.id }, "Times"), kind, buttons);
  let drawing = new AbortController();
  signal.addEventListener("abort", () => drawing.abort());

  async function load() {
    drawing.abort();
    drawing = new AbortController();
    const own = drawing.signal;
    body.replaceChildren(el("p", { class: "quiet", role: "status" }, "Looking up …"));
    try {
      // Proved bounds are computed without solving anything.
      const mode = kind.value === "certified" ? "compute" : "cached_only";
      const answer = await request("/v1/legs/query", {
        method: "POST", signal: own, body: JSON.stringify({ ...query, kind: kind.value, mode }),
        headers: { "Content-Type": "application/json", Accept: "text/csv" },
      });
      const times = timesOf(await answer.text(), places.length, kind.value === "certified");
      if (!own.aborted) body.replaceChildren(...drawn({ places, times, isFlown, buttons }, own));
    } catch (error) {
      if (!own.aborted) body.replaceChildren(failure(error));
    }
  }
  kind.addEventListener("change", load);
  load();
}

/** Rows of times from the table of an answer; unknown ones are `null`. */
export function timesOf(text, size, bounds) {
  const times = Array.from({ length: size }, () => Array(size).fill(null));
  const [head, ...lines] = text.trimEnd().split("\n");
  const names = head.trim().split(",");
  const [from, to, time] = ["from", "to", bounds ? "certified_lower_bound_s" : "duration_s"].map((name) => names.indexOf(name));
  for (const line of lines) {
    const cells = line.split(",");
    if (cells[time]) times[cells[from]][cells[to]] = Number(cells[time]);
  }
  return times;
}

function drawn({ places, times, isFlown, buttons }, signal) {
  const said = el("output", { class: "cell" });
  const row = el("div", {});
  let shown = null;
  const details = el("details", {}, el("summary", {}, "Legs of the chosen row as a table"), row);
  const fill = () => {
    if (!details.open || row.dataset.from === String(shown)) return;
    row.dataset.from = String(shown);
    row.replaceChildren(table(`Legs from ${places[shown].name}`, [{ title: "To", head: true }, { title: "Time, s", number: true }],
      places.flatMap(({ name }, to) => (to === shown ? [] : [[name, fixed(times[shown][to])]]))));
  };
  details.addEventListener("toggle", fill);
  const map = heatMap({
    label: `Leg times between ${places.length} places`, times, isFlown,
    chosen: (from, to) => {
      shown = from;
      said.textContent = from === to ? places[from].name
        : `${places[from].name} → ${places[to].name}: ${times[from][to] === null ? "not known" : seconds(times[from][to])}`;
      fill();
    },
  }, signal);
  buttons.replaceChildren(...map.buttons);
  const all = places.length * (places.length - 1);
  const known = times.flat().filter((time) => time !== null).length;
  return [el("p", {}, said), map.node, el("p", { class: "quiet" },
    "From the row to the column, in visiting order; the darker, the longer. Legs of the plan are framed. ",
    known < all ? `${count(all - known, "leg")} of ${all} not known: a table of legs (POST /v1/leg-tables) computes them.` : ""), details];
}
