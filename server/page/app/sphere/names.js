// Names beside the places of a sphere, on top of it, where they hide neither each other nor the places.

import { svg } from "../dom.js";
import { letters } from "../plots/palette.js";
import { placeLabels } from "./labels.js";

/** More places than these are not named: those that come first are. */
export const MAX_NAMES = 64;
const FONT_PX = 11.5;
const MAX_LETTERS = 18;
/** A name that is farther from its place has a line to it, px. */
const APART = 14;

export class Names {
  #picture;
  #ink = document.createElement("canvas").getContext("2d");
  #known = { key: "", boxes: [] };

  constructor(picture) {
    this.#picture = picture;
  }

  /**
   * The nodes for places {name, x, y, radius, rank, isChosen} in a square of a size: `leaders` belong below
   * the places, `labels` above them. Names of a higher rank get nearer places.
   */
  nodes(places, size) {
    const larger = letters();
    this.#ink.font = `${FONT_PX * larger}px ${getComputedStyle(this.#picture).fontFamily}`;
    const named = places.toSorted((a, b) => b.rank - a.rank).slice(0, MAX_NAMES).map((place) => {
      const text = place.name.length > MAX_LETTERS ? `${place.name.slice(0, MAX_LETTERS - 1)}…` : place.name;
      return { ...place, text, width: this.#ink.measureText(text).width + 4, height: 1.15 * FONT_PX * larger };
    });
    // While only the moment changes, names stay where they are.
    const key = JSON.stringify([size, larger, named.map(({ text, x, y }) => [text, x.toFixed(1), y.toFixed(1)])]);
    if (key !== this.#known.key) this.#known = { key, boxes: placeLabels(named, size) };
    const placed = named.map((place, index) => [place, this.#known.boxes[index]]).filter(([, box]) => box);
    return { leaders: placed.map(([place, box]) => leader(place, box)).filter(Boolean), labels: placed.map(([place, box]) => label(place, box)) };
  }
}

/** A line from a place to its name where that stands apart. */
function leader({ x, y, radius }, box) {
  const [cx, cy] = [Math.max(box.x, Math.min(x, box.x + box.width)), Math.max(box.y, Math.min(y, box.y + box.height))];
  if (Math.hypot(cx - x, cy - y) < APART + radius - 5) return null;
  return svg("line", { class: "leader", x1: x.toFixed(1), y1: y.toFixed(1), x2: cx.toFixed(1), y2: cy.toFixed(1) });
}

function label({ text, isChosen }, box) {
  return svg("text", {
    class: isChosen ? "place-name chosen" : "place-name", x: (box.x + box.width / 2).toFixed(1), y: (box.y + 0.78 * box.height).toFixed(1),
  }, text);
}
