// The sky before planning: where targets, cones and the Sun are. Targets are chosen and moved here.

import { disclosure, el, section, svg, table, watchSize } from "../dom.js";
import { fixed } from "../format.js";
import { dot, longitudeLatitude, sum, unit } from "../rotation.js";
import { pictureButtons } from "../picture/save.js";
import { draw } from "../sphere/scene.js";
import { turning } from "../sphere/turning.js";
import { moved, shifted, skyDirection } from "./orientation.js";
import { withMembers } from "./rows.js";
import { axesOf, capsOf, placesOf } from "./sky-content.js";
import { PlacesLayer } from "./sky-places.js";
import { TARGETS } from "./tables.js";

/** Below this length the mean direction of the targets says little about where they are. */
const CLEAR = 0.3;
/** Digits of what is moved, degrees. */
const DIGITS = 3;
const HELP = "Drag to turn. A chosen target is dragged to another place.";

/** The section with the sky of a desk. */
export function skyView(desk) {
  const picture = svg("svg", {
    class: "sphere desk-sphere", tabindex: "0", role: "application",
    "aria-label": "Sky with targets, cones and the Sun. Arrow keys turn it, plus and minus zoom, 0 resets, "
      + "n and p choose the next and previous target, Shift with arrows moves the chosen one by a degree.",
  });
  const status = el("p", { class: "quiet sky-status", role: "status" }, HELP);
  const axisChoice = el("select", { id: "sky-axis" });
  const layer = new PlacesLayer(picture);
  let [size, axes, content] = [0, [], null];
  /** The boresight that somebody has asked for; the first one until then. */
  let wanted = null;
  const data = el("div", {});
  const legend = el("p", { class: "quiet" });
  const details = disclosure("Directions as a table", () => data);
  details.addEventListener("toggle", () => details.open && data.replaceChildren(directions(content)));

  const chosenAxis = () => axes[axisChoice.value] ?? axes[0];

  const renew = () => {
    if (!desk.draft.isReadable) return;
    const former = content;
    axes = axesOf(desk.spacecraft);
    const index = axes.findIndex(({ name }) => name === wanted);
    axisChoice.replaceChildren(...axes.map(({ name }, place) => el("option", { value: String(place) }, name)));
    axisChoice.value = String(Math.max(0, index));
    content = { ...placesOf(desk.document, desk, chosenAxis()), caps: capsOf(desk.document, desk.sun, chosenAxis()), sun: desk.sun };
    const isNew = !former || (!former.targets.length && content.targets.length);
    if (isNew) turned.reset();
    turned.renew();
    if (details.open) data.replaceChildren(directions(content));
    legend.textContent = legendOf(desk, content);
    say();
  };
  const chosen = () => content?.targets.find(({ index }) => index === desk.targets.last) ?? null;
  function say() {
    const place = chosen();
    if (!place) {
      status.textContent = HELP;
      return;
    }
    const [ascension, declination] = longitudeLatitude(place.direction);
    status.textContent = `${place.name}: RA ${fixed(ascension, 3)}°, Dec ${fixed(declination, 3)}°`
      + (content.sun ? `, ${fixed(separation(place.direction, content.sun), 1)}° from the Sun` : "");
  }
  /** Points the boresight of a target elsewhere; all of one drag is one step of the history. */
  const move = (place, direction, group) => {
    const short = skyDirection(longitudeLatitude(direction).map((angle) => Number(angle.toFixed(DIGITS))));
    const target = desk.document.targets[place.index];
    const now = moved(target, place.axis, short, desk.spacecraft, desk.sun);
    if (!now) return;
    const path = [...TARGETS.path, place.index];
    desk.draft.edit(withMembers(desk.draft.text, path, TARGETS.members, now), `move ${place.name}`, group);
  };
  const choose = (index) => desk.targets.set(index);
  const step = (by) => {
    const { targets } = content;
    if (!targets.length) return;
    const at = targets.findIndex(({ index }) => index === desk.targets.last);
    const next = targets[(at + by + targets.length) % targets.length] ?? targets[0];
    choose(next.index);
    turned.pose.look(...longitudeLatitude(next.direction));
  };
  /**
   * A drag of a target moves it. A finger chooses a target with a first touch and moves it with the next, so
   * that a page can be scrolled over the sky.
   */
  const grab = (event) => {
    const hit = event.target.closest?.(".place.target:not(.behind)");
    if (!hit) return null;
    const index = Number(hit.dataset.index);
    const mayMove = event.pointerType === "mouse" || desk.targets.last === index;
    choose(index);
    if (!mayMove) return null;
    return {
      move: ([x, y]) => {
        const place = content.targets.find((one) => one.index === index);
        if (place) move(place, layer.directionAt(x, y), `drag ${place.name}`);
      },
      end: () => desk.draft.settle(),
    };
  };
  const shift = (east, north) => {
    const place = chosen();
    if (place) move(place, shifted(place.direction, east, north), `shift ${place.name}`);
  };

  const turned = turning(picture, {
    home: () => (content ? middle(content) : [0, 0]), width: () => size, grab,
    draw: () => {
      if (!size || !content) return;
      const { pose } = turned;
      draw(picture, size, pose, { caps: content.caps, trace: [], ends: [], stops: [], now: null });
      layer.draw({ size, pose, content, selection: desk.targets });
    },
    more: {
      n: () => step(1), p: () => step(-1),
      "Shift+ArrowLeft": () => shift(-1, 0), "Shift+ArrowRight": () => shift(1, 0),
      "Shift+ArrowUp": () => shift(0, 1), "Shift+ArrowDown": () => shift(0, -1),
    },
  });
  watchSize(picture, desk.signal, (width) => {
    size = width;
    turned.renew();
  });
  axisChoice.addEventListener("change", () => {
    wanted = axes[axisChoice.value].name;
    renew();
  });
  desk.draft.listen(renew, desk.signal);
  desk.listen(renew);
  desk.targets.listen(() => {
    turned.renew();
    say();
  }, desk.signal);

  const head = el("div", { class: "tools" }, el("label", { for: "sky-axis" }, "Boresight"), axisChoice,
    turned.buttons,
    pictureButtons("sky", () => desk.document.name));
  renew();
  return section("Sky", { head, class: "desk-part desk-sky" }, picture, status, legend, details);
}

const separation = (a, b) => (Math.acos(Math.max(-1, Math.min(1, dot(unit(a), unit(b))))) * 180) / Math.PI;

/** Longitude and latitude in the middle of the targets, or somewhat above a ring of them. */
function middle({ targets, ends, sun }) {
  const places = targets.length ? targets : ends;
  const mean = places.reduce((total, place) => sum(total, place.direction), [0, 0, 0]);
  if (places.length && Math.hypot(...mean) > CLEAR * places.length) return longitudeLatitude(mean);
  const first = places[0]?.direction ?? sun;
  return [first ? longitudeLatitude(first)[0] : 0, 30];
}

function legendOf({ document }, { caps, sun, targets }) {
  const frame = document.reference_frame ?? "EME2000";
  const wants = [document.keep_out, document.keep_in].flat().some((cone) => cone?.direction?.body === "sun");
  const unknown = (Array.isArray(document.targets) ? document.targets.length : 0) - targets.length;
  return [
    `Seen from outside, in ${frame}.`,
    caps.length ? "Red is what cones exclude, of other boresights dashed." : "",
    wants && !sun ? "Cones around the Sun need an epoch, and axes of the Earth's equator, to be drawn." : "",
    unknown ? `${unknown} targets have no direction yet.` : "",
  ].filter(Boolean).join(" ");
}

function directions({ targets, ends, sun }) {
  const columns = [
    { title: "Place", head: true }, { title: "Boresight" }, { title: "RA, °", number: true }, { title: "Dec, °", number: true },
    { title: "From the Sun, °", number: true },
  ];
  return table("Where boresights point", columns, [...targets, ...ends].map(({ name, boresight, direction }) => {
    const [ascension, declination] = longitudeLatitude(direction);
    const axis = Array.isArray(boresight) ? boresight.join(" ") : boresight ?? "body axis";
    return [name, axis, fixed(ascension, 2), fixed(declination, 2), sun ? fixed(separation(direction, sun), 1) : "–"];
  }));
}
