// Two plans beside each other.

import { read } from "../api.js";
import { compared } from "../compare/compared.js";
import { el } from "../dom.js";
import { failure } from "../failure.js";
import { moment, seconds } from "../format.js";
import { isFinal } from "../state.js";
import { follow } from "../stream.js";

/** So many of the newest plans can be chosen. */
const MOST = 200;
const SIDES = ["First plan", "Second plan"];

/** The view at "#/compare/{id}/{id}"; what is not named is chosen on it. */
export function compare({ id, other, signal }) {
  const place = el("div", { class: "result" });
  const said = el("p", { class: "quiet", role: "status" });
  const ids = [id, other];
  const fields = SIDES.map((side, index) => el("select", { id: `compare-${index}` }, el("option", { value: "" }, "choose a plan")));
  const go = () => {
    const [first, second] = fields.map((field) => field.value);
    if (first && second) location.hash = `#/compare/${first}/${second}`;
  };
  for (const field of fields) field.addEventListener("change", go);

  const run = async () => {
    const { plans } = await read(`/v1/plans?limit=${MOST}`, signal);
    const known = new Map(plans.map((job) => [job.id, job]));
    for (const one of ids.filter((one) => one && !known.has(one))) {
      known.set(one, await read(`/v1/plans/${one}`, signal));
    }
    fields.forEach((field, index) => {
      field.append(...[...known.values()].map((job) => el("option", { value: job.id }, label(job))));
      field.value = ids[index] ?? "";
    });
    if (!ids.every(Boolean)) {
      said.textContent = "Choose two plans.";
      return;
    }
    const sides = await Promise.all(ids.map((one) => side(known.get(one))));
    said.textContent = "";
    for (const { job } of sides) {
      for (const option of fields.flatMap((field) => [...field.options])) if (option.value === job.id) option.textContent = label(job);
    }
    place.replaceChildren(...compared(sides, signal));
  };

  /** The plan of a job with its scenario, when the job has ended. */
  async function side(job) {
    if (!isFinal(job.state)) {
      said.textContent = `Waiting for ${job.name ?? "the plan"} …`;
      await follow(job.id, () => {}, signal);
    }
    const [found, scenario, ended] = await Promise.all(["/result", "/scenario", ""].map((part) => read(`/v1/plans/${job.id}${part}`, signal)));
    return { job: ended, plan: found, scenario };
  }

  run().catch((error) => {
    said.textContent = "";
    if (!signal.aborted) place.replaceChildren(failure(error));
  });
  return el("div", { class: "view" },
    el("div", { class: "title" }, el("h1", {}, "Compare plans")),
    el("div", { class: "filters" }, fields.map((field, index) => el("span", { class: "filter" }, el("label", { for: field.id }, SIDES[index]), field))),
    said, place);
}

const label = (job) => [job.name ?? "unnamed", seconds(job.incumbent_s), moment(job.submitted_at)].join(" · ");
