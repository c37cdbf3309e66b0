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
  const wheels = (intervals[0]?.switching_begin ?? []).map((_, wheel) => wheel);
  return [
    {
      title: "Hamiltonian", unit: "", names: ["mean", "lowest", "highest"], times,
      curves: [twice("hamiltonian_mean"), twice("hamiltonian_min"), twice("hamiltonian_max")],
      limits: [], least: LEAST * scale, text: small, data: () => hamiltonian(intervals),
    },
    {
      title: "Switching functions", unit: "", names: wheels.map((wheel) => `wheel ${wheel}`), times,
      curves: wheels.map((wheel) => intervals.flatMap((interval) =>
        [interval.switching_begin[wheel], interval.switching_end[wheel]])),
      limits: [], text: (value) => fixed(value, 3), data: () => switching(intervals, wheels),
    },
  ];
}

const INTERVAL = [{ title: "Begin, s", number: true }, { title: "End, s", number: true }];
const interval = ({ start_s, duration_s }) => [fixed(start_s, 3), fixed(start_s + duration_s, 3)];

function hamiltonian(intervals) {
  const columns = [...INTERVAL, ...["Mean", "Lowest", "Highest"].map((title) => ({ title, number: true }))];
  return table("Hamiltonian on the intervals", columns, intervals.map((one) => [...interval(one),
    ...[one.hamiltonian_mean, one.hamiltonian_min, one.hamiltonian_max].map(small)]));
}

function switching(intervals, wheels) {
  const titles = wheels.flatMap((wheel) => [`Wheel ${wheel}, begin`, `Wheel ${wheel}, end`]);
  return table("Switching functions on the intervals", [...INTERVAL, ...titles.map((title) => ({ title, number: true }))],
    intervals.map((one) => [...interval(one),
      ...wheels.flatMap((wheel) => [one.switching_begin[wheel], one.switching_end[wheel]].map((value) => fixed(value, 4)))]));
}

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
    ["what other torques could lower it by", small(evidence.principle_gap), "0"],
    ["jumps of the momentum costate", small(evidence.costate_defect), "0"],
    ["slack times multiplier of a limit", small(evidence.complementarity), "0"],
    ["switching functions with the sign asked for", percent(evidence.switching_agreement, 1), "100 %"],
  ];
  return section("Optimality", { class: "card" },
    table("Conditions of the minimum principle", columns, rows),
    el("p", { class: "quiet" }, `Differences of the Hamiltonian are shares of its scale, ${significant(evidence.scale)}. `,
      "Where a torque is at its lower limit its switching function is positive, at its upper limit negative."));
}
