// What two plans have in common and differ in: figures, tracks on one moment, phases and the times at targets.

import { Cursor } from "../cursor.js";
import { el, section, table } from "../dom.js";
import { flightOf } from "../flight.js";
import { fixed, percent, signed, significant } from "../format.js";
import { playback } from "../playback.js";
import { saving } from "../plan/facts.js";
import { sphere } from "../sphere/sphere.js";
import { visits } from "./visits.js";
import { tracks } from "./tracks.js";

const SIDES = ["first", "second"];

/** The nodes of two plans, each {job, plan, scenario}. */
export function compared(sides, signal) {
  const flights = sides.map(({ plan, scenario }) => flightOf(plan, scenario));
  const without = sides.filter((_, index) => !flights[index]);
  const names = namesOf(sides);
  if (without.length) {
    return [el("p", { class: "cut-short" }, `There is no flight of ${without.map(({ job }) => job.name ?? "unnamed").join(" and ")}.`)];
  }
  const cursor = new Cursor();
  const total = Math.max(...flights.map((flight) => flight.total));
  // The longer flight tells how long there is something to see; the other one stays at its end.
  const longer = flights.find((flight) => flight.total === total);
  const player = playback({ ...longer, total, stops: flights.flatMap(({ stops }) => stops).sort((a, b) => a.time - b.time) }, cursor, signal);
  requestAnimationFrame(() => !signal.aborted && cursor.set(0));
  return [
    figures(sides, names),
    el("div", { class: "flown" }, player.node,
      el("div", { class: "flight" }, flights.map((flight, index) =>
        el("div", { class: "pictures" }, sphere(flight, cursor, signal, { title: `Sky, ${SIDES[index]} plan`, id: `body-axis-${index}` })))),
      tracks(flights, names, total, cursor, signal)),
    visits(flights),
  ];
}

const capital = (word) => word[0].toUpperCase() + word.slice(1);

/** Names that tell the plans apart. */
function namesOf(sides) {
  const names = sides.map(({ job }) => job.name ?? "unnamed");
  return names[0] === names[1] ? names.map((name, index) => `${name} (${SIDES[index]})`) : names;
}

/** Figures of a plan: name, value, how it is written, and whether a difference says something. */
const FIGURES = [
  ["Value", (plan) => plan.value, significant],
  ["Total time, s", (plan) => plan.total_time_s, fixed],
  ["Lower bound, s", (plan) => plan.lower_bound_s, fixed],
  ["Proved bound, s", (plan) => plan.certified_lower_bound_s, fixed],
  ["Gap", (plan) => plan.relative_gap, percent],
  ["Saved, s", saving, fixed],
  ["Targets", (plan) => plan.sequence.length, (value) => fixed(value, 0)],
  ["Torque left", (plan) => plan.margins?.torque, percent],
  ["Wheel speed left", (plan) => plan.margins?.wheel_speed, percent],
  ["Body rate left", (plan) => plan.margins?.body_rate, percent],
];

function figures(sides, names) {
  const columns = [{ title: "Figure", head: true }, ...SIDES.map((side) => ({ title: capital(side), number: true })), { title: "Difference", number: true }];
  const rows = FIGURES.map(([name, of, text]) => {
    const values = sides.map(({ plan }) => of(plan) ?? null);
    if (values.every((value) => value === null)) return null;
    const known = values.every((value) => value !== null);
    return [name, ...values.map((value) => text(value)), known ? signed(text(values[1] - values[0])) : "–"];
  }).filter(Boolean);
  const links = sides.map(({ job }, index) => el("a", { href: `#/plans/${job.id}` }, names[index]));
  return section("Figures", { class: "card", head: el("div", { class: "tools" }, "First", links[0], "Second", links[1]) },
    table("Figures of both plans", columns, rows));
}
