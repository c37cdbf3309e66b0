// Studies: what the choice of an option leads to.

import { el } from "../dom.js";
import { saved } from "../saved.js";
import { generic } from "../studies/generic.js";
import { STUDIES } from "../studies/registry.js";
import { workbench } from "../workbench.js";

/** The view at "#/studies/{name}"; without a name of the first one. */
export function studies({ id, signal, query }) {
  const study = STUDIES.find(({ name }) => name === id) ?? STUDIES[0];
  const links = STUDIES.map((one) => el("li", {},
    el("a", { href: `#/studies/${one.name}`, "aria-current": one === study ? "page" : null }, one.title)));
  return workbench({
    title: `${study.title} study`, id: "study", label: "Study", verb: "Run", done: () => "Done", path: study.path,
    operation: `studies/study_${study.name}`,
    list: study.examples, signal, query,
    head: el("p", { class: "quiet" }, study.question),
    aside: el("nav", { "aria-label": "Studies" }, el("h2", {}, "Studies"), el("ul", { class: "choices" }, links)),
    draw: async (answer, drawing) => [
      ...[await (study.render ?? generic)(answer, drawing)].flat(),
      saved([[answer.text, `${study.name}-study.json`, "Answer", "all that the service found"],
        [JSON.stringify(answer.request, null, 2), `${study.name}-request.json`, "Request", "what was asked for"]], drawing),
    ],
  });
}
