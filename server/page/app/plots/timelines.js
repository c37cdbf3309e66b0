// Body rates, wheel speeds and wheel torques over time, each with its limits, what else there is, and
// the phases of the flight below them. All show the same moment.

import { disclosure, el, section } from "../dom.js";
import { settings } from "../settings.js";
import { pictureButtons } from "../picture/save.js";
import { clockOf, momentText, shownClock, unitChoices } from "../units.js";
import { chart } from "./chart.js";
import { groupsOf, samples } from "./groups.js";
import { lanes } from "./lanes.js";

/** A slider stops at whole steps, of which rounding may make the last too long: these are shorter. */
const SLIDER_STEPS = 2000 * (1 + 1e-9);
const ZOOM_STEP = 2;

/**
 * The section with the timelines of a flight. More groups of curves stand below its own, as `groupsOf`
 * makes them, with `data` for a table.
 */
export function timelines(flight, cursor, signal, more = []) {
  const clock = clockOf(flight.scenario);
  const moment = el("output", { class: "moment", for: "moment" });
  const slider = el("input", {
    type: "range", id: "moment", "aria-label": "Moment", min: "0", max: String(flight.total),
    step: String(flight.total / SLIDER_STEPS), value: "0",
  });
  const [place, data] = [el("div", {}), el("div", {})];
  let charts = [];
  let drawing = new AbortController();
  signal.addEventListener("abort", () => drawing.abort());
  // The other plots follow the first.
  const look = (begin, end) =>
    charts[0].plot.setScale("x", { min: Math.max(0, begin), max: Math.min(flight.total, end) });
  const zoom = (factor) => {
    const { min, max } = charts[0].plot.scales.x;
    const half = (factor * (max - min)) / 2;
    const middle = Math.max(half, Math.min(flight.total - half, cursor.time));
    look(middle - half, middle + half);
  };
  const button = (text, label, act) => el("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
  const tools = el("div", { class: "tools" }, moment,
    button("−", "Show a longer time", () => zoom(ZOOM_STEP)), button("+", "Show a shorter time", () => zoom(1 / ZOOM_STEP)),
    button("All", "All of the flight", () => look(0, flight.total)),
    pictureButtons("timelines", () => flight.scenario.name));
  const lane = flight.phases.length ? lanes(flight, look) : null;

  const show = (time) => {
    const phase = flight.phases.findLast((phase) => phase.begin <= time + 1e-9);
    const text = [momentText(time, clock), phase?.name].filter(Boolean).join(" · ");
    slider.value = String(time);
    slider.setAttribute("aria-valuetext", text);
    moment.textContent = text;
    lane?.show(time);
    for (const one of charts) one.show(time);
  };
  /** Makes plots and tables in the units of the reader; what was looked at closely still is. */
  const make = () => {
    const before = charts[0]?.plot?.scales.x;
    const seen = before ? { min: before.min, max: before.max } : null;
    drawing.abort();
    drawing = new AbortController();
    const own = drawing.signal;
    const groups = groupsOf(flight);
    charts = [...groups, ...more].map((group) => chart(flight, group));
    place.replaceChildren(...charts.map((one) => one.node));
    data.replaceChildren(disclosure("Samples as a table", () => samples(flight, groups, shownClock(clock))));
    // The plots need a width, which there is when they are on the page.
    requestAnimationFrame(() => {
      if (own.aborted) return;
      const shared = { cursor, charts, lane, clock: shownClock(clock) };
      for (const one of charts) one.build(shared, own);
      if (seen) look(seen.min, seen.max);
      if (cursor.time === null) cursor.set(0);
      else show(cursor.time);
    });
  };
  slider.addEventListener("input", () => cursor.set(Number(slider.value)));
  cursor.listen(show, signal);
  settings.listen(make, signal);
  make();
  return section(
    "Timelines",
    { class: "timelines", head: tools },
    unitChoices(clock, signal),
    place,
    lane?.node,
    slider,
    el("p", { class: "quiet not-drawn" }, "Drag across a plot to look closer, double-click to see all; the buttons look at the moment shown."),
    lane?.data,
    data,
    more.map((group) => disclosure(`${group.title} as a table`, group.data)),
  );
}
