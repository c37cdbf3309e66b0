// The figures of a job or plan that are read first.

import { el } from "../dom.js";
import { fixed, percent, seconds, significant } from "../format.js";
import { settings } from "../settings.js";
import { strip } from "../strip.js";
import { clockOf, shownClock } from "../units.js";

const KINDS = {
  nlp_relaxation: "relaxed problems, each taken to be solved globally",
  pair_table: "table of slews, each taken to be solved globally",
  certified: "proved",
};

/** The limit of a search that its scenario says nothing of, s. */
const USUAL_LIMIT_S = 60;

/** The limit of time of a scenario, s; null for none. */
function limitOf({ options }) {
  const limit = options?.time_limit_s;
  return limit === undefined ? USUAL_LIMIT_S : limit;
}

/** What is visited and what could be, as a figure; null where targets have no values. */
function worth({ value, value_bound: bound }) {
  if (typeof value !== "number" || !(value > 0 || bound > 0)) return null;
  const known = typeof bound === "number";
  const note = !known ? null : bound > value ? `no plan has more than ${significant(bound)}` : "no plan has more";
  return ["Value", significant(value), note];
}

/** How a job stands, with the time that is left of the limit while it runs. */
export function standing(job, scenario, elapsed) {
  const limit = limitOf(scenario);
  const left = job.state === "running" && limit !== null && elapsed !== null ? Math.max(0, limit - elapsed) : null;
  const steps = job.total ? `${job.done ?? 0} of ${job.total}` : null;
  return strip([
    worth(job),
    ["Best plan", seconds(job.incumbent_s)],
    ["Lower bound", seconds(job.lower_bound_s)],
    ["Gap", percent(job.relative_gap)],
    ["Stage", job.stage ?? "waiting", steps],
    ["Elapsed", seconds(elapsed, 1)],
    left === null ? null : ["Time left", left > 0 ? seconds(left, 0) : "finishing", `of the limit of ${significant(limit)} s`],
  ]);
}

/** What is saved against slews about the eigenaxis in the same order, s; null where one is unknown, and with a
 * clock, by which the same order would not end sooner. */
export function saving(plan) {
  if (plan.objective) return null;
  const eigenaxis = plan.legs.map((leg) => leg.eigenaxis_duration_s);
  if (!plan.legs.length || eigenaxis.some((duration) => duration === null)) return null;
  return plan.legs.reduce((total, leg, index) => total + eigenaxis[index] - leg.duration_s, 0);
}

/** The figures of a plan. */
export function facts(plan) {
  const saved = saving(plan);
  const gap = plan.relative_gap;
  return strip([
    worth(plan),
    ["Total time", seconds(plan.total_time_s)],
    ["Lower bound", seconds(plan.lower_bound_s), KINDS[plan.lower_bound_kind]],
    ["Gap", percent(gap), gap === 0 ? "no order is better, given this bound" : null],
    saved === null ? null : ["Saved", seconds(saved, 1),
      `${fixed((100 * saved) / (plan.total_time_s + saved), 1)} % against eigenaxis slews`],
    plan.certified_lower_bound_s === null ? null
      : ["Proved bound", seconds(plan.certified_lower_bound_s), "over all admissible orders"],
    ["Solved in", seconds(plan.statistics.wall_time_s), `${plan.statistics.nlp_solves} programs, ${plan.statistics.threads} threads`],
  ]);
}

/** The visiting order; a target leads to the moment of its arrival. */
export function order(plan, scenario, cursor, signal) {
  const clock = clockOf(scenario);
  const text = ({ time_s: time, roll_deg: roll }) =>
    [shownClock(clock)?.time(time) ?? seconds(time, 1), roll === undefined ? null : `roll ${fixed(roll, 1)}°`].filter(Boolean).join(", ");
  const times = plan.passages.map(() => el("span", { class: "stop-time" }));
  const renew = () => times.forEach((node, index) => (node.textContent = text(plan.passages[index])));
  settings.listen(renew, signal);
  renew();
  return el("ol", { class: "order", "aria-label": "Visiting order" }, plan.passages.map((passage, index) =>
    el("li", {}, el("button", { type: "button", onclick: () => cursor.set(passage.time_s) },
      el("span", { class: "stop-name" }, passage.target), " ", times[index]))));
}
