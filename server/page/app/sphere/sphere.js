// The sky view: where an axis of the body points during the flight. It is turned by dragging and
// with the arrow keys.

import { disclosure, el, section, svg, table } from "../dom.js";
import { fixed } from "../format.js";
import { dot, longitudeLatitude, rotate, sum, unit, upward } from "../rotation.js";
import { viewOn } from "./projection.js";
import { draw } from "./scene.js";

const KEY_STEP = 5;
const ZOOM_STEP = 1.25;
const MOST_ZOOM = 12;
/** Below this length the mean direction of the targets says little about where they are. */
const CLEAR = 0.3;
const STEP = Math.PI / 90;

/** The section with the sphere of a flight. */
export function sphere(flight, cursor, signal) {
  const axes = bodyAxes(flight.scenario);
  let axis = axes[first(flight, axes)];
  let content = contentOf(flight, axis);
  const pose = { longitude: 0, latitude: 0, zoom: 1 };
  const picture = svg("svg", {
    class: "sphere", tabindex: "0", role: "application",
    "aria-label": "Sphere with the trace of the body axis. Arrow keys turn it, plus and minus zoom, 0 resets.",
  });
  const choice = el("select", { id: "body-axis" }, axes.map(({ name }, index) => el("option", { value: String(index) }, name)));
  choice.value = String(axes.indexOf(axis));
  choice.addEventListener("change", () => {
    axis = axes[choice.value];
    content = contentOf(flight, axis);
    data.replaceWith((data = directions(flight, axis)));
    reset();
  });

  let size = 0;
  let asked = false;
  const renew = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      if (size) draw(picture, size, { view: viewOn(pose.longitude, pose.latitude), zoom: pose.zoom }, content);
      picture.dataset.pose = `${pose.longitude.toFixed(1)} ${pose.latitude.toFixed(1)} ${pose.zoom.toFixed(2)}`;
    });
  };
  const turn = (longitude, latitude) => {
    pose.longitude = (pose.longitude + longitude + 360) % 360;
    pose.latitude = Math.max(-90, Math.min(90, pose.latitude + latitude));
    renew();
  };
  const zoom = (factor) => {
    pose.zoom = Math.max(1, Math.min(MOST_ZOOM, pose.zoom * factor));
    renew();
  };
  function reset() {
    [pose.longitude, pose.latitude] = middle(content);
    pose.zoom = 1;
    renew();
  }

  cursor.listen((time) => {
    content.now = rotate(flight.attitudeAt(time), axis.direction);
    for (const stop of content.stops) stop.reached = stop.time <= time;
    renew();
  });
  listenToKeys(picture, turn, zoom, reset);
  const pressed = (node) => {
    const stop = node.closest?.(".stop");
    if (stop) cursor.set(Number(stop.dataset.time));
  };
  const dragged = (dx, dy) => {
    const degrees = 360 / (Math.PI * size * pose.zoom);
    turn(-dx * degrees, dy * degrees);
  };
  listenToPointer(picture, pressed, dragged);
  const watcher = new ResizeObserver(([entry]) => {
    size = Math.round(entry.contentRect.width);
    renew();
  });
  watcher.observe(picture);
  signal.addEventListener("abort", () => watcher.disconnect());
  reset();

  let data = directions(flight, axis);
  const button = (text, label, act) => el("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
  const head = el("div", { class: "tools" }, el("label", { for: "body-axis" }, "Axis"), choice,
    button("−", "Zoom out", () => zoom(1 / ZOOM_STEP)), button("+", "Zoom in", () => zoom(ZOOM_STEP)),
    button("Reset", "Reset the view", reset));
  return section("Sky", { head, class: "sky" }, picture, legend(flight), data);
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

function listenToKeys(picture, turn, zoom, reset) {
  const acts = {
    ArrowLeft: () => turn(-KEY_STEP, 0), ArrowRight: () => turn(KEY_STEP, 0),
    ArrowUp: () => turn(0, KEY_STEP), ArrowDown: () => turn(0, -KEY_STEP),
    "+": () => zoom(ZOOM_STEP), "=": () => zoom(ZOOM_STEP), "-": () => zoom(1 / ZOOM_STEP), 0: reset,
  };
  picture.addEventListener("keydown", (event) => {
    picture.classList.remove("pointed");
    const act = !event.ctrlKey && !event.metaKey && !event.altKey && acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

function listenToPointer(picture, pressed, dragged) {
  let [from, begun] = [null, null];
  picture.addEventListener("pointerdown", (event) => {
    from = begun = event;
    // Whoever points sees what is turned; the frame of the focus is for keys.
    picture.classList.add("pointed");
    pressed(event.target);
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!from || event.pointerId !== from.pointerId) return;
    dragged(event.clientX - from.clientX, event.clientY - from.clientY);
    from = event;
  });
  picture.addEventListener("focus", () => {
    if (!from) picture.classList.remove("pointed");
  });
  picture.addEventListener("pointerup", () => (from = null));
  // The browser takes the finger for a scroll: what it has turned until then is taken back.
  picture.addEventListener("pointercancel", () => {
    if (from) dragged(begun.clientX - from.clientX, begun.clientY - from.clientY);
    from = null;
  });
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
