// Slew, wait, settle and dwell as bars before the windows that they lie in, aligned with the plots above them.

import { disclosure, el, table } from "../dom.js";
import { fixed } from "../format.js";
import { letters } from "./palette.js";

const KINDS = ["slew", "wait", "settle", "dwell", "cone", "limit"];
/** What stands in bars that have no number of a target; violations of several wheels may cover each other. */
const TEXTS = { wait: "", cone: "in", limit: "" };
/** What a character takes in a bar, px; a bar without room for its text has none. */
const CHARACTER = 8;

/** The lanes of a flight, which can be zoomed and show a moment; `look` is asked for a phase. */
export function lanes(flight, look) {
  const { total } = flight;
  const phases = [...flight.phases, ...flight.alarms];
  const used = KINDS.filter((kind) => kind === "slew" || phases.some((phase) => phase.kind === kind));
  const bars = phases.map((phase) => ({ phase, node: bar(phase, look) }));
  const windows = flight.windows.map((phase) => ({ phase, node: el("div", { class: "lane-window", title: `window of ${spanText(phase)}` }) }));
  const marker = el("div", { class: "lane-marker" });
  const tracks = used.map((kind) => el("div", { class: "track" },
    bars.filter(({ phase }) => phase.kind === kind).map(({ node }) => node)));
  const field = el("div", { class: "lane-field" }, windows.map(({ node }) => node), tracks, marker);
  const node = el("div", { class: "chart lanes" },
    el("div", { class: "chart-head" }, el("h3", {}, "Phases")),
    el("div", { class: "lane-rows" },
      el("div", { class: "lane-names", "aria-hidden": "true" }, used.map((kind) => el("span", {}, kind))), field));
  const data = disclosure("Phases as a table", () => asTable(phases));

  let [from, to, now] = [0, total, 0];
  const at = (time) => (100 * (time - from)) / (to - from);
  const show = (time) => {
    now = time;
    const place = at(time);
    marker.hidden = place < 0 || place > 100;
    marker.style.left = `${place}%`;
  };
  const renew = () => {
    const width = field.clientWidth;
    for (const { phase, node } of [...windows, ...bars]) {
      const [begin, end] = [at(phase.begin), at(phase.end)];
      node.style.left = `${begin}%`;
      node.style.width = `max(2px, ${end - begin}% - 1px)`;
      node.hidden = end < 0 || begin > 100;
    }
    for (const { phase, node } of bars) {
      const [begin, end] = [at(phase.begin), at(phase.end)];
      const text = node.firstChild;
      text.hidden = text.textContent === "" || ((end - begin) * width) / 100 < CHARACTER * letters() * (text.textContent.length + 1);
    }
    show(now);
  };
  new ResizeObserver(renew).observe(field);
  return { node, data, show, zoom: (begin, end) => { [from, to] = [begin, end]; renew(); } };
}

const spanText = ({ name, begin, end }) => `${name}: ${fixed(begin, 1)} to ${fixed(end, 1)} s`;

function bar(phase, look) {
  const text = TEXTS[phase.kind] ?? (phase.number ? String(phase.number) : "end");
  const title = spanText(phase);
  const room = 0.15 * (phase.end - phase.begin);
  return el("div", {
    class: `bar ${phase.kind}`, title,
    ondblclick: () => look(Math.max(0, phase.begin - room), phase.end + room),
  }, el("span", {}, text));
}

function asTable(phases) {
  const columns = [
    { title: "Phase", head: true }, { title: "Begin, s", number: true },
    { title: "End, s", number: true }, { title: "Duration, s", number: true },
  ];
  return table("Phases of the flight", columns, phases.map((phase) =>
    [phase.name, fixed(phase.begin), fixed(phase.end), fixed(phase.end - phase.begin)]));
}
