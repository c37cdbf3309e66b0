// Draws the sphere: frame, keep-out caps, trace, targets, and the moment that is shown.

import { svg } from "../dom.js";
import { front, rim } from "./cap.js";
import { letters } from "../plots/palette.js";
import { graticule, paths, seen } from "./projection.js";

const MARGIN = 22;
const GRATICULE = graticule(30);
const AXES = [["X", [1, 0, 0]], ["Y", [0, 1, 0]], ["Z", [0, 0, 1]]];
/** More targets than this have smaller marks. */
const MANY = 24;

/** The picture of a size; a pose is {view, zoom}, `content` what `contentOf` makes, with `names` where they are shown. */
export function draw(picture, size, { view, zoom }, content) {
  const centre = size / 2;
  const larger = letters();
  const radius = (centre - MARGIN * larger) * zoom;
  const place = ([x, y]) => `${(centre + radius * x).toFixed(1)} ${(centre - radius * y).toFixed(1)}`;
  const at = (direction) => {
    const [x, y, ahead] = seen(view, direction);
    return { x: centre + radius * x, y: centre - radius * y, hidden: ahead < -1e-9 };
  };
  const { leaders, labels } = named(content, { at, larger, size });
  picture.setAttribute("viewBox", `0 0 ${size} ${size}`);
  picture.replaceChildren(
    svg("circle", { class: "globe", cx: centre, cy: centre, r: radius }),
    ...curves("grid", GRATICULE.map((line) => paths(view, line, place))),
    ...content.caps.flatMap((cap) => drawCap(view, cap, place)),
    ...AXES.map(([name, direction]) => axis(name, at(direction), larger)),
    ...curves("trace", [paths(view, content.trace, place)]),
    ...content.ends.map((end) => ring(end, at(end.direction))),
    ...leaders,
    ...marks(content.stops, { at, view, larger }),
    ...labels,
    dot(content.now, at),
  );
}

/** The names of the targets in front, those that come first in the order nearest to their marks. */
function named({ stops, names }, { at, larger, size }) {
  if (!names) return { leaders: [], labels: [] };
  const radius = radiusOf(stops, larger);
  const places = stops.map(({ name, number, direction }) => ({ name, rank: -number, radius, ...at(direction) }));
  return names.nodes(places.filter(({ hidden }) => !hidden), size);
}

function curves(name, parts) {
  const join = (side) => parts.map((part) => part[side]).join("");
  return [
    svg("path", { class: `${name} back`, d: join("back") }),
    svg("path", { class: `${name} front`, d: join("front") }),
  ];
}

function drawCap(view, cap, place) {
  const outline = front(view, cap.direction, cap.halfAngle);
  const edge = paths(view, rim(cap.direction, cap.halfAngle), place);
  const name = `cap ${cap.applies ? "" : "foreign"}`;
  const area = svg("path", {
    class: `${name} area`, "fill-rule": "evenodd",
    d: outline.length ? `M${outline.map(place).join("L")}Z` : "",
  });
  area.append(svg("title", {}, cap.name));
  return [area, svg("path", { class: `${name} edge back`, d: edge.back }), svg("path", { class: `${name} edge`, d: edge.front })];
}

function axis(name, { x, y, hidden }, larger) {
  return svg("text", { class: `axis ${hidden ? "behind" : ""}`, x, y: y - 9 * larger }, `+${name}`);
}

function ring({ name }, { x, y, hidden }) {
  const node = svg("circle", { class: `end ${hidden ? "behind" : ""}`, cx: x, cy: y, r: 5 });
  node.append(svg("title", {}, name));
  return node;
}

const radiusOf = (stops, larger) => larger * (stops.length > MANY ? 7 : 9.5);

/** Numbered targets, those behind first, so that those in front cover them. */
function marks(stops, { at, view, larger }) {
  const radius = radiusOf(stops, larger);
  return stops
    .map((stop) => ({ stop, ...at(stop.direction) }))
    .sort((a, b) => b.hidden - a.hidden || b.stop.number - a.stop.number)
    .map(({ stop, x, y, hidden }) =>
      svg(
        "g",
        { class: `stop ${stops.length > MANY ? "tiny" : ""} ${hidden ? "behind" : ""} ${stop.reached ? "reached" : ""}`, transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`, "data-time": stop.time },
        svg("title", {}, `${stop.number}: ${stop.name}`),
        tick(view, stop.up, radius),
        svg("circle", { r: radius }),
        svg("text", { dy: "0.35em" }, String(stop.number)),
      ));
}

/** From a mark towards where the body's up points: the roll of a boresight that is pointed. */
function tick(view, up, radius) {
  if (!up) return "";
  const [x, y] = seen(view, up);
  const end = (part) => (2 * radius * part).toFixed(1);
  return svg("line", { class: "tick", x1: 0, y1: 0, x2: end(x), y2: end(-y) });
}

function dot(direction, at) {
  if (!direction) return "";
  const { x, y, hidden } = at(direction);
  return svg("circle", { class: `now ${hidden ? "behind" : ""}`, cx: x, cy: y, r: 6 });
}
