// Keep-out cones that a plan enters, and attitudes that are in one from the beginning.

import { el, section } from "../dom.js";
import { item } from "../failure.js";

/** What is said beside a plan that is good otherwise. */
export const VIOLATED = "keep-out violated";

const CODES = ["keep_out_violated", "attitude_in_keep_out"];

/** Whether a warning is about a keep-out cone. */
export const isKeepOut = (warning) => CODES.includes(warning.code);

/** Every stay of a boresight inside a cone. */
export function intrusionsOf(plan) {
  return plan.margins?.keep_out_intrusions ?? [];
}

/** The warnings about cones with what to do about them, before anything else; null without any. */
export function banner(plan, scenario) {
  const list = (plan.warnings ?? []).filter(isKeepOut);
  if (!list.length) return null;
  return section("Keep-out violated", { class: "alarm" },
    el("ul", { class: "problems" }, list.map((warning) => item(warning, null, scenario))));
}

/** The spans of time inside cones, for the timelines. */
export function alarmsOf(plan, scenario) {
  return intrusionsOf(plan).map((one) => {
    const cone = scenario.keep_out?.[one.keep_out];
    return { begin: one.from_s, end: one.to_s, depth: one.depth_deg, name: `${cone?.boresight ?? "boresight"} inside cone ${one.keep_out}` };
  });
}
