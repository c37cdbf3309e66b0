// The order of a plan changed by hand: targets are dragged or moved with keys, places are kept or left
// free, and the scenario is planned again with what is kept.

import { post } from "../api.js";
import { el, section } from "../dom.js";
import { failure } from "../failure.js";
import { count, seconds } from "../format.js";
import { withPlaces } from "./alternatives.js";

const HELP = "Drag a target by its handle, or move it with the arrow keys. A place that is kept stays what it is in the "
  + "next plan; the order of all others is searched for.";

/** The section in which the order of a plan is changed; null where nothing can be. */
export function orderEdit(job, plan, scenario, signal) {
  if (plan.passages.length < 2) return null;
  const given = new Map(scenario.targets.map((target) => [target.id, target.position ?? null]));
  const rows = plan.passages.map(({ target, time_s: time }) => rowOf(target, time, given.get(target) !== null));
  const list = el("ol", { class: "order-edit", "aria-label": "Order of the next plan" });
  const said = el("p", { class: "quiet", role: "status" });
  const outcome = el("div", { "aria-live": "polite" });
  const kept = () => rows.filter(({ lock }) => lock.checked).length;
  const tell = (text) => (said.textContent = [text, `${count(kept(), "place")} of ${rows.length} kept.`].filter(Boolean).join(" "));

  const put = () => {
    // Only what is elsewhere is moved: a node that is moved loses the focus.
    rows.forEach(({ node }, index) => list.children[index] !== node && list.insertBefore(node, list.children[index] ?? null));
  };
  const move = (row, to) => {
    const from = rows.indexOf(row);
    const place = Math.max(0, Math.min(rows.length - 1, to));
    if (place === from) return;
    rows.splice(place, 0, ...rows.splice(from, 1));
    // Who moves a target wants it there.
    row.lock.checked = true;
    const isFocused = document.activeElement === row.handle;
    put();
    if (isFocused) row.handle.focus();
    tell(`${row.target} has place ${place + 1}.`);
  };
  for (const row of rows) {
    row.lock.addEventListener("change", () => tell(""));
    row.handle.addEventListener("keydown", (event) => {
      const at = rows.indexOf(row);
      const to = { ArrowUp: at - 1, ArrowDown: at + 1, Home: 0, End: rows.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      move(row, to);
    });
    listenToDrag(row, () => rows, move, signal);
  }
  const all = (isKept) => () => {
    for (const { lock } of rows) lock.checked = isKept;
    tell("");
  };
  const go = el("button", { type: "button", class: "primary", onclick: async () => {
    go.disabled = true;
    try {
      const places = new Map(rows.map((row, index) => [row.target, row.lock.checked ? index + 1 : null]));
      const answer = await post("/v1/plans", withPlaces(scenario, places, "order by hand"), signal);
      location.hash = `#/compare/${job.id}/${answer.id}`;
    } catch (error) {
      if (!signal.aborted) outcome.replaceChildren(failure(error, null, scenario));
      go.disabled = false;
    }
  } }, "Plan again and compare");
  const button = (text, act) => el("button", { type: "button", class: "small", onclick: act }, text);
  put();
  tell("");
  const details = el("details", { class: "order-editing" }, el("summary", {}, "Change the order"),
    el("p", { class: "quiet" }, HELP), list, said,
    el("div", { class: "actions" }, go, button("Keep all places", all(true)), button("Keep none", all(false))), outcome);
  return section("Order", { class: "wide" }, details);
}

function rowOf(target, time, isKept) {
  const id = `keep-${target}`;
  const lock = el("input", { type: "checkbox", id, checked: isKept, "aria-label": `Keep the place of ${target}` });
  const handle = el("button", { type: "button", class: "handle", "aria-label": `Move ${target}`, title: "Drag, or use the arrow keys" }, "⠿");
  const node = el("li", {}, handle, el("span", { class: "stop-name" }, target), el("span", { class: "stop-time" }, seconds(time, 1)),
    el("label", { class: "keep" }, lock, "keep"));
  return { target, lock, handle, node };
}

/** A pointer that goes down on a handle takes its row along, wherever it goes. */
function listenToDrag(row, rowsNow, move, signal) {
  let drag = new AbortController();
  signal.addEventListener("abort", () => drag.abort());
  const end = () => {
    drag.abort();
    row.node.classList.remove("dragged");
  };
  row.handle.addEventListener("pointerdown", (event) => {
    drag.abort();
    drag = new AbortController();
    row.node.classList.add("dragged");
    const mine = (act) => (other) => other.pointerId === event.pointerId && act(other);
    // The row is moved in the document, and what is moved captures no pointer.
    document.addEventListener("pointermove", mine(({ clientX: x, clientY: y }) => {
      const at = rowsNow().findIndex(({ node }) => {
        const box = node.getBoundingClientRect();
        return x >= box.left && x <= box.right && y >= box.top && y < box.bottom;
      });
      if (at >= 0) move(row, at);
    }), { signal: drag.signal });
    for (const kind of ["pointerup", "pointercancel"]) document.addEventListener(kind, mine(end), { signal: drag.signal });
  });
}
