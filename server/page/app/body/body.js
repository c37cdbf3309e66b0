// The spacecraft at the moment that is shown, from outside: its box, wheels, boresights with their cones,
// the axes of the reference frame and the Sun. It is turned by dragging and with the arrow keys.

import { el, section, watchSize } from "../dom.js";
import { paintAgain } from "../picture/painters.js";
import { pictureButtons } from "../picture/save.js";
import { letters, onTheme } from "../plots/palette.js";
import { conjugate, dot, rotate } from "../rotation.js";
import { seen } from "../sphere/projection.js";
import { turning } from "../sphere/turning.js";
import { paint } from "./paint.js";
import { isViolated, partsOf } from "./parts.js";
import { readings } from "./readings.js";

/** Longitude and latitude of the viewer, degrees. */
const HOME = [35, 22];
/** From which frame it can be seen, by the name of the choice. */
const FRAMES = [["reference", "reference frame"], ["body", "body"]];

/** The section with the body of a flight; `toggle` plays and pauses. */
export function body(flight, cursor, toggle, signal) {
  const parts = partsOf(flight);
  const fastest = flight.rates[0].reduce((most, _, index) => Math.max(most, Math.hypot(...flight.rates.map((axis) => axis[index]))), 0);
  const canvas = el("canvas", {
    class: "body", tabindex: "0", role: "application",
    "aria-label": "The spacecraft in three dimensions. Arrow keys turn the view, plus and minus zoom, 0 resets, space plays and pauses.",
  });
  const choice = el("select", { id: "body-frame" }, FRAMES.map(([value, text]) => el("option", { value }, text)));
  choice.addEventListener("change", () => turned.renew());

  let [width, height] = [0, 0];
  const draw = () => {
    if (!width || signal.aborted) return;
    const pixels = [width, height].map((length) => Math.round(length * devicePixelRatio));
    if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
    const ctx = canvas.getContext("2d");
    ctx.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    show(ctx);
    canvas.dataset.pose = turned.pose.told();
  };
  const show = (ctx) => {
    ctx.font = `${12 * letters()}px system-ui, sans-serif`;
    paint(ctx, [width, height], turned.pose.zoom, sceneAt(cursor.time ?? 0));
  };
  paintAgain(canvas, show);
  const turned = turning(canvas, { draw, home: () => HOME, width: () => Math.min(width, height), more: { " ": toggle } });
  const { renew } = turned;

  function sceneAt(time) {
    const attitude = flight.attitudeAt(time);
    const { view } = turned.pose;
    const fixed = choice.value === "body";
    const inFrame = parts.boresights.map(({ direction }) => rotate(attitude, direction));
    const coneViolated = parts.boresights.map(({ cones }, which) => cones.map((cone) => isViolated(cone, inFrame[which])));
    const about = (direction) => parts.boresights.some(({ cones }, which) =>
      cones.some((cone, index) => coneViolated[which][index] && dot(cone.direction, direction) > 1 - 1e-9));
    return {
      parts,
      seenBody: (vector) => seen(view, fixed ? vector : rotate(attitude, vector)),
      seenFrame: (vector) => seen(view, fixed ? rotate(conjugate(attitude), vector) : vector),
      speeds: flight.speedsAt(time),
      rate: flight.ratesAt(time).map((value) => (fastest > 0 ? value / fastest : 0)),
      coneViolated,
      violated: coneViolated.map((cones) => cones.includes(true)),
      violatedBy: parts.directions.map(({ direction }) => about(direction)),
    };
  }

  const data = readings(flight, parts, cursor, signal);
  cursor.listen(renew, signal);
  onTheme(renew, signal);
  watchSize(canvas, signal, (...sizes) => {
    [width, height] = sizes;
    renew();
  });
  turned.reset();

  const head = el("div", { class: "tools" }, el("label", { for: "body-frame" }, "Seen from"), choice, turned.buttons,
    pictureButtons("body", () => flight.scenario.name));
  return section("Body", { head, class: "spacecraft" }, canvas, legend(flight, parts), data);
}

function legend(flight, parts) {
  const frame = flight.scenario.reference_frame ?? "the reference frame";
  const cones = parts.boresights.some((one) => one.cones.length);
  return el("p", { class: "quiet" },
    `The box has the proportions of the inertia. Lower-case axes are the body's, upper-case ones those of ${frame}. `,
    "The arc of a wheel is its share of the limit of its speed.",
    cones ? " Cones about boresights are what the directions of the scenario have to stay out of, dashed ones what they have to stay in; red is the wrong side." : "");
}
