// Draws a spacecraft on a canvas, far things first. Vectors are right, up and towards the viewer.

import { scaled, sum } from "../rotation.js";
import { colour, curve, letters } from "../plots/palette.js";
import { across } from "./solid.js";

/** Distances in half diagonals of the box: ends of axes and boresights, of cones, and of directions. */
const AXIS = 1.2;
const BORESIGHT = 1.4;
const CONE = 1.2;
const FRAME = 1.5;
const SUN = 1.55;
/** What has to be in the picture. */
const REACH = 1.75;

const WHEEL = 0.2;
const STEPS = 40;
const NAMES = ["x", "y", "z"];

/**
 * Draws {parts, seenBody, seenFrame, speeds, rate, coneViolated, violated, violatedBy} around the middle
 * of a picture of width and height, px, `zoom` times as large as it fits. `seenBody` and `seenFrame` turn
 * vectors of body and reference frame to the viewer.
 */
export function paint(ctx, [width, height], zoom, scene) {
  const pen = new Pen(ctx, [width, height], zoom);
  ctx.clearRect(0, 0, width, height);
  const { parts, seenBody, seenFrame } = scene;
  const sides = parts.sides.map(({ normal, corners }) => ({ front: seenBody(normal)[2] > 0, corners: corners.map(seenBody) }));
  const rays = [...frame(seenFrame), ...axes(seenBody), ...boresights(scene), ...directions(scene), ...rate(scene)];
  const behind = rays.filter(({ to }) => to[2] < 0);
  const before = rays.filter(({ to }) => to[2] >= 0);
  const cones = conesOf(scene);
  for (const ray of behind) drawRay(pen, ray);
  for (const cone of cones.filter(({ axis }) => axis[2] < 0)) drawCone(pen, cone);
  for (const side of sides.filter(({ front }) => !front)) pen.area(side.corners, null, colour("mark"), 1);
  for (const wheel of wheels(scene)) drawWheel(pen, wheel);
  ctx.globalAlpha = 0.3;
  for (const side of sides.filter(({ front }) => front)) pen.area(side.corners, colour("mark"), null, 0);
  ctx.globalAlpha = 1;
  for (const side of sides.filter(({ front }) => front)) pen.area(side.corners, null, colour("muted"), 1.25);
  for (const cone of cones.filter(({ axis }) => axis[2] >= 0)) drawCone(pen, cone);
  for (const ray of before) drawRay(pen, ray);
  drawLabels(pen, rays);
}

class Pen {
  constructor(ctx, [width, height], zoom) {
    this.ctx = ctx;
    this.middle = [width / 2, height / 2];
    this.scale = (zoom * Math.min(width, height)) / 2 / REACH;
    this.larger = letters();
    ctx.lineJoin = "round";
    ctx.lineCap = "round";
  }

  at([x, y]) {
    return [this.middle[0] + this.scale * x, this.middle[1] - this.scale * y];
  }

  line(points, stroke, width, dash = []) {
    const { ctx } = this;
    ctx.beginPath();
    points.forEach((point, index) => (index ? ctx.lineTo(...this.at(point)) : ctx.moveTo(...this.at(point))));
    ctx.setLineDash(dash);
    ctx.lineWidth = width;
    ctx.strokeStyle = stroke;
    ctx.stroke();
    ctx.setLineDash([]);
  }

  area(points, fill, stroke, width) {
    const { ctx } = this;
    ctx.beginPath();
    points.forEach((point, index) => (index ? ctx.lineTo(...this.at(point)) : ctx.moveTo(...this.at(point))));
    ctx.closePath();
    if (fill) {
      ctx.fillStyle = fill;
      ctx.fill();
    }
    if (!stroke) return;
    ctx.lineWidth = width;
    ctx.strokeStyle = stroke;
    ctx.stroke();
  }

  dot(point, radius, fill) {
    const { ctx } = this;
    ctx.beginPath();
    ctx.arc(...this.at(point), radius * this.larger, 0, 2 * Math.PI);
    ctx.fillStyle = fill;
    ctx.fill();
  }
}

const ray = (kind, name, from, to, ink, width, more = {}) => ({ kind, name, from, to, ink, width, ...more });

function frame(seenFrame) {
  return NAMES.map((name, index) => {
    const to = seenFrame(unitOf(index));
    return ray("frame", name.toUpperCase(), scaled(to, -FRAME), scaled(to, FRAME), colour("mark"), 1);
  });
}

function axes(seenBody) {
  return NAMES.map((name, index) => {
    const to = seenBody(unitOf(index));
    return ray("axis", name, [0, 0, 0], scaled(to, AXIS), curve(index), 1.5);
  });
}

function boresights({ parts, seenBody, violated }) {
  return parts.boresights.map(({ name, direction, from }, index) => {
    const to = seenBody(direction);
    const ink = violated[index] ? colour("limit") : colour("text");
    return ray("boresight", name, scaled(to, from), scaled(to, BORESIGHT), ink, 2.25, { head: true });
  });
}

function directions({ parts, seenFrame, violatedBy }) {
  return parts.directions.map(({ name, sun, direction }, index) => {
    const to = seenFrame(direction);
    const ink = violatedBy[index] ? colour("limit") : colour(sun ? "waits" : "muted");
    return ray("direction", name, scaled(to, 1.05), scaled(to, SUN), ink, 1, { dash: [3, 4], sun, mark: true });
  });
}

/** The body rate, as long as an axis at the largest rate of the flight. */
function rate({ seenBody, rate: turning }) {
  const length = Math.hypot(...turning);
  if (length < 0.02) return [];
  return [ray("rate", "rate", [0, 0, 0], scaled(seenBody(turning), AXIS), colour("bound"), 2.25, { head: true })];
}

const unitOf = (index) => [0, 1, 2].map((other) => (other === index ? 1 : 0));

function drawRay(pen, { from, to, ink, width, dash, head, mark, sun }) {
  pen.ctx.globalAlpha = to[2] < 0 ? 0.55 : 1;
  pen.line([from, to], ink, width, dash);
  if (head) drawHead(pen, from, to, ink);
  if (mark) pen.dot(to, sun ? 6 : 3.5, ink);
  pen.ctx.globalAlpha = 1;
}

function drawHead(pen, from, to, ink) {
  const [a, b] = [pen.at(from), pen.at(to)];
  const [x, y] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(x, y);
  if (length < 4) return pen.dot(to, 3, ink);
  const [u, v] = [x / length, y / length];
  const size = 7 * pen.larger;
  const { ctx } = pen;
  ctx.beginPath();
  ctx.moveTo(b[0], b[1]);
  ctx.lineTo(b[0] - size * u + 0.45 * size * v, b[1] - size * v - 0.45 * size * u);
  ctx.lineTo(b[0] - size * u - 0.45 * size * v, b[1] - size * v + 0.45 * size * u);
  ctx.closePath();
  ctx.fillStyle = ink;
  return ctx.fill();
}

/** Points on a circle around a direction. */
function circle(centre, direction, radius, from = 0, turn = 2 * Math.PI) {
  const [a, b] = across(direction);
  return Array.from({ length: STEPS + 1 }, (_, step) => {
    const angle = from + (turn * step) / STEPS;
    return sum(centre, sum(scaled(a, radius * Math.cos(angle)), scaled(b, radius * Math.sin(angle))));
  });
}

function wheels({ parts, seenBody, speeds }) {
  return parts.wheels.map((wheel, index) => {
    const [centre, direction] = [seenBody(wheel.centre), seenBody(wheel.direction)];
    return { ...wheel, index, centre, direction, share: Math.max(-1, Math.min(1, speeds[index] / wheel.full)) };
  }).sort((one, other) => one.centre[2] - other.centre[2]);
}

/** A disc with its axis; around it an arc as long as the share of the full speed, in the sense of the spin. */
function drawWheel(pen, { index, centre, direction, enabled, share }) {
  const ink = enabled ? curve(index) : colour("muted");
  const end = (sign) => sum(centre, scaled(direction, sign * 0.26));
  pen.line([end(-1), end(1)], ink, 1.25, enabled ? [] : [2, 3]);
  pen.ctx.globalAlpha = 0.9;
  pen.area(circle(centre, direction, WHEEL), colour("surface"), colour("mark"), 1);
  pen.ctx.globalAlpha = 1;
  pen.line(circle(centre, direction, WHEEL, 0, 2 * Math.PI * share), ink, 3.25);
  const [x, y] = pen.at(centre);
  letter(pen, String(index), x, y, ink, 0.69);
}

function conesOf({ parts, seenBody, coneViolated }) {
  return parts.boresights.flatMap(({ direction, cones }, which) => cones.map((cone, index) =>
    ({ ...cone, axis: seenBody(direction), violated: coneViolated[which][index] })));
}

function drawCone(pen, { axis, halfAngle, inward, violated }) {
  const ink = violated ? colour("limit") : colour(inward ? "good" : "muted");
  const rim = circle(scaled(axis, CONE * Math.cos(halfAngle)), axis, CONE * Math.sin(halfAngle));
  pen.ctx.globalAlpha = violated ? 0.3 : 0.09;
  // Of a cone that is wider than a right angle the rim is all that can be shown.
  if (halfAngle < Math.PI / 2) pen.area(hull([[0, 0, 0], ...rim]), ink, null, 0);
  pen.ctx.globalAlpha = 0.7;
  pen.line(rim, ink, 1, inward ? [4, 3] : []);
  pen.ctx.globalAlpha = 1;
}

/** The convex hull of points as they are seen (monotone chain). */
export function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), point) <= 0) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

const turn = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** Names at the ends of rays; one that would hide another is left out, the important ones first. */
function drawLabels(pen, rays) {
  const rank = ["boresight", "direction", "rate", "axis", "frame"];
  const taken = [];
  const size = 12 * pen.larger;
  for (const one of [...rays].sort((a, b) => rank.indexOf(a.kind) - rank.indexOf(b.kind))) {
    const [x, y] = pen.at(scaled(one.to, 1 + (0.09 * pen.larger) / Math.max(0.4, Math.hypot(...one.to))));
    const flat = Math.hypot(one.to[0], one.to[1]);
    const aside = flat > 0.01 ? one.to[0] / flat : 0;
    const width = pen.ctx.measureText(one.name).width;
    const middle = x + aside * (width / 2 + 2);
    const box = [middle - width / 2, y - size / 2, middle + width / 2, y + size / 2];
    if (taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1])) continue;
    taken.push(box);
    pen.ctx.globalAlpha = one.to[2] < 0 ? 0.65 : 1;
    letter(pen, one.name, middle, y, one.kind === "frame" ? colour("muted") : one.ink, 0.75, one.kind === "boresight");
    pen.ctx.globalAlpha = 1;
  }
}

function letter({ ctx, larger }, text, x, y, ink, size, strong = false) {
  ctx.font = `${strong ? 600 : 500} ${16 * size * larger}px system-ui, sans-serif`;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.fillStyle = ink;
  ctx.fillText(text, x, y);
}
