// The legs of a plan beside slews about the eigenaxis.

import { el, section, table } from "../dom.js";
import { pictureButtons } from "../picture/save.js";
import { fixed, percent } from "../format.js";

const COLUMNS = [
  { title: "Leg", head: true },
  { title: "Start, s", number: true },
  { title: "Duration, s", number: true },
  { title: "Wait, s", number: true, rest: "wait" },
  { title: "Settle, s", number: true, rest: "settle" },
  { title: "Dwell, s", number: true, rest: "dwell" },
  { title: "Compared" },
  { title: "Eigenaxis, s", number: true },
  { title: "Saved, s", number: true },
  { title: "Saved", number: true },
  { title: "Rest to rest, s", number: true },
  { title: "Proved bound, s", number: true },
];

/** The section with all legs; waits, settle and dwell have columns where there are any. */
export function legs(plan, flight) {
  const rests = (leg, kind) => flight.phases
    .filter((phase) => phase.kind === kind && phase.label === leg.to)
    .reduce((total, phase) => total + phase.end - phase.begin, 0);
  const has = (kind) => flight.phases.some((phase) => phase.kind === kind);
  const kinds = [...has("wait") ? ["wait"] : [], ...has("settle") || has("dwell") ? ["settle", "dwell"] : []];
  const columns = COLUMNS.filter(({ rest }) => !rest || kinds.includes(rest));
  const longest = Math.max(...plan.legs.flatMap((leg) => [leg.duration_s, leg.eigenaxis_duration_s ?? 0]));
  const rows = plan.legs.map((leg) => {
    const eigenaxis = leg.eigenaxis_duration_s;
    const saved = eigenaxis === null ? null : eigenaxis - leg.duration_s;
    return [
      `${leg.from} → ${leg.to}`,
      fixed(leg.start_s),
      fixed(leg.duration_s),
      ...kinds.map((kind) => fixed(rests(leg, kind) || null)),
      bar(leg.duration_s / longest, (eigenaxis ?? 0) / longest),
      fixed(eigenaxis),
      fixed(saved),
      percent(saved === null ? null : saved / eigenaxis, 1),
      fixed(leg.rest_to_rest_duration_s),
      fixed(leg.certified_lower_bound_s),
    ];
  });
  return section("Legs", { class: "wide", head: el("div", { class: "tools" }, pictureButtons("legs", () => flight.scenario.name)) },
    table("Legs in flying order, with the same slew about its eigenaxis", columns, rows),
    el("p", { class: "quiet" }, "The light bar is the same slew from rest to rest about its eigenaxis. ",
      "Rates left free at the targets count into what is saved."));
}

function bar(share, whole) {
  const node = el("div", { class: "compare", "aria-hidden": "true" }, el("span", { class: "whole" }), el("span", { class: "share" }));
  node.firstChild.style.width = `${100 * whole}%`;
  node.lastChild.style.width = `${100 * share}%`;
  return node;
}
