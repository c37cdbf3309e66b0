// Times from rest to rest between all places of a scenario, as far as they are known.

import { post } from "../api.js";
import { el, scroller, section } from "../dom.js";
import { failure } from "../failure.js";
import { count, fixed } from "../format.js";
import { pictureButtons } from "../picture/save.js";
import { largeMatrix } from "./large-matrix.js";

/** So many places have all of their legs solved in one query, and room in a table. */
const MOST_PLACES = 32;
/** More columns have no room for decimals. */
const FEW = 8;

/** The section with the matrix. */
export function matrix(plan, scenario, signal) {
  const places = placesOf(plan, scenario);
  const body = el("div", {}, el("p", { class: "quiet" }, "Looking up …"));
  const compute = el("button", { type: "button", class: "small", hidden: true, onclick: () => load("compute") }, "Compute missing");
  const tools = el("div", { class: "tools" }, compute, pictureButtons("leg times", () => scenario.name));
  const node = section("Leg times, rest to rest", { head: tools, class: "wide" }, body);
  // The limit of time is one of the search; queries have their own.
  const { spacecraft, start, options: { time_limit_s: _, ...options } = {} } = scenario;
  const query = { spacecraft, start, options, attitudes: places.map((place) => place.attitude), kind: "rest_to_rest" };

  if (places.length > MOST_PLACES) {
    largeMatrix({ places, query, isFlown: flownIn(places), body, tools }, signal);
    return node;
  }
  async function load(mode) {
    compute.disabled = true;
    try {
      const answer = await post("/v1/legs/query", { ...query, mode }, signal);
      const missing = answer.legs.filter((leg) => leg.duration_s === null).length;
      compute.hidden = missing === 0 || mode === "compute";
      body.replaceChildren(grid(places, answer.legs), el("p", { class: "quiet" },
        "From the row to the column, in seconds. Legs of the plan are framed; those flown with free rates can be shorter. ",
        missing ? `${count(missing, "leg")} not known.` : ""));
    } catch (error) {
      if (!signal.aborted) body.replaceChildren(failure(error));
    }
    compute.disabled = false;
  }
  load("cached_only");
  return node;
}

/** Start, targets in visiting order, and the end where it is somewhere else. */
function placesOf(plan, scenario) {
  const targets = new Map(scenario.targets.map((target) => [target.id, target]));
  const places = [{ name: "start", attitude: scenario.start.attitude },
    ...plan.sequence.map((id) => ({ name: id, attitude: asked(targets.get(id)) }))];
  const { end } = scenario;
  if (!end) return places;
  if (JSON.stringify(end.attitude) === JSON.stringify(scenario.start.attitude)) places[0].name = "start, end";
  else places.push({ name: "end", attitude: asked(end) });
  return places;
}

/** What a query has for a target or the end: its attitude, or where it points a boresight. */
const asked = ({ attitude, pointing }) => (pointing ? { pointing } : attitude);

/** Whether a plan flies a leg between two of its places, which stand in its order. */
const flownIn = (places) => (from, to) => to === (from + 1) % places.length && (to !== 0 || places[0].name !== "start");

function grid(places, legs) {
  const size = places.length;
  const times = Array.from({ length: size }, () => Array(size).fill(null));
  for (const leg of legs) times[leg.from][leg.to] = leg.duration_s;
  const known = times.flat().filter((time) => time !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const digits = size <= FEW ? 2 : 1;
  const isFlown = flownIn(places);
  const cell = (time, from, to) => {
    if (from === to) return el("td", { class: "self" });
    const node = el("td", { class: `number ${time === null ? "missing" : ""} ${isFlown(from, to) ? "flown" : ""}` }, fixed(time, digits));
    if (time !== null) node.style.setProperty("--heat", String(high > low ? (time - low) / (high - low) : 0));
    return node;
  };
  return scroller("Matrix of leg times",
    el("table", { class: "matrix" },
      el("caption", { class: "unseen" }, "Leg times from rest to rest, s; rows are where a leg begins"),
      el("thead", {}, el("tr", {}, el("td", {}), places.map(({ name }) => el("th", { scope: "col" }, name)))),
      el("tbody", {}, times.map((row, from) => el("tr", {}, el("th", { scope: "row" }, places[from].name),
        row.map((time, to) => cell(time, from, to)))))));
}
