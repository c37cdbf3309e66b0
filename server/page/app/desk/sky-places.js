// The places of the sky before planning, with their names, on top of the sphere.

import { svg } from "../dom.js";
import { letters } from "../plots/palette.js";
import { scaled, sum, unit } from "../rotation.js";
import { Names } from "../sphere/names.js";
import { seen } from "../sphere/projection.js";

/** As in the picture of a flight: what is left free around the globe. */
const MARGIN = 22;
const RADIUS = 4.5;

export class PlacesLayer {
  #picture;
  #names;
  #pose = null;

  constructor(picture) {
    this.#picture = picture;
    this.#names = new Names(picture);
  }

  /** Draws all places; who draws first has drawn the globe. */
  draw({ size, pose, content, selection }) {
    const larger = letters();
    const centre = size / 2;
    const { view } = pose;
    const radius = (centre - MARGIN * larger) * pose.zoom;
    this.#pose = { centre, radius, view };
    const marks = [
      ...(content.sun ? [{ name: "Sun", kind: "sun", index: null, direction: content.sun }] : []),
      ...content.targets.map((place) => ({ ...place, kind: "target", isChosen: selection.has(place.index) })),
      ...content.ends.map((place) => ({ ...place, kind: "end" })),
    ].map((mark) => {
      const [x, y, ahead] = seen(view, mark.direction);
      return { ...mark, x: centre + radius * x, y: centre - radius * y, ahead };
    });
    const front = marks.filter(({ ahead, x, y }) => ahead >= 0 && x > 0 && y > 0 && x < size && y < size);
    // The Sun and what is chosen first, then what is in the middle.
    const rank = ({ kind, isChosen, ahead }) => (isChosen ? 3 : kind === "sun" ? 2 : ahead);
    const { leaders, labels } = this.#names.nodes(front.map((mark) => ({ ...mark, rank: rank(mark), radius: RADIUS * larger + 1 })), size);
    this.#picture.append(
      ...marks.filter((mark) => mark.ahead < 0).map((mark) => drawMark(mark, larger)),
      ...leaders,
      ...front.toSorted((a, b) => Boolean(a.isChosen) - Boolean(b.isChosen)).map((mark) => drawMark(mark, larger)),
      ...labels,
    );
    this.#picture.dataset.pose = pose.told();
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
