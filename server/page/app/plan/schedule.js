// Windows and visits of all targets on one axis of time: those that are visited in their order, then the
// others.

import { el, section, table } from "../dom.js";
import { fixed } from "../format.js";
import { pictureButtons } from "../picture/save.js";
import { settings } from "../settings.js";
import { clockOf, shownClock } from "../units.js";
import { windowsByTarget } from "../windows.js";

/** Windows that a row names; the rest are counted. */
const MOST_NAMED = 3;
const MOST_ROWS = 1000;
/** Marks of the axis, about. */
const MARKS = 6;
const STEPS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200, 86_400];

/** The section of a scenario with windows; null for one without. */
export function schedule(plan, scenario, flight, cursor, signal) {
  const windows = windowsByTarget(scenario);
  if (![...windows.values()].some((list) => list.length)) return null;
  const clock = clockOf(scenario);
  const horizon = Math.max(flight.total, scenario.latest_end_s ?? 0);
  const place = el("div", {});
  const marker = [];
  const draw = () => {
    marker.length = 0;
    place.replaceChildren(rowsOf(flight, windows, { clock: shownClock(clock), horizon, marker }));
    show(cursor.time ?? 0);
  };
  const show = (time) => marker.forEach((node) => (node.style.left = `${(100 * time) / horizon}%`));
  cursor.listen(show, signal);
  settings.listen(draw, signal);
  draw();
  return section("Windows and visits", { class: "wide schedule", head: el("div", { class: "tools" }, pictureButtons("windows", () => scenario.name)) }, place);
}

function rowsOf(flight, windows, { clock, horizon, marker }) {
  const moment = (time) => (clock ? clock.time(time, 0) : fixed(time, 1));
  const span = ({ begin, end }) => `${moment(begin)}\u2013${moment(end)}`;
  const visited = new Map(flight.stops.map((stop) => [stop.name, { begin: stop.time, end: stop.departure }]));
  const names = [...visited.keys(), ...[...windows.keys()].filter((name) => !visited.has(name))];
  const share = (time) => (100 * Math.min(Math.max(time, 0), horizon)) / horizon;
  const bar = (kind, { begin, end }) => {
    const node = el("span", { class: kind });
    node.style.left = `${share(begin)}%`;
    node.style.width = `max(2px, ${share(end) - share(begin)}%)`;
    return node;
  };
  const inSight = ({ begin, end }) => end > 0 && begin < horizon;
  const rows = names.slice(0, MOST_ROWS).map((name) => {
    const [visit, own] = [visited.get(name), windows.get(name) ?? []];
    const now = el("span", { class: "now" });
    marker.push(now);
    const more = own.length - MOST_NAMED;
    return [
      name,
      visit ? span(visit) : "left out",
      [...own.slice(0, MOST_NAMED).map(span), ...more > 0 ? [`and ${more} more`] : []].join(", ") || "any time",
      el("div", { class: "when", "aria-hidden": "true" }, own.filter(inSight).map((one) => bar("window", one)), visit ? bar("visit", visit) : null, now),
    ];
  });
  const unit = clock ? clock.name : "s";
  const columns = [{ title: "Target", head: true }, { title: `Visit, ${unit}`, number: true }, { title: `Windows, ${unit}` }, { title: axis(horizon, clock) }];
  return el("div", {}, table("Windows and visits of the targets", columns, rows),
    names.length > MOST_ROWS ? el("p", { class: "quiet" }, `${names.length - MOST_ROWS} more targets are in the plan.`) : null);
}

/** Marks at round times over the bars. */
function axis(horizon, clock) {
  const step = STEPS.find((one) => horizon / one <= MARKS) ?? 10 ** Math.ceil(Math.log10(horizon / MARKS));
  const first = clock ? Math.ceil(clock.offset / step) * step - clock.offset : 0;
  const times = Array.from({ length: Math.max(0, Math.floor((horizon - first) / step) + 1) }, (_, index) => first + index * step);
  const marks = times.map((time) => {
    const node = el("span", {}, clock ? clock.time(time, 0) : fixed(time, 0));
    node.style.left = `${(100 * time) / horizon}%`;
    return node;
  });
  return el("span", {}, el("span", { class: "unseen" }, "As bars"), el("span", { class: "when-axis", "aria-hidden": "true" }, marks));
}
