// The places of the sky before planning, with their names, on top of the sphere.

import { svg } from "../dom.js";
import { letters } from "../plots/palette.js";
import { scaled, sum, unit } from "../rotation.js";
import { placeLabels } from "../sphere/labels.js";
import { seen } from "../sphere/projection.js";

/** As in the picture of a flight: what is left free around the globe. */
const MARGIN = 22;
/** More places than these are not named, but for the chosen one. */
const MAX_NAMES = 64;
const FONT_PX = 11.5;
const MAX_LETTERS = 18;
const RADIUS = 4.5;

export class PlacesLayer {
  #picture;
  #ink = document.createElement("canvas").getContext("2d");
  #pose = null;

  constructor(picture) {
    this.#picture = picture;
  }

  /** Draws all places; who draws first has drawn the globe. */
  draw({ size, turning, content, selection }) {
    const larger = letters();
    const centre = size / 2;
    const { view } = turning;
    const radius = (centre - MARGIN * larger) * turning.zoom;
    this.#pose = { centre, radius, view };
    this.#ink.font = `${FONT_PX * larger}px ${getComputedStyle(this.#picture).fontFamily}`;
    const marks = [
      ...(content.sun ? [{ name: "Sun", kind: "sun", index: null, direction: content.sun }] : []),
      ...content.targets.map((place) => ({ ...place, kind: "target", isChosen: selection.has(place.index) })),
      ...content.ends.map((place) => ({ ...place, kind: "end" })),
    ].map((mark) => {
      const [x, y, ahead] = seen(view, mark.direction);
      return { ...mark, x: centre + radius * x, y: centre - radius * y, ahead };
    });
    const front = marks.filter(({ ahead, x, y }) => ahead >= 0 && x > 0 && y > 0 && x < size && y < size);
    const named = this.#named(front, larger);
    const boxes = placeLabels(named, size);
    this.#picture.append(
      ...marks.filter((mark) => mark.ahead < 0).map((mark) => drawMark(mark, larger)),
      ...named.map((mark, index) => boxes[index] && leader(mark, boxes[index])).filter(Boolean),
      ...front.toSorted((a, b) => Boolean(a.isChosen) - Boolean(b.isChosen)).map((mark) => drawMark(mark, larger)),
      ...named.map((mark, index) => boxes[index] && label(mark, boxes[index])).filter(Boolean),
    );
    this.#picture.dataset.pose = `${turning.longitude.toFixed(1)} ${turning.latitude.toFixed(1)} ${turning.zoom.toFixed(2)}`;
  }

  /** The direction at a point of the picture; on the limb what is outside the globe. */
  directionAt(px, py) {
    const { centre, radius, view } = this.#pose;
    let [x, y] = [(px - centre) / radius, (centre - py) / radius];
    const away = Math.hypot(x, y);
    if (away > 1) [x, y] = [x / away, y / away];
    const ahead = Math.sqrt(Math.max(0, 1 - x * x - y * y));
    return unit(sum(sum(scaled(view.right, x), scaled(view.up, y)), scaled(view.ahead, ahead)));
  }

  /** What gets a name, with its size: the Sun and what is chosen first, then what is in the middle. */
  #named(marks, larger) {
    const rank = ({ kind, isChosen, ahead }) => (isChosen ? 3 : kind === "sun" ? 2 : ahead);
    return marks.toSorted((a, b) => rank(b) - rank(a)).slice(0, MAX_NAMES).map((mark) => {
      const text = mark.name.length > MAX_LETTERS ? `${mark.name.slice(0, MAX_LETTERS - 1)}…` : mark.name;
      return { ...mark, text, width: this.#ink.measureText(text).width + 4, height: 1.15 * FONT_PX * larger, radius: RADIUS * larger + 1 };
    });
  }
}

function drawMark({ name, kind, index, x, y, ahead, isChosen }, larger) {
  const names = ["place", kind, ahead < 0 && "behind", isChosen && "chosen"].filter(Boolean).join(" ");
  const attributes = { class: names, transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` };
  const node = svg("g", index === null ? attributes : { ...attributes, "data-index": index });
  // A finger is larger than the mark.
  if (kind === "target") node.append(svg("circle", { class: "reach", r: 14 * larger }));
  node.append(svg("circle", { class: "spot", r: (kind === "sun" ? 7 : RADIUS) * larger }));
  node.append(svg("title", {}, name));
  return node;
}

/** A line from a place to its name where that stands apart. */
function leader({ x, y }, box) {
  const [cx, cy] = [Math.max(box.x, Math.min(x, box.x + box.width)), Math.max(box.y, Math.min(y, box.y + box.height))];
  if (Math.hypot(cx - x, cy - y) < 14) return null;
  return svg("line", { class: "leader", x1: x.toFixed(1), y1: y.toFixed(1), x2: cx.toFixed(1), y2: cy.toFixed(1) });
}

function label({ text, isChosen }, box) {
  return svg("text", {
    class: isChosen ? "place-name chosen" : "place-name", x: (box.x + box.width / 2).toFixed(1), y: (box.y + 0.78 * box.height).toFixed(1),
  }, text);
}
