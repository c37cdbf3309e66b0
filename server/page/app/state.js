// States of a job, for people.

import { el } from "./dom.js";

const STATES = {
  queued: ["waits", "Queued"],
  running: ["goes", "Running"],
  succeeded: ["good", "Optimal"],
  stopped: ["good", "Best so far"],
  infeasible: ["bad", "Infeasible"],
  failed: ["bad", "Failed"],
  cancelled: ["ended", "Cancelled"],
  dead: ["bad", "Dead"],
};

/** The states that a list can be narrowed to, as [value, text]. */
export const states = Object.entries(STATES).map(([state, [, text]]) => [state, text]);

/** A state as a word. */
export const stateText = (state) => STATES[state]?.[1] ?? state;

/** Whether a job in this state has ended. */
export function isFinal(state) {
  return state !== "queued" && state !== "running";
}

/** A state as a coloured word; `doubt` says what is wrong with a plan that is good otherwise, in the
 * colour of `doubtKind`. */
export function chip(state, doubt = null, doubtKind = "waits") {
  const [kind, text] = STATES[state] ?? ["ended", state];
  if (kind === "good" && doubt) return el("span", { class: `chip ${doubtKind}` }, `${text}, but ${doubt}`);
  return el("span", { class: `chip ${kind}` }, text);
}
