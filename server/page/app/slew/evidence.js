// The conditions of the minimum principle along a slew: curves and figures.

import { el, section, table } from "../dom.js";
import { fixed, percent, significant, small } from "../format.js";
import { ends } from "./flight.js";

/** Share of its scale that the plot of the Hamiltonian spans at least: less is rounding. */
const LEAST = 0.01;

/** Groups of curves for the timelines: Hamiltonian and switching functions. */
export function evidenceGroups(evidence) {
  if (!evidence) return [];
  const { intervals, scale } = evidence;
  const times = ends(intervals);
  const twice = (name) => intervals.flatMap((interval) => [interval[name], interval[name]]);
  const names = controlNames(evidence);
  return [
    {
      title: "Hamiltonian", unit: "", times,
      names: ["mean", "lowest", "highest", ...drifts(evidence) ? ["of time"] : []],
      curves: [twice("hamiltonian_mean"), twice("hamiltonian_min"), twice("hamiltonian_max"),
        ...drifts(evidence) ? [intervals.flatMap((one) => [one.time_costate_begin, one.time_costate_end])] : []],
      limits: [], least: LEAST * scale, text: small, data: () => hamiltonian(intervals),
    },
    {
      title: "Switching functions", unit: "", names, times,
      curves: names.map((_, control) => intervals.flatMap((interval) =>
        [interval.switching_begin[control], interval.switching_end[control]])),
      limits: [], text: (value) => fixed(value, 3), data: () => switching(intervals, names),
    },
  ];
}

/** What the switching functions belong to: wheels, or the axes of the torque that is shared out. */
function controlNames({ controls, intervals }) {
  const count = intervals[0]?.switching_begin.length ?? 0;
  return Array.from({ length: count }, (_, control) => (controls === "body_axes" ? `axis ${"xyz"[control]}` : `wheel ${control}`));
}

/** Whether the Hamiltonian alone changes along the slew. */
const drifts = ({ intervals }) => intervals.some((one) => one.time_costate_begin !== 0);

const INTERVAL = [{ title: "Begin, s", number: true }, { title: "End, s", number: true }];
const interval = ({ start_s, duration_s }) => [fixed(start_s, 3), fixed(start_s + duration_s, 3)];

function hamiltonian(intervals) {
  const columns = [...INTERVAL, ...["Mean", "Lowest", "Highest"].map((title) => ({ title, number: true }))];
  return table("Hamiltonian on the intervals", columns, intervals.map((one) => [...interval(one),
    ...[one.hamiltonian_mean, one.hamiltonian_min, one.hamiltonian_max].map(small)]));
}

function switching(intervals, names) {
  const titles = names.flatMap((name) => [`${capital(name)}, begin`, `${capital(name)}, end`]);
  return table("Switching functions on the intervals", [...INTERVAL, ...titles.map((title) => ({ title, number: true }))],
    intervals.map((one) => [...interval(one),
      ...names.flatMap((_, control) => [one.switching_begin[control], one.switching_end[control]].map((value) => fixed(value, 4)))]));
}

const capital = (name) => name[0].toUpperCase() + name.slice(1);

/** The section with the figures of a slew; null without evidence. */
export function optimality({ evidence }, request) {
  if (!evidence) return null;
  // With a duration that may be chosen the Hamiltonian is zero, otherwise constant.
  const free = request.objective?.kind !== "energy" && request.command?.kind !== "sampled";
  const columns = [{ title: "Condition", head: true }, { title: "Found", number: true }, { title: "At a minimum", number: true }];
  const rows = [
    ["Hamiltonian, mean", small(evidence.hamiltonian), free ? "0" : "any"],
    ["its spread between averages of intervals", small(evidence.average_spread), "0"],
    ["its spread between moments", small(evidence.pointwise_spread), "0"],
    ...drifts(evidence) ? [["of the Hamiltonian without the costate of time", small(evidence.variation), "any"]] : [],
    ["what other torques could lower it by", small(evidence.principle_gap), "0"],
    ["jumps of the momentum costate", small(evidence.costate_defect), "0"],
    ["slack times multiplier of a limit", small(evidence.complementarity), "0"],
    ["switching functions with the sign asked for", percent(evidence.switching_agreement, 1), "100 %"],
  ];
  return section("Optimality", { class: "card" },
    table("Conditions of the minimum principle", columns, rows),
    el("p", { class: "quiet" }, `Differences of the Hamiltonian are shares of its scale, ${significant(evidence.scale)}. `,
      evidence.controls === "body_axes"
        ? "The switching function is that of the torque on all wheels together, which the pseudo-inverse shares out: "
          + "it is a sum of the normals of the limits that wheels are at, turned inwards."
        : "Where a torque is at its lower limit its switching function is positive, at its upper limit negative.",
      drifts(evidence) ? " The speed laws move wheels, so that the Hamiltonian is constant with the costate of time only." : ""));
}
