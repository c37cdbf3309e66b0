// Where targets stand in two plans, and when they are reached.

import { el, section, table } from "../dom.js";
import { count, fixed, signed } from "../format.js";

/** The section with a row for every target of either plan. */
export function visits(flights) {
  const [first, second] = flights.map(({ stops }) => new Map(stops.map((stop) => [stop.name, stop])));
  const targets = [...first.keys(), ...[...second.keys()].filter((name) => !first.has(name))];
  const columns = [
    { title: "Target", head: true },
    { title: "First", number: true }, { title: "Arrival, s", number: true },
    { title: "Second", number: true }, { title: "Arrival, s", number: true }, { title: "Later by, s", number: true },
  ];
  const isInBoth = (name) => first.has(name) && second.has(name);
  const moved = targets.filter((name) => isInBoth(name) && first.get(name).number !== second.get(name).number).length;
  const alone = targets.filter((name) => !isInBoth(name)).length;
  const rows = targets.map((name) => {
    const [one, other] = [first.get(name), second.get(name)];
    const place = (stop) => (stop ? String(stop.number) : "–");
    const differs = one && other && one.number !== other.number;
    return [
      name, place(one), fixed(one?.time), differs ? el("strong", {}, place(other)) : place(other), fixed(other?.time),
      one && other ? signed(fixed(other.time - one.time)) : "–",
    ];
  });
  return section("Order and times", { class: "wide" },
    table("Places and arrivals of the targets in both plans", columns, rows),
    el("p", { class: "quiet" }, [
      moved ? `${moved} of ${targets.length} targets have another place in the second plan; those places are bold.` : "",
      alone ? `${count(alone, "target")} of ${targets.length} in one plan only.` : "",
      moved || alone ? "" : "Both plans have the same order.",
    ].filter(Boolean).join(" ")));
}
