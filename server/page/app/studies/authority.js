// Shares of torque and wheel speed: what plans with them take, and how well they are flown.

import { messages } from "../checks.js";
import { disclosure, el, section, table } from "../dom.js";
import { fixed, percent, significant } from "../format.js";
import { pictureButtons } from "../picture/save.js";
import { assumptions } from "./assumptions.js";
import { curveChart } from "../plots/curves.js";

const DEGREES = 180 / Math.PI;
const ERRORS = [["p50", "half of the flights"], ["p90", "90 %"], ["p99", "99 %"], ["max", "all"]];

/** The same shares of the flights for what should be large. */
const LEAST = [["p50", "half of the flights"], ["p10", "90 %"], ["p1", "99 %"], ["min", "all"]];
const APPLIES = { always: "always", at_targets: "at targets", report: "reported only" };

/** The nodes of an answer. */
export function authority({ document, request }, signal) {
  const { rows, complete } = document;
  const flown = rows.filter((row) => row.flights);
  return [
    assumptions(request),
    complete ? null : el("p", { class: "cut-short" }, "Time ran out: not every plan was flown as often as asked for."),
    flown.length > 1 ? charts(flown, signal) : null,
    section("Plans and flights", { class: "wide" }, summary(rows), rows.map(reasons)),
    flown.length ? section("Errors at the end of the flight", { class: "wide" }, errors(flown),
      flown.map((row) => disclosure(`Targets and wheels at ${shares(row)}`, () => details(row)))) : null,
  ];
}

const share = (value) => `${significant(100 * value)} %`;
const shares = (row) => `${share(row.torque_authority)} torque, ${share(row.momentum_authority)} speed`;

/** An angle in degrees, where it is large enough with the digits of the others. */
function degrees(radians) {
  const value = DEGREES * radians;
  return value < 1e-3 ? significant(value, 3) : fixed(value, 4);
}

/** What the rows differ in, as the values of an axis. */
function axis(rows) {
  const torque = rows.map((row) => row.torque_authority);
  const momentum = rows.map((row) => row.momentum_authority);
  const varies = (values) => values.some((value) => value !== values[0]);
  const same = torque.every((value, index) => value === momentum[index]);
  if (same) return { title: "Share of torque and wheel speed", unit: "", values: torque };
  if (!varies(momentum)) return { title: "Share of torque", unit: "", values: torque };
  if (!varies(torque)) return { title: "Share of wheel speed", unit: "", values: momentum };
  return { title: "Row", unit: "", values: rows.map((_, index) => index + 1) };
}

/** The share of flights that stay clear of all enforced cones, where there are any. */
function clearCurve(rows) {
  if (!rows.every((row) => row.flights.share_clear !== null)) return [];
  return [{ name: "clear of all cones", values: rows.map((row) => 100 * row.flights.share_clear), colour: 3 }];
}

function charts(rows, signal) {
  const against = axis(rows);
  const tolerance = DEGREES * rows[0].flights.tolerance_rad;
  const within = (name) => rows.map((row) => 100 * row.flights[name]);
  const list = [
    curveChart({
      title: "Flights within the tolerance", unit: "%", against, from: 0,
      curves: [
        { name: "at the end", values: within("share_within"), colour: 1 },
        { name: "at every arrival", values: within("share_within_at_passages"), colour: 2 },
        ...clearCurve(rows),
      ],
    }, signal),
    curveChart({
      title: "Attitude error at the end", unit: "°", against,
      curves: ERRORS.map(([which, name], index) => ({
        name, colour: index + 1, values: rows.map((row) => DEGREES * row.flights.end_attitude_rad[which]),
      })),
      limit: { name: "tolerance", value: tolerance },
    }, signal),
    curveChart({
      title: "Duration of the plan", unit: "s", against,
      curves: [{ name: "duration", values: rows.map((row) => row.total_time_s), colour: 1 }],
    }, signal),
  ];
  return section("Curves", { class: "wide", head: el("div", { class: "tools" }, pictureButtons("authority curves")) }, el("div", { class: "curves" }, list.map((chart) => chart.node)),
    el("p", { class: "quiet" }, `Within ${significant(tolerance)}°. Errors are those that so many flights do not exceed.`));
}

function summary(rows) {
  const columns = [
    { title: "Torque", number: true }, { title: "Wheel speed", number: true }, { title: "Duration, s", number: true },
    { title: "Within at the end", number: true }, { title: "Within at every arrival", number: true },
    { title: "Clear of all cones", number: true }, { title: "Flights", number: true }, { title: "Plan" }, { title: "Order" },
  ];
  return table("Plans and flights for every pair of shares", columns, rows.map((row) => [
    share(row.torque_authority), share(row.momentum_authority), fixed(row.total_time_s),
    percent(row.flights?.share_within, 1), percent(row.flights?.share_within_at_passages, 1),
    percent(row.flights?.share_clear, 1),
    row.flights ? flights(row.flights) : "–",
    { flown: row.plan_status, no_plan: "no plan", stopped: "not reached" }[row.status], row.sequence.join(" "),
  ]));
}

function flights({ runs, runs_asked: asked }) {
  return runs === asked ? String(runs) : `${runs} of ${asked}`;
}

function reasons(row) {
  return messages(`Why there is no plan with ${shares(row)}`, row.reasons);
}

function errors(rows) {
  const columns = [
    { title: "Torque", number: true }, { title: "Wheel speed", number: true },
    ...ERRORS.map(([, name]) => ({ title: `${name}, °`, number: true })),
    { title: "Largest on the way, °", number: true }, { title: "Rate, all, °/s", number: true },
  ];
  return table("Attitude errors that so many flights do not exceed", columns, rows.map(({ flights, ...row }) => [
    share(row.torque_authority), share(row.momentum_authority),
    ...ERRORS.map(([which]) => degrees(flights.end_attitude_rad[which])),
    degrees(flights.peak_attitude_rad.max), degrees(flights.end_rate_rad_s.max),
  ]));
}

/** Errors at the arrivals of one row, and how long its wheels are at their limits. */
function details(row) {
  const arrivals = [
    { title: "Target", head: true }, { title: "Arrival, s", number: true },
    ...ERRORS.map(([, name]) => ({ title: `${name}, °`, number: true })),
  ];
  const wheels = [
    { title: "Wheel", head: true }, { title: "At the torque limit, mean", number: true }, { title: "largest", number: true },
    { title: "At the speed limit, mean", number: true }, { title: "largest", number: true },
  ];
  const { passages, saturation, keep_out_clearance_deg: cones } = row.flights;
  return el("div", {},
    table(`Attitude errors at the arrivals, ${shares(row)}`, arrivals, passages.map((one) => [
      one.target, fixed(one.time_s), ...ERRORS.map(([which]) => degrees(one.attitude_rad[which])),
    ])),
    table(`Share of the time at limits, ${shares(row)}`, wheels, saturation.map((one, index) => [
      String(index), ...[one.torque_mean, one.torque_max, one.speed_mean, one.speed_max].map((value) => percent(value, 1)),
    ])),
    cones.length ? clearances(cones, row) : null);
}

/** How close the flights of one row come to cones. */
function clearances(cones, row) {
  const columns = [
    { title: "Cone", head: true }, { title: "Applies" }, { title: "Clear", number: true },
    ...LEAST.map(([, name]) => ({ title: `${name}, °`, number: true })),
  ];
  return table(`Clearance of cones that so many flights keep, ${shares(row)}`, columns, cones.map((one) => [
    `${one.boresight} from ${one.cone}`, APPLIES[one.applies], percent(one.share_clear, 1),
    ...LEAST.map(([which]) => fixed(one.clearance_deg[which], 2)),
  ]));
}
