// The sky view: where an axis of the body points during the flight. It is turned by dragging and
// with the arrow keys.

import { disclosure, el, section, svg, table, watchSize } from "../dom.js";
import { fixed } from "../format.js";
import { dot, longitudeLatitude, rotate, sum, unit, upward } from "../rotation.js";
import { pictureButtons } from "../picture/save.js";
import { Names } from "./names.js";
import { draw } from "./scene.js";
import { turning } from "./turning.js";

/** Below this length the mean direction of the targets says little about where they are. */
const CLEAR = 0.3;
const STEP = Math.PI / 90;
/** More targets than these have their names only when somebody wants them. */
const MAX_NAMED = 60;

/** The section with the sphere of a flight; `title` and `id` tell it from others on the page. */
export function sphere(flight, cursor, signal, { title = "Sky", id = "body-axis" } = {}) {
  const axes = bodyAxes(flight.scenario);
  let axis = axes[first(flight, axes)];
  let content = contentOf(flight, axis);
  const picture = svg("svg", {
    class: "sphere", tabindex: "0", role: "application",
    "aria-label": "Sphere with the trace of the body axis. Arrow keys turn it, plus and minus zoom, 0 resets.",
  });
  const choice = el("select", { id }, axes.map(({ name }, index) => el("option", { value: String(index) }, name)));
  choice.value = String(axes.indexOf(axis));
  choice.addEventListener("change", () => {
    axis = axes[choice.value];
    content = contentOf(flight, axis);
    data.replaceWith((data = directions(flight, axis)));
    turned.reset();
  });

  let size = 0;
  const names = new Names(picture);
  const isNamed = el("input", { type: "checkbox", checked: flight.stops.length <= MAX_NAMED });
  isNamed.addEventListener("change", () => turned.renew());
  const turned = turning(picture, {
    home: () => middle(content), width: () => size,
    draw: () => {
      if (size) draw(picture, size, turned.pose, { ...content, names: isNamed.checked ? names : null });
      picture.dataset.pose = turned.pose.told();
    },
    grab: (event) => {
      const stop = event.target.closest?.(".stop");
      if (stop) cursor.set(Number(stop.dataset.time));
      return null;
    },
  });

  cursor.listen((time) => {
    content.now = rotate(flight.attitudeAt(time), axis.direction);
    for (const stop of content.stops) stop.reached = stop.time <= time;
    turned.renew();
  });
  watchSize(picture, signal, (width) => {
    size = width;
    turned.renew();
  });
  turned.reset();

  let data = directions(flight, axis);
  const head = el("div", { class: "tools" }, el("label", { for: id }, "Axis"), choice,
    flight.stops.length ? el("label", { class: "named-stops" }, isNamed, "Names") : null, turned.buttons,
    pictureButtons(title.toLowerCase(), () => flight.scenario.name));
  return section(title, { head, class: "sky" }, picture, legend(flight), data);
}

/** Named boresights first, then the axes of the body. */
function bodyAxes(scenario) {
  const named = (scenario.spacecraft.boresights ?? []).map(({ name, axis }) => ({ name, boresight: name, direction: unit(axis) }));
  const plain = [["+Z", [0, 0, 1]], ["+X", [1, 0, 0]], ["+Y", [0, 1, 0]], ["−Z", [0, 0, -1]], ["−X", [-1, 0, 0]], ["−Y", [0, -1, 0]]];
  return [...named, ...plain.map(([name, direction]) => ({ name: `${name} body`, boresight: null, direction }))];
}

/** The first boresight; without any, and without targets, the axis that ends farthest from its start. */
function first(flight, axes) {
  if (axes[0].boresight || flight.stops.length) return 0;
  const [from, to] = [flight.attitudes[0], flight.attitudes.at(-1)];
  const near = axes.map(({ direction }) => dot(rotate(from, direction), rotate(to, direction)));
  // What turns as far as the axis before it is rounding.
  return near.reduce((best, value, index) => (value < near[best] - 1e-9 ? index : best), 0);
}

function contentOf(flight, axis) {
  const direction = (attitude) => rotate(attitude, axis.direction);
  const stops = flight.stops.map((stop) => ({
    ...stop, direction: direction(stop.attitude), reached: false,
    up: isPointed(stop, axis) ? rotate(stop.attitude, upward(axis.direction)) : null,
  }));
  const ends = endsOf(flight).map((end) => ({ ...end, direction: direction(end.attitude) }));
  const caps = flight.excluded.map((cap) => ({ ...cap, applies: cap.boresight === axis.boresight }));
  return { trace: trace(flight, axis), stops, ends, caps, now: null };
}

/** Whether a target points this axis and leaves its roll to the plan. */
function isPointed({ roll, pointed }, { boresight, direction }) {
  if (roll === null || pointed === null) return false;
  return Array.isArray(pointed) ? dot(unit(pointed), direction) > 1 - 1e-12 : pointed === boresight;
}

/** The start, and the end where one is asked for. */
function endsOf({ attitudes, total, scenario }) {
  const start = { name: "start", time: 0, attitude: attitudes[0] };
  return scenario.end ? [start, { name: "end", time: total, attitude: attitudes.at(-1) }] : [start];
}

/** The way of the axis, with more points where the samples are far apart. */
function trace(flight, axis) {
  const { times, attitudes } = flight;
  const way = [];
  times.forEach((time, index) => {
    const next = Math.min(index + 1, times.length - 1);
    const near = Math.abs(attitudes[index].reduce((total, value, part) => total + value * attitudes[next][part], 0));
    const parts = Math.max(1, Math.ceil((2 * Math.acos(Math.min(1, near))) / STEP));
    for (let part = 0; part < parts; part += 1) {
      const moment = time + ((times[next] - time) * part) / parts;
      way.push(rotate(flight.attitudeAt(moment), axis.direction));
    }
  });
  return way;
}

/** Longitude and latitude in the middle of the targets or ends, or somewhat above a ring of them. */
function middle(content) {
  const places = content.stops.length ? content.stops : content.ends;
  const mean = places.reduce((total, place) => sum(total, place.direction), [0, 0, 0]);
  const clear = Math.hypot(...mean) > CLEAR * places.length;
  return clear ? longitudeLatitude(mean) : [longitudeLatitude(content.ends[0].direction)[0], 30];
}

function legend(flight) {
  const cones = flight.excluded.length > 0;
  const frame = flight.scenario.reference_frame ?? "the reference frame";
  const rolls = flight.stops.some(({ roll }) => roll !== null) ? ", ticks the roll where it is chosen: up is 0°" : "";
  const marks = flight.stops.length ? `Numbers give the visiting order${rolls}` : "Rings are the start and the end";
  return el("p", { class: "quiet" }, `Seen from outside, in ${frame}. ${marks}`,
    cones ? "; red is what cones exclude, of other boresights dashed." : ".");
}

function directions(flight, axis) {
  return disclosure("Directions as a table", () => {
    const columns = [
      { title: "Place", head: true }, { title: "Arrival, s", number: true },
      { title: "Longitude, °", number: true }, { title: "Latitude, °", number: true },
    ];
    const places = flight.stops.length ? flight.stops : endsOf(flight);
    const rolls = flight.stops.some(({ roll }) => roll !== null);
    if (rolls) columns.push({ title: "Roll, °", number: true });
    return table(`Where ${axis.name} points`, columns, places.map(({ number, name, time, attitude, roll }) => {
      const [longitude, latitude] = longitudeLatitude(rotate(attitude, axis.direction));
      const row = [number ? `${number}: ${name}` : name, fixed(time), fixed(longitude, 1), fixed(latitude, 1)];
      return rolls ? [...row, roll === null ? "given" : fixed(roll, 1)] : row;
    }));
  });
}
