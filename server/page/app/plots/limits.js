// What stands behind the curves of a timeline: limits, arrivals, and times at rest.

import { colour, letters } from "./palette.js";

const ROOM = 0.08;
/** Height of the mark of a violation at the upper edge, px. */
const ALARM = 5;

/** Limits of which the curves use less than this share are outside of a plot. */
const USED = 0.2;
/** What curves far from their limits are drawn on at least, as a share of these: less may be rounding. */
const LEAST = 0.02;

const largest = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
const all = (limits) => limits.flatMap((limit) => limit ?? []);
const isFar = (limit, curves) => largest(curves.flat()) < USED * Math.abs(limit);

/** The farthest limit, where it is so far away that nobody could see the curves beside it. */
export function beyond({ curves, limits }) {
  return largest(all(limits).filter((limit) => isFar(limit, curves))) || null;
}

/**
 * Lowest and highest value of a plot: those of the curves and of the limits near them, and at least
 * some about zero, with some room.
 */
export function reach(group) {
  const { curves, limits, least = 0 } = group;
  const about = Math.max(least, LEAST * (beyond(group) ?? 0));
  const near = all(limits).filter((limit) => !isFar(limit, curves));
  const [low, high] = [...curves.flat(), ...near, -about, about]
    .reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [0, 0]);
  const room = ROOM * (high - low || 1);
  return [low - room, high + room];
}

/** The hooks of uPlot that draw it. */
export function decorate(flight, group) {
  const values = [...new Set(all(group.limits))];
  return {
    drawClear: [(drawn) => within(drawn, () => {
      shade(drawn, flight.phases);
      // The excess of a limit is marked where its curves are, a stay in a cone everywhere.
      alarm(drawn, flight.alarms.filter(({ of }) => !of || of === group.of));
      arrivals(drawn, flight.stops);
    })],
    draw: [(drawn) => within(drawn, () => values.forEach((value) => across(drawn, value)))],
  };
}

/** Draws the line of a limit across a plot. */
export function limitLine(drawn, value) {
  within(drawn, () => across(drawn, value));
}

/** Draws a line at a value of the horizontal axis, with its name at the top. */
export function markLine(drawn, value, name) {
  const { ctx, bbox } = drawn;
  const x = Math.round(drawn.valToPos(value, "x", true)) + 0.5;
  line(drawn, [x, bbox.top], [x, bbox.top + bbox.height], colour("muted"), [2, 3]);
  ctx.setLineDash([]);
  ctx.fillStyle = colour("muted");
  ctx.font = `${12 * letters() * devicePixelRatio}px system-ui, sans-serif`;
  [ctx.textAlign, ctx.textBaseline] = ["left", "top"];
  ctx.fillText(name, x + 4 * devicePixelRatio, bbox.top + 2 * devicePixelRatio);
}

function within(drawn, paint) {
  const { ctx, bbox } = drawn;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  paint();
  ctx.restore();
}

function shade(drawn, phases) {
  const { ctx, bbox } = drawn;
  for (const phase of phases) {
    if (phase.kind === "slew" || phase.kind === "wait") continue;
    ctx.fillStyle = colour(`${phase.kind}-shade`);
    const [begin, end] = [phase.begin, phase.end].map((time) => drawn.valToPos(time, "x", true));
    ctx.fillRect(begin, bbox.top, Math.max(end - begin, 1), bbox.height);
  }
}

/** Marks where a boresight is inside a cone: a moment is to be seen too. */
function alarm(drawn, alarms) {
  const { ctx, bbox } = drawn;
  for (const { begin, end } of alarms) {
    const [from, to] = [begin, end].map((time) => drawn.valToPos(time, "x", true));
    const width = Math.max(to - from, 2 * devicePixelRatio);
    ctx.fillStyle = colour("alarm-shade");
    ctx.fillRect(from, bbox.top, width, bbox.height);
    ctx.fillStyle = colour("limit");
    ctx.fillRect(from, bbox.top, width, ALARM * devicePixelRatio);
  }
}

function arrivals(drawn, stops) {
  for (const stop of stops) {
    const x = Math.round(drawn.valToPos(stop.time, "x", true)) + 0.5;
    line(drawn, [x, drawn.bbox.top], [x, drawn.bbox.top + drawn.bbox.height], colour("mark"), []);
  }
}

function across(drawn, value) {
  const y = Math.round(drawn.valToPos(value, "y", true)) + 0.5;
  const { left, width } = drawn.bbox;
  line(drawn, [left, y], [left + width, y], colour("limit"), [6, 4]);
}

function line({ ctx }, from, to, stroke, dash) {
  const ratio = devicePixelRatio;
  ctx.beginPath();
  ctx.setLineDash(dash.map((part) => part * ratio));
  ctx.lineWidth = ratio;
  ctx.strokeStyle = stroke;
  ctx.moveTo(...from);
  ctx.lineTo(...to);
  ctx.stroke();
}
