// A document that is answered at once: its field, its examples, the computation and the result.

import { postForText } from "./api.js";
import { computation } from "./computation.js";
import { el } from "./dom.js";
import { editor, examples } from "./editor.js";
import { failure, success } from "./failure.js";
import { seconds } from "./format.js";
import { write as pretty } from "./pretty.js";

const ROWS = 16;

/**
 * The view of a request. `done` says in a word what an answer is; `draw` makes the nodes of the result
 * of {request, document, text}, with a signal for its drawings, and may be asynchronous. `head` stands
 * above the field, `aside` above the examples; `begin` makes a request that is sent at once.
 */
export function workbench({ title, id, label, verb, done, path, operation, list, head, aside, draw, begin = null, signal, query }) {
  const result = el("div", { class: "result", role: "region", "aria-label": "Result", tabindex: "-1", hidden: true });
  let drawing = new AbortController();
  signal.addEventListener("abort", () => drawing.abort());

  const work = async (waiting, elapsed) => {
    const given = field.text;
    drawing.abort();
    drawing = new AbortController();
    result.hidden = true;
    result.replaceChildren();
    field.outcome.replaceChildren();
    try {
      const text = await postForText(path, given, waiting);
      const answer = { request: JSON.parse(given.replace(/^\ufeff/, "")), document: JSON.parse(text), text };
      const nodes = await draw(answer, drawing.signal);
      const title = `${done(answer.document)} in ${seconds(elapsed(), 1)}`;
      field.outcome.replaceChildren(success(title, answer.document.warnings ?? [], field.show, field.document));
      result.hidden = false;
      result.replaceChildren(...[nodes].flat().filter(Boolean));
      // Whoever waited is led to what came of it.
      result.focus({ preventScroll: true });
      result.scrollIntoView({ block: "start" });
    } catch (error) {
      if (!waiting.aborted) field.outcome.replaceChildren(failure(error, field.show, field.document));
    }
  };
  const { nodes, run } = computation({ title: verb, signal, work });
  const field = editor({ id, label, rows: ROWS, actions: nodes, signal });
  if (query.get("example")) field.loadExample(query.get("example"));
  if (begin) {
    begin().then((document) => {
      field.write(pretty(document, ""));
      return run();
    }, (error) => signal.aborted || field.outcome.replaceChildren(failure(error)));
  }

  return el(
    "div",
    { class: "view" },
    el("div", { class: "title" }, el("div", {}, el("h1", {}, title), head)),
    el("div", { class: "split" }, field.node,
      el("aside", {}, aside, examples(list, field.loadExample, operation))),
    result,
  );
}
