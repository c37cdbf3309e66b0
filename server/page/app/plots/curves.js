// Values against another value than time, perhaps with points to choose from.

import { el } from "../dom.js";
import { significant } from "../format.js";
import { limitLine, markLine } from "./limits.js";
import { curve, letters } from "./palette.js";
import { plot } from "./plot.js";

const HEIGHT = 210;
/** The name of a distribution in the library. */
const LOGARITHMIC = 3;
/** From this ratio of the largest to the smallest value on, an axis is logarithmic. */
const DECADES = 20;
/** An axis of more decades than this has a number at every second one. */
const MOST_DECADES = 6;
/** Room beside the values: a share of their range, and on a logarithmic axis of their ratio. */
const ROOM = 0.08;

let groups = 0;

/**
 * A chart of {title, unit, against, curves, limit, marks, points, from}. `against` is {title, unit, values};
 * a curve is {name, values, colour, shown} with `null` where there is no value, `shown` as a "line" or as
 * "dots" instead of both; a limit is {name, value}; `marks` are values of the axis that are named there;
 * `from` is a value that the vertical axis has in any case. `points` are those of the first curve: `label` names
 * one for those who listen, `failed` tells which are marked, and `choose` is called with the index of the
 * chosen one.
 */
export function curveChart({ title, unit, against, curves, limit, marks: marked = [], points, from, linear = false }, signal) {
  // The library wants ascending values; the caller's order may be another.
  const order = against.values.map((_, index) => index).sort((a, b) => against.values[a] - against.values[b]);
  const sorted = (values) => order.map((index) => values[index]);
  const radios = points ? choices(against.values.length, title, points) : [];
  const place = el("div", points
    ? { class: "plot pointed", role: "radiogroup", "aria-label": `${title}, ${unit} against ${against.title}` }
    : { class: "plot", role: "img", "aria-label": `${title} against ${against.title}. The values are in the table.` });
  const named = curves.length > 1 || limit;
  const key = named ? el("ul", { class: "key" }, curves.filter(({ name }) => name).map((one) => entry(`curve-${one.colour}`, one.name)),
    limit ? entry("limit-line", limit.name) : null) : null;

  const all = [...curves.flatMap((one) => one.values), ...(limit ? [limit.value] : [])];
  const scale = linear ? linearScale : scaleOf;
  const scales = { x: { time: false, ...scale(against.values) }, y: scale(all, from) };
  const put = (drawn) => radios.forEach((radio, index) => {
    const value = curves[0].values[index];
    radio.hidden = value === null;
    radio.style.left = `${drawn.valToPos(against.values[index], "x")}px`;
    radio.style.top = `${drawn.valToPos(value, "y")}px`;
  });
  const options = {
    height: HEIGHT,
    scales,
    series: [{}, ...curves.map((one) => ({
      label: one.name ?? "", width: one.shown === "dots" ? 0 : 1.75, stroke: () => curve(one.colour - 1), spanGaps: Boolean(one.shown),
      points: points || one.shown === "line" ? { show: false } : { show: true, size: 6, fill: () => curve(one.colour - 1) },
    }))],
    axes: [
      { ...marks(scales.x), label: [against.title, against.unit].filter(Boolean).join(", "), labelSize: 20 * letters(),
        labelFont: `${12 * letters()}px system-ui, sans-serif`, labelGap: 0 },
      marks(scales.y),
    ],
    cursor: { show: false, drag: { x: false, y: false } },
    hooks: {
      draw: [(drawn) => limit && limitLine(drawn, limit.value), (drawn) => marked.forEach((value) => markLine(drawn, value, significant(value))), put],
      ready: [(drawn) => drawn.over.append(...radios)],
    },
  };
  // The plot needs a width, which there is when it is on the page.
  requestAnimationFrame(() => {
    if (!signal.aborted) plot(place, options, [sorted(against.values), ...curves.map((one) => sorted(one.values))], signal);
  });
  return {
    node: el("div", { class: "chart" },
      el("div", { class: "chart-head" }, el("h3", {}, title, " ", el("span", { class: "unit" }, unit)), key), place),
    choose: (index) => (radios[index].checked = true),
  };
}

function entry(kind, name) {
  return el("li", {}, el("span", { class: `swatch ${kind}`, "aria-hidden": "true" }), name);
}

/** One radio button for every point: browsers lead through them with the arrow keys. */
function choices(number, title, points) {
  const name = `points-${(groups += 1)}`;
  return Array.from({ length: number }, (_, index) => el("input", {
    type: "radio", name, class: `point ${points.failed(index) ? "failed" : ""}`, "aria-label": points.label(index),
    onchange: () => points.choose(index),
  }));
}

/** How an axis is divided, by the values on it; `from` is a value that is on it in any case. */
function scaleOf(values, from = null) {
  const known = values.filter((value) => value !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  if (from === null && low > 0 && high / low >= DECADES) {
    const room = (high / low) ** ROOM;
    return { distr: LOGARITHMIC, log: 10, range: [low / room, high * room] };
  }
  return linearScale(values, from);
}

function linearScale(values, from = null) {
  const known = values.filter((value) => value !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const [begin, end] = from === null ? [low, high] : [Math.min(from, low), high];
  const room = ROOM * (end - begin || Math.abs(end) || 1);
  return { range: [begin - room, end + room] };
}

/** Where an axis has its marks, and the numbers at them. */
function marks({ distr, range: [low, high] }) {
  const text = (value) => significant(Number(value.toPrecision(6)), 6);
  if (distr !== LOGARITHMIC) return { values: (_, values) => values.map(text) };
  // The library would count from the lowest value on, whatever that is.
  const [first, last] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
  const decades = Array.from({ length: last - first }, (_, index) => 10 ** (first + index));
  const splits = decades.flatMap((decade) => [1, 2, 3, 4, 5, 6, 7, 8, 9].map((digit) => digit * decade))
    .filter((value) => value >= low && value <= high);
  const numbered = high / low < 100 ? ["1", "2", "5"] : ["1"];
  // Numbers of many decades would touch each other: every second one then, with 1 among them.
  const every = decades.length > MOST_DECADES ? 2 : 1;
  const isNumbered = (value) => {
    const [digit, exponent] = value.toExponential(0).split("e");
    return numbered.includes(digit) && Number(exponent) % every === 0;
  };
  const values = () => splits.map((value) => (isNumbered(value) ? text(value) : ""));
  return { splits: () => splits, filter: (_, all) => all, values };
}
