// One plot of a flight over time: curves with limits, a key with the values at the moment.

import { el } from "../dom.js";
import { fixed, significant } from "../format.js";
import { valueOf } from "./groups.js";
import { beyond, decorate, reach } from "./limits.js";
import { curve } from "./palette.js";
import { plot, POINT } from "./plot.js";

const HEIGHT = 168;
/** A finger that moves farther than this scrolls, px. */
const MOST_OF_A_TAP = 12;
/** Distances of the marks of a clock, s, and the room that each needs, px. */
const CLOCK_STEPS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200, 86_400];
const CLOCK_SPACE = 72;

/**
 * The chart of a group of curves. `built` is given cursor, all charts, which are zoomed together, the
 * lane below them, and the clock of the axis, null for seconds from the start.
 */
export function chart(flight, group) {
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
    build(shared, signal) {
      one.plot = plot(place, options(flight, group, one, shared), [group.times, ...group.curves], signal);
    },
    show(time) {
      group.names.forEach((_, which) => (values[which].textContent = group.text(valueOf(group, which, time))));
      if (!one.plot || one.hovered) return;
      one.plot.setCursor({ left: one.plot.valToPos(time, "x"), top: 0 }, false, false);
    },
  };
  return one;
}

function options(flight, group, one, { cursor, charts, lane, clock }) {
  const range = reach(group);
  const series = group.names.map((name, index) => ({
    label: name,
    width: 1.5,
    stroke: () => curve(index),
    points: { show: false },
    isStepped: group.steps,
    paths: group.steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
  }));
  return {
    height: HEIGHT,
    scales: { x: { time: false }, y: { range: () => range } },
    series: [{}, ...series],
    axes: [clock ? clockAxis(clock) : { values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { values: ticksOf }],
    cursor: { points: { bbox: (drawn, index) => pointAt(drawn, group, index - 1) } },
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

/** The box of the point of a curve at the cursor. The library would put it at the nearest sample. */
function pointAt(drawn, group, which) {
  const { left } = drawn.cursor;
  const value = valueOf(group, which, drawn.posToVal(left, "x"));
  const top = value === null ? -drawn.height : drawn.valToPos(value, "y");
  return { left: left - POINT / 2, top: top - POINT / 2, width: POINT, height: POINT };
}

/** An axis with marks at full times of day. */
export function clockAxis(clock) {
  const splits = (_, __, min, max, step) => {
    const first = Math.ceil((min + clock.offset) / step - 1e-9) * step - clock.offset;
    return Array.from({ length: Math.max(0, Math.floor((max - first) / step + 1e-9) + 1) }, (_, index) => first + index * step);
  };
  const values = (_, ticks, __, ___, step) => ticks.map((tick) => {
    const text = clock.time(tick, step < 1 ? 1 : 0);
    return step >= 60 && text.endsWith(":00") ? text.slice(0, 5) : text;
  });
  return { incrs: CLOCK_STEPS, space: CLOCK_SPACE, splits, values };
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
