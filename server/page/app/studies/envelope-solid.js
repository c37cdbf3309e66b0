// An envelope of wheels in three dimensions, with the ways of slews in it.

import { el, watchSize } from "../dom.js";
import { paintAgain } from "../picture/painters.js";
import { colour, curve, letters, onTheme } from "../plots/palette.js";
import { dot, scaled } from "../rotation.js";
import { seen } from "../sphere/projection.js";
import { turning } from "../sphere/turning.js";

/** Longitude and latitude of the viewer, degrees, as in the pictures of the command line. */
const HOME = [299, 23.5];
/** Share of the picture that the envelope takes, from its centre. */
const FILLED = 0.42;
const BEYOND = 1.1;
const AXES = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];

/** The share of an envelope that a vector uses: 1 on its surface. */
export const shareOf = (envelope, vector) =>
  envelope.facets.reduce((most, { normal, distance }) => Math.max(most, dot(normal, vector) / distance), 0);

/** A picture of {name, full, inner, ways}, a way is {points, isJoined, colour}; canvas and buttons. */
export function envelopeSolid({ name, full, inner, ways }, signal) {
  const canvas = el("canvas", {
    class: "solid", tabindex: "0", role: "application",
    "aria-label": `${name} in three dimensions. Arrow keys turn it, plus and minus zoom, 0 resets.`,
  });
  let size = 0;
  const show = (ctx) => paint(ctx, size, turned.pose, { full, inner, ways });
  const draw = () => {
    if (!size || signal.aborted) return;
    const pixels = Math.round(size * devicePixelRatio);
    if (canvas.width !== pixels) canvas.width = canvas.height = pixels;
    const ctx = canvas.getContext("2d");
    ctx.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    show(ctx);
    canvas.dataset.pose = turned.pose.told();
  };
  const turned = turning(canvas, { draw, home: () => HOME, width: () => size });
  paintAgain(canvas, show);
  onTheme(turned.renew, signal);
  watchSize(canvas, signal, (width) => {
    size = width;
    turned.renew();
  });
  turned.reset();
  return { node: canvas, buttons: turned.buttons };
}

function paint(ctx, size, pose, { full, inner, ways }) {
  const { view } = pose;
  const scale = (pose.zoom * FILLED * size) / full.greatest_radius;
  const at = (vector) => {
    const [x, y] = seen(view, vector);
    return [size / 2 + scale * x, size / 2 - scale * y];
  };
  const outline = (points, isClosed) => {
    ctx.beginPath();
    points.forEach((point, index) => (index ? ctx.lineTo(...point) : ctx.moveTo(...point)));
    if (isClosed) ctx.closePath();
    ctx.stroke();
  };
  const pen = (ink, width, { dash = [], alpha = 1 } = {}) => {
    [ctx.strokeStyle, ctx.lineWidth, ctx.globalAlpha] = [ink, width, alpha];
    ctx.setLineDash(dash);
  };
  const sides = (envelope, isFront) => {
    for (const { normal, vertices } of envelope.facets) {
      if ((dot(view.ahead, normal) > 0) === isFront) outline(vertices.map((index) => at(envelope.vertices[index])), true);
    }
  };
  ctx.clearRect(0, 0, size, size);
  ctx.lineJoin = "round";
  pen(colour("mark"), 1, { dash: [3, 3] });
  sides(full, false);
  pen(colour("mark"), 1);
  for (const [, axis] of AXES) outline([at([0, 0, 0]), at(scaled(axis, 1 / shareOf(full, axis)))], false);
  pen(colour("bound"), 1, { dash: [3, 3], alpha: 0.5 });
  sides(inner, false);
  pen(colour("bound"), 1.25, { alpha: 0.85 });
  sides(inner, true);
  for (const { points, isJoined, colour: number } of ways) {
    const ink = curve(number - 1);
    pen(ink, isJoined ? 2 : 1, isJoined ? {} : { dash: [3, 3], alpha: 0.6 });
    outline(points.map(at), false);
    if (isJoined) continue;
    ctx.globalAlpha = 1;
    ctx.fillStyle = ink;
    for (const point of points) {
      ctx.beginPath();
      ctx.arc(...at(point), 3, 0, 2 * Math.PI);
      ctx.fill();
    }
  }
  pen(colour("muted"), 1.25);
  sides(full, true);
  ctx.setLineDash([]);
  ctx.font = `${12 * letters()}px system-ui, sans-serif`;
  [ctx.textAlign, ctx.textBaseline, ctx.fillStyle] = ["center", "middle", colour("muted")];
  for (const [name, axis] of AXES) ctx.fillText(name, ...at(scaled(axis, BEYOND / shareOf(full, axis))));
}
