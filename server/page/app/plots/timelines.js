// Body rates, wheel speeds and wheel torques over time, each with its limits, what else there is, and
// the phases of the flight below them. All show the same moment.

import { disclosure, el, section, table } from "../dom.js";
import { fixed, significant } from "../format.js";
import { valueAt } from "../flight.js";
import { lanes } from "./lanes.js";
import { beyond, decorate, reach } from "./limits.js";
import { curve } from "./palette.js";
import { plot } from "./plot.js";

const HEIGHT = 168;
/** A slider stops at whole steps, of which rounding may make the last too long: these are shorter. */
const SLIDER_STEPS = 2000 * (1 + 1e-9);
const ZOOM_STEP = 2;
/** More rows than this are for a program: the CSV has them. */
const MOST_ROWS = 3000;
/** A finger that moves farther than this scrolls, px. */
const MOST_OF_A_TAP = 12;

/**
 * The section with the timelines of a flight. More groups of curves stand below its own: {title, unit,
 * names, times, curves, limits, text, steps, data}, of which `text` writes a value and `data` makes a
 * table.
 */
export function timelines(flight, cursor, signal, more = []) {
  const own = groups(flight);
  const charts = [...own, ...more].map((group) => chart(flight, group));
  const moment = el("output", { class: "moment", for: "moment" });
  const slider = el("input", {
    type: "range", id: "moment", "aria-label": "Moment", min: "0", max: String(flight.total),
    step: String(flight.total / SLIDER_STEPS), value: "0",
  });
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
    button("All", "All of the flight", () => look(0, flight.total)));
  const lane = flight.phases.length ? lanes(flight, look) : null;

  slider.addEventListener("input", () => cursor.set(Number(slider.value)));
  cursor.listen((time) => {
    const phase = flight.phases.findLast((phase) => phase.begin <= time + 1e-9);
    const text = [`${fixed(time, 1)} s`, phase?.name].filter(Boolean).join(" · ");
    slider.value = String(time);
    slider.setAttribute("aria-valuetext", text);
    moment.textContent = text;
    lane?.show(time);
    for (const one of charts) one.show(time);
  });
  const build = () => {
    for (const one of charts) one.build(cursor, charts, lane, signal);
    cursor.set(0);
  };
  // The plots need a width, which there is when they are on the page.
  requestAnimationFrame(build);
  return section(
    "Timelines",
    { class: "timelines", head: tools },
    charts.map((one) => one.node),
    lane?.node,
    slider,
    el("p", { class: "quiet" }, "Drag across a plot to look closer, double-click to see all; the buttons look at the moment shown."),
    lane?.data,
    disclosure("Samples as a table", () => samples(flight, own)),
    more.map((group) => disclosure(`${group.title} as a table`, group.data)),
  );
}

/** The units of the plots of the command line, by what the documents have. */
const DEGREES = 180 / Math.PI;
const MILLI = 1000;

const inUnit = (lists, factor) => lists.map((values) => values && values.map((value) => factor * value));

/** The curves that every flight has; `column` and `digits` are those of the table of samples. */
function groups({ times, rates, speeds, torques, limits, clearances }) {
  const wheels = speeds.map((_, wheel) => `wheel ${wheel}`);
  const numbers = speeds.map((_, wheel) => String(wheel));
  const group = (more, shown) => ({ times, text: (value) => fixed(value, shown), ...more });
  return [
    group({ title: "Body rates", unit: "deg/s", names: ["x", "y", "z"], curves: inUnit(rates, DEGREES),
      limits: inUnit(limits.rates, DEGREES), column: ["Rate", ["x", "y", "z"]], digits: 4 }, 3),
    group({ title: "Wheel speeds", unit: "rad/s", names: wheels, curves: speeds, limits: limits.speeds,
      column: ["Speed", numbers], digits: 2 }, 1),
    group({ title: "Wheel torques", unit: "mN m", names: wheels, ...torques, curves: inUnit(torques.curves, MILLI),
      limits: inUnit(limits.torques, MILLI), column: ["Torque", numbers], digits: 3 }, 2),
    ...(clearances.length ? [group({ title: "Clearance of cones", unit: "deg", names: clearances.map(({ name }) => name),
      curves: clearances.map(({ values }) => values), limits: clearances.map(() => null),
      column: ["Clearance", clearances.map(({ name }) => name)], digits: 2 }, 1)] : []),
  ];
}

function chart(flight, group) {
  const values = group.names.map(() => el("span", { class: "value" }));
  const key = el("ul", { class: "key" }, group.names.map((name, index) =>
    el("li", {}, el("span", { class: `swatch curve-${(index % 6) + 1}`, "aria-hidden": "true" }), name, " ", values[index])));
  const far = beyond(group);
  const limited = group.limits.some(Boolean);
  const unit = far === null ? group.unit : `${group.unit}, limit ${significant(far)}`;
  const place = el("div", {
    class: "plot", role: "img",
    "aria-label": `${group.title} over time${limited ? ", with limit lines" : ""}. The samples are in the table below.`,
  });
  const one = {
    node: el("div", { class: "chart" },
      el("div", { class: "chart-head" }, el("h3", {}, group.title, " ", el("span", { class: "unit" }, unit)), key), place),
    plot: null,
    build(cursor, charts, lane, signal) {
      one.plot = plot(place, options(flight, group, cursor, one, charts, lane), [group.times, ...group.curves], signal);
    },
    show(time) {
      group.names.forEach((_, which) => (values[which].textContent = group.text(valueOf(group, which, time))));
      if (!one.plot || one.hovered) return;
      one.plot.setCursor({ left: one.plot.valToPos(time, "x"), top: 0 }, false, false);
    },
  };
  return one;
}

const valueOf = ({ times, curves, steps }, which, time) => valueAt({ times, samples: curves[which], steps }, time);

function options(flight, group, cursor, one, charts, lane) {
  const range = reach(group);
  const series = group.names.map((name, index) => ({
    label: name,
    width: 1.5,
    stroke: () => curve(index),
    points: { show: false },
    paths: group.steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
  }));
  return {
    height: HEIGHT,
    scales: { x: { time: false }, y: { range: () => range } },
    series: [{}, ...series],
    axes: [{ values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { values: ticksOf }],
    hooks: {
      ...decorate(flight, group),
      setCursor: [(drawn) => {
        if (!one.hovered || drawn.cursor.left < 0) return;
        cursor.set(Math.max(0, Math.min(flight.total, drawn.posToVal(drawn.cursor.left, "x"))));
      }],
      setScale: [(drawn, scale) => {
        if (scale !== "x") return;
        const { min, max } = drawn.scales.x;
        lane?.zoom(min, max);
        // The moment is somewhere else in the plot once this is drawn.
        requestAnimationFrame(() => one.show(cursor.time ?? 0));
        for (const { plot } of charts) {
          if (plot && (plot.scales.x.min !== min || plot.scales.x.max !== max)) plot.setScale("x", { min, max });
        }
      }],
      ready: [(drawn) => {
        drawn.over.addEventListener("pointerenter", () => (one.hovered = true));
        drawn.over.addEventListener("pointerleave", () => {
          one.hovered = false;
          one.show(cursor.time ?? 0);
        });
        listenToTaps(drawn.over, (x) => cursor.set(Math.max(0, Math.min(flight.total, drawn.posToVal(x, "x")))));
      }],
    },
  };
}

/** Calls back with the place of every tap: a finger does not hover, and what moves is a scroll. */
function listenToTaps(place, tapped) {
  let begun = null;
  place.addEventListener("pointerdown", (event) => (begun = event.pointerType === "mouse" ? null : event));
  place.addEventListener("pointerup", (event) => {
    const moved = begun ? Math.hypot(event.clientX - begun.clientX, event.clientY - begun.clientY) : Infinity;
    begun = null;
    if (moved < MOST_OF_A_TAP) tapped(event.clientX - place.getBoundingClientRect().left);
  });
}

function ticksOf(_, ticks) {
  const digits = Math.max(0, ...ticks.map((tick) => (String(Number(tick.toPrecision(6))).split(".")[1] ?? "").length));
  return ticks.map((tick) => fixed(tick, digits));
}

function samples(flight, own) {
  const columns = own.flatMap(({ unit, column: [what, names] }) =>
    names.map((name) => ({ title: `${what} ${name}, ${unit}`, number: true })));
  const shown = flight.times.slice(0, MOST_ROWS);
  const rows = shown.map((time) => [fixed(time, 3), ...own.flatMap((group) =>
    group.curves.map((_, which) => fixed(valueOf(group, which, time), group.digits)))]);
  const more = flight.times.length - shown.length;
  return el("div", {}, table("Samples of the trajectory", [{ title: "Time, s", number: true }, ...columns], rows),
    more > 0 ? el("p", { class: "quiet" }, `${more} more rows are in the CSV.`) : null);
}
