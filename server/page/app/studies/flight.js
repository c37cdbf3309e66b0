// One flight in closed loop: errors over time, the motion that comes of it, and where wheels meet limits.

import { Cursor } from "../cursor.js";
import { el, section, table } from "../dom.js";
import { item } from "../failure.js";
import { motion } from "../flight.js";
import { flown } from "../flown.js";
import { fixed, percent, seconds, significant } from "../format.js";
import { strip } from "../strip.js";
import { assumptions } from "./assumptions.js";

/** Units of angles, the largest first, in which an error has something before its point. */
const UNITS = [["°", 180 / Math.PI], ["″", (3600 * 180) / Math.PI], ["mas", (3.6e6 * 180) / Math.PI]];
const LEAST = 0.01;
/** Errors beyond this, rad or rad/s, are drawn as this: the flight has failed. */
const LOST = 1e3;
const REST_S = 1e-9;

/** The nodes of an answer. */
export function flight({ document, request }, signal) {
  const found = document.flight;
  if (!found) {
    const why = document.reasons.length ? el("ul", { class: "problems" }, document.reasons.map((reason) => item(reason, null, request.scenario)))
      : el("p", {}, "Time ran out before there was a plan to fly.");
    return section("No flight", { class: "card" }, why);
  }
  const cursor = new Cursor();
  const shown = simulated(found, request.scenario);
  return [
    assumptions(request),
    figures(found),
    flown(shown, cursor, signal, errorGroups(found)),
    el("div", { class: "cards" }, arrivals(found), wheels(found)),
    clearances(found),
  ];
}

const unitOf = (radians) => UNITS.find(([, factor]) => radians * factor >= LEAST) ?? UNITS.at(-1);

/** An angle in the unit in which it can be read. */
export function angle(radians) {
  const [unit, factor] = unitOf(Math.min(radians, LOST));
  return `${significant(Math.min(radians, LOST) * factor)}${/\w/.test(unit) ? " " : ""}${unit}`;
}

function figures(found) {
  return strip([
    ["Error at the end", angle(found.end.attitude_rad), found.within_tolerance ? `within ${angle(found.tolerance_rad)}` : `not within ${angle(found.tolerance_rad)}`],
    ["Largest error", angle(found.peak.attitude_rad), "at any moment, against the plan"],
    ["Flight", seconds(found.flight_time_s), found.flight_time_s > found.total_time_s ? `the plan takes ${seconds(found.total_time_s)}` : null],
    ["Computer", `every ${significant(1000 * found.sample_period_s)} ms`, found.keep_every > 1 ? `one of ${found.keep_every} samples is shown` : null],
  ]);
}

/** The flight as the plots take it. */
function simulated(found, scenario) {
  const { samples } = found;
  const moved = motion(samples, scenario, { margins: { keep_out_clearance_deg: found.keep_out_clearance_deg } });
  const stops = found.passages.map((passage, index) => ({
    number: index + 1, name: passage.target, time: passage.time_s, departure: passage.departure_s,
    attitude: moved.attitudeAt(passage.time_s), roll: null, pointed: null,
  }));
  return {
    ...moved,
    total: found.flight_time_s,
    torques: { times: moved.times, curves: scenario.spacecraft.wheels.map((_, wheel) => samples.map((one) => one.wheel_torque_nm[wheel])), steps: true },
    stops,
    phases: phases(stops, found),
    alarms: [...limited(samples, found.flight_time_s, "torque"), ...limited(samples, found.flight_time_s, "speed")],
  };
}

/** Slews with the rests at targets, and the time to settle after the plan. */
function phases(stops, { total_time_s: planned, flight_time_s: total }) {
  const parts = [];
  let begin = 0;
  let from = "start";
  for (const { name, number, time, departure } of stops) {
    parts.push({ kind: "slew", name: `${from} → ${name}`, label: name, number, begin, end: time });
    if (departure - time > REST_S) parts.push({ kind: "dwell", name: `rest at ${name}`, label: name, number, begin: time, end: departure });
    [begin, from] = [departure, name];
  }
  if (planned - begin > REST_S) parts.push({ kind: "slew", name: `${from} → end`, label: "end", begin, end: planned });
  if (total - planned > REST_S) parts.push({ kind: "settle", name: "settle after the plan", label: "end", begin: planned, end: total });
  return parts;
}

/** The spans in which some wheel is at its limit of torque or speed. */
function limited(samples, end, kind) {
  const spans = [];
  samples.forEach((sample, index) => {
    const wheels = sample[`${kind}_limited`].flatMap((isLimited, wheel) => (isLimited ? [wheel] : []));
    if (!wheels.length) return;
    const until = samples[index + 1]?.time_s ?? end;
    const last = spans.at(-1);
    if (last && last.end === sample.time_s) {
      last.end = until;
      wheels.forEach((wheel) => last.wheels.add(wheel));
    } else spans.push({ begin: sample.time_s, end: until, wheels: new Set(wheels) });
  });
  return spans.map(({ begin, end: until, wheels }) => ({
    kind: "limit", of: `${kind}s`, begin, end: until, name: `${kind} limit met by wheel ${[...wheels].sort((a, b) => a - b).join(", ")}`,
  }));
}

function errorGroups({ samples, peak }) {
  const times = samples.map((sample) => sample.time_s);
  const group = (title, figure, per) => {
    const [unit, factor] = unitOf(peak[figure]);
    const values = samples.map((sample) => factor * Math.min(LOST, sample.error[figure]));
    return {
      title, unit: unit + per, names: ["against the plan"], times, curves: [values], limits: [null],
      text: (value) => fixed(value, 3),
      data: () => table(title, [{ title: "Time, s", number: true }, { title: `${title}, ${unit}${per}`, number: true }],
        values.map((value, index) => [fixed(times[index], 2), significant(value)])),
    };
  };
  return [group("Attitude error", "attitude_rad", ""), group("Rate error", "rate_rad_s", "/s")];
}

function arrivals({ passages, end, within_tolerance: isWithin }) {
  const columns = [{ title: "Place", head: true }, { title: "Time, s", number: true }, { title: "Attitude error", number: true }, { title: "Rate error", number: true }];
  const row = (name, time, error) => [name, fixed(time), angle(error.attitude_rad), `${angle(error.rate_rad_s)}/s`];
  const word = el("span", { class: `chip ${isWithin ? "good" : "bad"}` }, isWithin ? "Within the tolerance" : "Not within the tolerance");
  return section("Errors at the arrivals", { head: word, class: "card" },
    table("Errors at every arrival and at the end", columns, [...passages.map((one) => row(one.target, one.time_s, one.error)), row("end", null, end)]));
}

function wheels({ saturation }) {
  const columns = [{ title: "Wheel", head: true }, { title: "At the torque limit", number: true }, { title: "At the speed limit", number: true }];
  return section("Wheels at their limits", { class: "card" },
    table("Shares of the time at limits", columns, saturation.map((one, index) => [String(index), percent(one.torque, 1), percent(one.speed, 1)])),
    el("p", { class: "quiet" }, "The times at a limit are marked red on the timelines."));
}

function clearances({ keep_out_clearance_deg: cones }) {
  if (!cones.length) return null;
  const columns = [{ title: "Cone", head: true }, { title: "Closest, °", number: true }, { title: "At, s", number: true }];
  return section("Clearance of cones", { class: "wide" }, table("Closest approach to every cone", columns, cones.map((one) =>
    [`${one.boresight} from ${one.cone}`, fixed(one.clearance_deg, 2), fixed(one.time_s, 1)])));
}
