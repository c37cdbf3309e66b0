// What wheels can do together, and which part of it slews use.

import { disclosure, el, section, table } from "../dom.js";
import { fixed, significant } from "../format.js";
import { pictureButtons } from "../picture/save.js";
import { curveChart } from "../plots/curves.js";
import { merged } from "../plots/merged.js";
import { envelopeSolid, shareOf } from "./envelope-solid.js";
import { generic } from "./generic.js";

const DEGREES = 180 / Math.PI;
/** Parts of a straight piece of a way at whose ends its share is computed: another facet may come between. */
const PARTS = 16;
const KINDS = [["full", "full envelope"], ["pseudo_inverse", "pseudo-inverse envelope"]];
/** The slews of a turn that are compared: list, member, value, name. */
const SLEWS = [
  ["eigenaxis", "limit", "pseudo_inverse", "eigenaxis, pseudo-inverse"], ["eigenaxis", "limit", "full", "eigenaxis, full envelope"],
  ["time_optimal", "allocation", "pseudo_inverse", "fastest, pseudo-inverse"], ["time_optimal", "allocation", "free", "fastest"],
];

/** The nodes of an answer. */
export function envelopes(answer, signal) {
  const { document } = answer;
  const arrays = [document.momentum && { title: "Momentum", array: document.momentum, isJoined: true },
    { title: "Torque", array: document.torque, isJoined: false }].filter(Boolean);
  const place = el("div", { class: "result" });
  const choice = el("select", { id: "turn" }, document.turns.map((turn, index) => el("option", { value: String(index) }, described(turn))));
  let drawing = new AbortController();
  signal.addEventListener("abort", () => drawing.abort());
  const draw = () => {
    drawing.abort();
    drawing = new AbortController();
    place.replaceChildren(...drawn(arrays, slewsOf(document.turns[choice.value]), drawing.signal));
  };
  choice.addEventListener("change", draw);
  draw();
  return [
    document.complete === false ? el("p", { class: "cut-short" }, "Time ran out: not every slew was solved.") : null,
    document.turns.length ? el("div", { class: "filters" }, el("label", { for: "turn" }, "Turn"), choice) : null,
    place,
    section("Envelopes", { class: "wide" }, sizes(arrays)),
    document.turns.length ? section("Slews", { class: "wide" }, durations(document.turns)) : null,
    el("div", { class: "result-more" }, disclosure("All figures as tables", () => generic(answer))),
  ];
}

function described({ angle_rad: angle, axis }) {
  return `${fixed(DEGREES * angle, 1)}° about (${axis.map((part) => fixed(part, 3)).join(", ")})`;
}

function slewsOf(turn) {
  if (!turn) return [];
  return SLEWS.flatMap(([list, member, value, name]) => {
    const found = turn[list].find((slew) => slew[member] === value);
    return found?.path && found.duration_s !== null ? [{ name, duration: found.duration_s, path: found.path }] : [];
  }).map((slew, index) => ({ ...slew, colour: index + 1 }));
}

/** Momenta at their times, or torques at both ends of the intervals in which they are constant, as [time, vector]. */
function wayOf({ path }, isJoined) {
  if (isJoined) return path.momentum.map((sample) => [sample.time_s, sample.momentum_nms]);
  return path.torque.flatMap((one) => [[one.start_s, one.torque_nm], [one.start_s + one.duration_s, one.torque_nm]]);
}

function drawn(arrays, slews, signal) {
  const key = el("ul", { class: "key" }, slews.map(({ name, duration, colour }) =>
    el("li", {}, el("span", { class: `swatch curve-${colour}`, "aria-hidden": "true" }), `${name}, ${fixed(duration)} s`)));
  const solids = arrays.map(({ title, array, isJoined }) => {
    const ways = slews.map((slew) => ({ colour: slew.colour, isJoined, points: wayOf(slew, isJoined).map(([, vector]) => vector) }));
    const solid = envelopeSolid({ name: `${title} envelope`, full: array.full, inner: array.pseudo_inverse, ways }, signal);
    const head = el("div", { class: "tools" }, solid.buttons, pictureButtons(`${title.toLowerCase()} envelope`));
    return section(`${title}, ${array.unit}`, { head, class: "envelope" }, key.cloneNode(true), solid.node,
      el("p", { class: "quiet" }, "Grey is the full envelope, all that the wheels can do together; orange what the pseudo-inverse reaches. Axes are the body's."));
  });
  if (!slews.length) return [el("div", { class: "cards" }, solids)];
  const charts = arrays.flatMap(({ title, array, isJoined }) => KINDS.map(([kind, words]) => {
    const { values, curves } = merged(slews.map((slew) => sharesOf(wayOf(slew, isJoined), array[kind], isJoined)));
    return curveChart({
      title: `${title}, share of the ${words}`, unit: "", linear: true, from: 0,
      against: { title: "time", unit: "s", values },
      curves: slews.map(({ name, colour }, index) => ({ name, colour, values: curves[index], shown: "line" })),
      limit: { name: "all of it", value: 1 },
    }, signal);
  }));
  return [el("div", { class: "cards" }, solids),
    section("Shares over time", { class: "wide", head: el("div", { class: "tools" }, pictureButtons("shares over time")) },
      el("div", { class: "curves wider-curves" }, charts.map(({ node }) => node)),
      disclosure("Shares as a table", () => shares(arrays, slews)))];
}

/** The share of an envelope along a way. A jump has no points in between. */
function sharesOf(way, envelope, isJoined) {
  if (!isJoined) return way.map(([time, vector]) => [time, shareOf(envelope, vector)]);
  return way.flatMap(([begin, from], index) => {
    const [end, to] = way[index + 1] ?? [];
    if (!to) return [[begin, shareOf(envelope, from)]];
    return Array.from({ length: PARTS }, (_, part) => {
      const s = part / PARTS;
      return [begin + (end - begin) * s, shareOf(envelope, from.map((value, axis) => value + s * (to[axis] - value)))];
    });
  });
}

function shares(arrays, slews) {
  const columns = [{ title: "Slew", head: true }, { title: "Quantity" }, ...KINDS.map(([, words]) => ({ title: `most of the ${words}`, number: true }))];
  const most = (slew, { array, isJoined }, kind) => sharesOf(wayOf(slew, isJoined), array[kind], isJoined).reduce((found, [, share]) => Math.max(found, share), 0);
  return table("Largest shares of the envelopes", columns, slews.flatMap((slew) => arrays.map((one) =>
    [slew.name, one.title.toLowerCase(), ...KINDS.map(([kind]) => fixed(most(slew, one, kind), 3))])));
}

function sizes(arrays) {
  const columns = [
    { title: "Envelope", head: true }, { title: "Sphere inside", number: true }, { title: "Sphere of equal volume", number: true },
    { title: "Mean radius", number: true }, { title: "Largest", number: true }, { title: "Volume", number: true }, { title: "Facets", number: true },
  ];
  return table("Sizes of the envelopes", columns, arrays.flatMap(({ title, array }) => KINDS.map(([kind, words]) => {
    const one = array[kind];
    return [`${title}, ${array.unit}, ${words}`, ...[one.inscribed_radius, one.equal_volume_radius, one.mean_radius, one.greatest_radius, one.volume]
      .map((value) => significant(value)), String(one.facets.length)];
  })));
}

function durations(turns) {
  const columns = [{ title: "Turn", head: true }, ...SLEWS.map(([, , , name]) => ({ title: `${name}, s`, number: true }))];
  return table("Durations of the slews of every turn", columns, turns.map((turn) => {
    const slews = slewsOf(turn);
    return [described(turn), ...SLEWS.map(([, , , name]) => fixed(slews.find((slew) => slew.name === name)?.duration))];
  }));
}
