// A flight in its views, which share one moment: the bar that plays it, sky, body and timelines.

import { body } from "./body/body.js";
import { el } from "./dom.js";
import { playback } from "./playback.js";
import { sphere } from "./sphere/sphere.js";
import { timelines } from "./plots/timelines.js";

/** The views of a flight; `more` are further groups of curves of the timelines. */
export function flown(flight, cursor, signal, more = []) {
  const player = playback(flight, cursor, signal);
  return el("div", { class: "flown" }, player.node,
    el("div", { class: "flight" },
      el("div", { class: "pictures" }, sphere(flight, cursor, signal), body(flight, cursor, player.toggle, signal)),
      timelines(flight, cursor, signal, more)));
}
