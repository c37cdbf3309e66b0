// Body rates, wheel speeds and wheel torques over time, each with its limits, and the phases of the
// flight below them. All show the same moment.

import { disclosure, el, section, table } from "../dom.js";
import { fixed } from "../format.js";
import { indexAt } from "../flight.js";
import { lanes } from "./lanes.js";
import { decorate, reach } from "./limits.js";
import { curve } from "./palette.js";
import { plot } from "./plot.js";

const HEIGHT = 168;
const SLIDER_STEPS = 2000;
const ZOOM_STEP = 2;
/** More rows than this are for a program: the CSV has them. */
const MOST_ROWS = 3000;

/** The section with the timelines of a flight. */
export function timelines(flight, cursor, signal) {
  const charts = groups(flight).map((group) => chart(flight, group));
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
  const lane = lanes(flight, look);

  slider.addEventListener("input", () => cursor.set(Number(slider.value)));
  cursor.listen((time) => {
    const phase = flight.phases.findLast((phase) => phase.begin <= time + 1e-9);
    const text = `${fixed(time, 1)} s · ${phase?.name ?? ""}`;
    slider.value = String(time);
    slider.setAttribute("aria-valuetext", text);
    moment.textContent = text;
    lane.show(time);
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
    lane.node,
    slider,
    el("p", { class: "quiet" }, "Drag across a plot to look closer, double-click to see all; the buttons look at the moment shown."),
    lane.data,
    disclosure("Samples as a table", () => samples(flight)),
  );
}

function groups({ rates, speeds, torques, limits }) {
  const wheels = speeds.map((_, wheel) => `wheel ${wheel}`);
  return [
    { title: "Body rates", unit: "rad/s", names: ["x", "y", "z"], curves: rates, limits: limits.rates, digits: 4 },
    { title: "Wheel speeds", unit: "rad/s", names: wheels, curves: speeds, limits: limits.speeds, digits: 1 },
    { title: "Wheel torques", unit: "N m", names: wheels, curves: torques, limits: limits.torques, digits: 4, steps: true },
  ];
}

function chart(flight, group) {
  const values = group.names.map(() => el("span", { class: "value" }));
  const key = el("ul", { class: "key" }, group.names.map((name, index) =>
    el("li", {}, el("span", { class: `swatch curve-${(index % 6) + 1}`, "aria-hidden": "true" }), name, " ", values[index])));
  const limited = group.limits.some(Boolean);
  const place = el("div", {
    class: "plot", role: "img",
    "aria-label": `${group.title} over time${limited ? ", with limit lines" : ""}. The samples are in the table below.`,
  });
  const one = {
    node: el("div", { class: "chart" },
      el("div", { class: "chart-head" }, el("h3", {}, group.title, " ", el("span", { class: "unit" }, group.unit)), key), place),
    plot: null,
    build(cursor, charts, lane, signal) {
      one.plot = plot(place, options(flight, group, cursor, one, charts, lane), [flight.times, ...group.curves], signal);
    },
    show(time) {
      const index = indexAt(flight.times, time);
      group.curves.forEach((samples, which) => {
        values[which].textContent = fixed(group.steps ? samples[index] : between(flight.times, samples, index, time), group.digits);
      });
      if (!one.plot || one.hovered) return;
      one.plot.setCursor({ left: one.plot.valToPos(time, "x"), top: 0 }, false, false);
    },
  };
  return one;
}

function between(times, samples, index, time) {
  const next = Math.min(index + 1, times.length - 1);
  const span = times[next] - times[index];
  return span > 0 ? samples[index] + ((samples[next] - samples[index]) * (time - times[index])) / span : samples[index];
}

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
        lane.zoom(min, max);
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
      }],
    },
  };
}

function ticksOf(_, ticks) {
  const digits = Math.max(0, ...ticks.map((tick) => (String(Number(tick.toPrecision(6))).split(".")[1] ?? "").length));
  return ticks.map((tick) => fixed(tick, digits));
}

function samples(flight) {
  const wheels = flight.speeds.map((_, wheel) => wheel);
  const columns = [
    { title: "Time, s", number: true },
    ...["x", "y", "z"].map((axis) => ({ title: `Rate ${axis}, rad/s`, number: true })),
    ...wheels.map((wheel) => ({ title: `Speed ${wheel}, rad/s`, number: true })),
    ...wheels.map((wheel) => ({ title: `Torque ${wheel}, N m`, number: true })),
  ];
  const shown = flight.times.slice(0, MOST_ROWS);
  const rows = shown.map((time, index) => [
    fixed(time, 3),
    ...flight.rates.map((samples) => fixed(samples[index], 6)),
    ...flight.speeds.map((samples) => fixed(samples[index], 2)),
    ...flight.torques.map((samples) => fixed(samples[index], 6)),
  ]);
  const more = flight.times.length - shown.length;
  return el("div", {}, table("Samples of the trajectory", columns, rows),
    more > 0 ? el("p", { class: "quiet" }, `${more} more rows are in the CSV.`) : null);
}
