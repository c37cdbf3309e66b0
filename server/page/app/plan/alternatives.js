// Other orders that the search flew, each of which can become a plan of its own beside this one.

import { post } from "../api.js";
import { el, section, table } from "../dom.js";
import { failure } from "../failure.js";
import { fixed } from "../format.js";

const COLUMNS = [
  { title: "Order", head: true }, { title: "Total time, s", number: true }, { title: "Longer by, s", number: true }, { title: "Compare" },
];

/** The section with the alternatives of a plan; null without any. */
export function alternatives(job, plan, scenario, signal) {
  const list = plan.alternatives ?? [];
  if (!list.length) return null;
  const said = el("div", { "aria-live": "polite" });
  const rows = list.map(({ sequence, total_time_s: total }, index) => {
    const open = el("button", { type: "button", class: "small", "aria-label": `Plan and compare order ${index + 1}` }, "Plan and compare");
    open.addEventListener("click", async () => {
      open.disabled = true;
      try {
        const answer = await post("/v1/plans", inOrder(scenario, sequence, `alternative ${index + 1}`), signal);
        location.hash = `#/compare/${job.id}/${answer.id}`;
      } catch (error) {
        if (!signal.aborted) said.replaceChildren(failure(error));
        open.disabled = false;
      }
    });
    return [el("span", { class: "sequence" }, sequence.join(" ")), fixed(total), fixed(total - plan.total_time_s), open];
  });
  return section("Other orders", { class: "wide" }, table("Other orders that were flown", COLUMNS, rows), said);
}

/** A scenario whose targets have the places that they have in an order. */
const inOrder = (scenario, sequence, name) => withPlaces(scenario, new Map(sequence.map((id, index) => [id, index + 1])), name);

/** A scenario whose targets have other places, by their names; those without one are free. */
export function withPlaces(scenario, places, name) {
  return {
    ...scenario,
    name: [scenario.name, name].filter(Boolean).join(", "),
    targets: scenario.targets.map(({ position: _, ...target }) => {
      const place = places.get(target.id) ?? null;
      return place === null ? target : { ...target, position: place };
    }),
  };
}
