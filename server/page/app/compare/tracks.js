// The phases of two flights below each other, on one axis of time.

import { el, section } from "../dom.js";
import { fixed } from "../format.js";
import { pictureButtons } from "../picture/save.js";

/** Shares of the width from which on a bar has its text. */
const ROOM = 0.025;

/** The section with a track for each flight. */
export function tracks(flights, names, total, cursor, signal) {
  const share = (time) => `${(100 * time) / total}%`;
  const markers = flights.map(() => el("div", { class: "lane-marker" }));
  const bar = (phase) => {
    const long = (phase.end - phase.begin) / total > ROOM;
    const node = el("div", {
      class: `bar ${phase.kind}`, title: `${phase.name}: ${fixed(phase.begin, 1)} to ${fixed(phase.end, 1)} s`,
    }, long && phase.kind === "slew" ? el("span", {}, phase.number ? phase.label : "end") : null);
    node.style.left = share(phase.begin);
    node.style.width = `max(2px, ${(100 * (phase.end - phase.begin)) / total}% - 1px)`;
    return node;
  };
  const slider = el("input", { type: "range", id: "moment", "aria-label": "Moment", min: "0", max: String(total), step: String(total / 2000), value: "0" });
  slider.addEventListener("input", () => cursor.set(Number(slider.value)));
  cursor.listen((time) => {
    for (const marker of markers) marker.style.left = share(time);
    slider.value = String(time);
    slider.setAttribute("aria-valuetext", `${fixed(time, 1)} s`);
  }, signal);
  return section("Phases of both", { class: "wide tracks", head: el("div", { class: "tools" }, pictureButtons("phases of both")) },
    flights.map((flight, index) => [
      el("p", { class: "track-name" }, `${names[index]}, ${fixed(flight.total)} s`),
      el("div", { class: "track", "aria-hidden": "true" }, flight.phases.map(bar), markers[index]),
    ]),
    slider,
    el("p", { class: "quiet" }, "Both begin at the same moment; the bar is named after the target that it leads to. Arrivals are in the table below."));
}
