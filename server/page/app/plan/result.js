// A plan in all its views.

import { el, section } from "../dom.js";
import { item } from "../failure.js";
import { Cursor } from "../cursor.js";
import { flightOf } from "../flight.js";
import { flown } from "../flown.js";
import { seconds } from "../format.js";
import { isFinal } from "../state.js";
import { alternatives } from "./alternatives.js";
import { downloads } from "./downloads.js";
import { facts, order } from "./facts.js";
import { orderEdit } from "./order-edit.js";
import { schedule } from "./schedule.js";
import { skipped } from "./skipped.js";
import { legs } from "./legs.js";
import { matrix } from "./matrix.js";
import { verification } from "./verification.js";
import { banners, checkedPlan } from "./violations.js";

/** The views of a plan; `beside` stands next to its verification. */
export function result(job, plan, scenario, beside, signal) {
  const flight = flightOf(plan, scenario);
  if (!flight) {
    return el("div", { class: "result" }, reasons(plan, scenario), beside,
      downloads(job.id, job.name, { plan: "why there is none" }));
  }
  const cursor = new Cursor();
  return el(
    "div",
    { class: "result" },
    banners(checkedPlan(plan), scenario, cursor),
    job.detail ? el("p", { class: "quiet so-far" }, `The search ended without a plan of its own: ${job.detail}. The best before that:`) : null,
    isFinal(job.state) ? facts(plan) : el("p", { class: "quiet so-far" }, `A plan of ${seconds(plan.total_time_s)}, the best when it was read:`),
    order(plan, scenario, cursor, signal),
    flown(flight, cursor, signal),
    schedule(plan, scenario, flight, cursor, signal),
    skipped(plan, scenario),
    legs(plan, flight),
    isFinal(job.state) ? orderEdit(job, plan, scenario, signal) : null,
    alternatives(job, plan, scenario, signal),
    el("div", { class: "cards" }, verification(plan), beside),
    matrix(plan, scenario, signal),
    downloads(job.id, job.name, { plan: "the whole plan", exports: true }),
  );
}

function reasons(plan, scenario) {
  const list = plan.reasons ?? [];
  return section("Why there is no plan", { class: "card" },
    list.length ? el("ul", { class: "problems" }, list.map((reason) => item(reason, null, scenario))) : el("p", {}, plan.status));
}
