// Plays the flight: moves the shared moment on, at a choice of speeds.

import { el } from "./dom.js";
import { settings } from "./settings.js";
import { clockOf, momentText } from "./units.js";

const SPEEDS = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
/** So long takes a flight at the speed that is chosen first, s. */
const USUAL_S = 25;
/** With reduced motion the moment goes on in steps, ms. */
const STEP_MS = 1000;
/** A tab that was hidden goes on where it was, ms. */
const LONGEST_MS = 250;
const EPSILON = 1e-6;

/** The bar that plays a flight; `toggle` plays and pauses. */
export function playback(flight, cursor, signal) {
  const reduced = matchMedia("(prefers-reduced-motion: reduce)");
  const stops = [0, ...flight.stops.map(({ time }) => time), flight.total];
  const usual = SPEEDS.findLast((speed) => speed <= Math.max(SPEEDS[0], flight.total / USUAL_S));
  const speed = el("select", { id: "playback-speed" }, SPEEDS.map((value) => el("option", { value: String(value) }, `${value}×`)));
  speed.value = String(usual);
  const play = el("button", { type: "button", class: "small play", onclick: () => toggle() }, "Play");
  const button = (text, label, act) => el("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
  const moment = el("output", { class: "playback-moment", "aria-hidden": "true" });
  const node = el("div", { class: "playback", role: "group", "aria-label": "Playback" },
    play,
    button("|‹", "To the arrival before", () => jump(-1)), button("›|", "To the next arrival", () => jump(1)),
    el("label", { for: "playback-speed" }, "Speed"), speed, moment);

  let last = null;
  let timer = null;
  const now = () => cursor.time ?? 0;
  const isPlaying = () => last !== null;

  function jump(way) {
    const next = way > 0 ? stops.find((time) => time > now() + EPSILON) : stops.findLast((time) => time < now() - EPSILON);
    if (next !== undefined) cursor.set(next);
  }
  function pause() {
    last = null;
    cancelAnimationFrame(timer);
    clearTimeout(timer);
    play.textContent = "Play";
    node.dataset.playing = "no";
  }
  function toggle() {
    if (isPlaying()) return pause();
    if (now() >= flight.total - EPSILON) cursor.set(0);
    last = performance.now();
    play.textContent = "Pause";
    node.dataset.playing = "yes";
    return again();
  }
  function again() {
    timer = reduced.matches ? setTimeout(step, STEP_MS) : requestAnimationFrame(step);
  }
  function step() {
    if (!isPlaying() || signal.aborted) return;
    const time = performance.now();
    const passed = Math.min(time - last, reduced.matches ? STEP_MS : LONGEST_MS) / 1000;
    last = time;
    cursor.set(Math.min(flight.total, now() + passed * Number(speed.value)));
    if (now() >= flight.total) pause();
    else again();
  }
  const clock = clockOf(flight.scenario);
  const show = () => (moment.textContent = momentText(now(), clock));
  cursor.listen(show, signal);
  settings.listen(show, signal);
  signal.addEventListener("abort", pause);
  node.dataset.playing = "no";
  return { node, toggle };
}
