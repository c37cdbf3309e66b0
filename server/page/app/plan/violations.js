// What a motion violates, above everything else: every failure of its verification, and cones that are
// only reported.

import { el, section } from "../dom.js";
import { item } from "../failure.js";
import { fixed } from "../format.js";
import { VIOLATED, intrusionsOf, isKeepOut } from "./keep-out.js";

/** What is said beside a plan that does not pass its verification. */
const UNVERIFIED = "limits violated";

/** Begins of the sentences of the checker, and what they are about. */
const KINDS = [
  [/^the torque on wheel/, "Wheel torque"], [/^the speed of wheel/, "Wheel speed"], [/^the body rate/, "Body rate"],
  [/^\/keep_(out|in)/, "Cone"], [/^(target|the passage)/, "Target"], [/^the (end|flight goes on)/, "End"],
  [/^(control|the controls|the total time)/, "Commands"], [/^the integration/, "Integration"],
];
/** Excesses up to this are rounding of the samples. */
const ROUNDING = 1e-6;

const kindOf = (sentence) => KINDS.find(([begin]) => begin.test(sentence))?.[1] ?? "Verification";
/** The moment that a sentence names: the first one of several; null without any. */
const momentOf = (sentence) => {
  const [, time] = /(?:at|degrees:) ([\d.]+(?:e-?\d+)?) s\b/.exec(sentence) ?? [];
  return time ? Number(time) : null;
};

/** The failures of a motion {failures, warnings, margins}, as {kind, text, time}. */
export const failuresOf = ({ failures = [] }) => failures.map((text) => ({ kind: kindOf(text), text, time: momentOf(text) }));

/** What is wrong with a motion in a word; null for nothing. */
export function doubtOf(motion) {
  if (motion.failures?.length) return UNVERIFIED;
  return intrusionsOf(motion).length ? VIOLATED : null;
}

/** A plan as what the functions here take. */
export const checkedPlan = (plan) => ({ failures: plan.verification?.failures, warnings: plan.warnings, margins: plan.margins });

/** The sections of what is violated; `cursor` is moved to the moments. */
export function banners(motion, scenario, cursor) {
  const failures = failuresOf(motion);
  const cones = (motion.warnings ?? []).filter(isKeepOut);
  return [
    failures.length ? section("Limits violated", { class: "alarm serious" },
      el("ul", { class: "problems" }, failures.map(({ kind, text, time }) => el("li", {},
        el("span", {}, el("strong", {}, kind), " ", showAt(time, cursor)), el("span", {}, text))))) : null,
    cones.length ? section("Keep-out violated", { class: "alarm" },
      el("ul", { class: "problems" }, cones.map((warning) => item(warning, null, scenario)))) : null,
  ].filter(Boolean);
}

function showAt(time, cursor) {
  if (time === null || !cursor) return null;
  return el("button", { type: "button", class: "pointer", onclick: () => cursor.set(time) }, `show ${fixed(time, 1)} s`);
}

/** The spans of time beyond the limits of rates, speeds and torques (`of`), as far as the samples of a flight show them. */
export function excessAlarms({ times, rates, speeds, torques, limits }) {
  const groups = [
    ["rates", rates, times, (index) => `body rate ${"xyz"[index]}`],
    ["speeds", speeds, times, (index) => `speed of wheel ${index}`],
    ["torques", torques.curves, torques.times, (index) => `torque of wheel ${index}`],
  ];
  return groups.flatMap(([of, curves, moments, name]) => curves.flatMap((curve, index) => {
    const bounds = limits[of][index];
    const found = bounds ? spans(curve, bounds, moments) : [];
    return found.map(([begin, end]) => ({ begin, end, kind: "limit", of, name: `${name(index)} beyond its limit` }));
  }));
}

function spans(values, [low, high], times) {
  const room = ROUNDING * Math.max(Math.abs(low), Math.abs(high));
  const found = [];
  let begin = null;
  values.forEach((value, index) => {
    const isBeyond = value < low - room || value > high + room;
    if (isBeyond && begin === null) begin = times[index];
    if (!isBeyond && begin !== null) {
      found.push([begin, times[index]]);
      begin = null;
    }
  });
  return begin === null ? found : [...found, [begin, times.at(-1)]];
}
