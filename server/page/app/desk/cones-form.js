// The cones in which boresights must not, or must, point.

import { el, section } from "../dom.js";
import { Selection } from "./selection.js";
import { cones } from "./tables.js";

const LISTS = [
  ["keep_out", "Keep-out cones", "None: a cone around the Sun is one row with its half angle."],
  ["keep_in", "Keep-in cones", "None: such as the normal of a solar panel near the Sun."],
];

/** The section of cones. */
export function conesForm(desk) {
  return section("Cones", { class: "desk-part" }, LISTS.map(([key, title, empty]) =>
    el("div", {}, el("h3", {}, title), desk.grid(cones(key, title), { selection: new Selection(), empty }).node)));
}
