// Studies: what the choice of an option leads to.

import { read } from "../api.js";
import { el } from "../dom.js";
import { saved } from "../saved.js";
import { STUDIES } from "../studies/registry.js";
import { workbench } from "../workbench.js";

/** The view at "#/studies/{name}", without a name of the first one; it may name a plan to be studied at once. */
export function studies({ id, signal, query }) {
  const study = STUDIES.find(({ name }) => name === id) ?? STUDIES[0];
  const links = STUDIES.map((one) => el("li", {},
    el("a", { href: `#/studies/${one.name}`, "aria-current": one === study ? "page" : null }, one.title)));
  return workbench({
    title: `${study.title} study`, id: "study", label: "Study", verb: "Run", done: () => "Done", path: study.path,
    operation: `studies/study_${study.name}`,
    list: study.examples, signal, query,
    begin: query.get("plan") && study.ofPlan ? () => requestOf(study, query.get("plan"), signal) : null,
    head: el("p", { class: "quiet" }, study.question),
    aside: el("nav", { "aria-label": "Studies" }, el("h2", {}, "Studies"), el("ul", { class: "choices" }, links)),
    draw: async (answer, drawing) => [
      ...[await study.render(answer, drawing)].flat(),
      saved([[answer.text, `${study.name}-study.json`, "Answer", "all that the service found"],
        [JSON.stringify(answer.request, null, 2), `${study.name}-request.json`, "Request", "what was asked for"]], drawing),
    ],
  });
}

/** The request for a study of a plan. */
async function requestOf(study, id, signal) {
  const [plan, scenario] = await Promise.all(["result", "scenario"].map((part) => read(`/v1/plans/${encodeURIComponent(id)}/${part}`, signal)));
  return study.ofPlan(plan, scenario);
}
