// A new plan: a scenario pasted, dropped, chosen or taken from the examples.

import { post } from "../api.js";
import { el } from "../dom.js";
import { editor, examples } from "../editor.js";
import { failure, success } from "../failure.js";

const EXAMPLES = [
  ["two-targets", "Two targets", "settle, dwell and a keep-out cone"],
  ["olivares-a", "Experiment A", "six targets, the published case"],
  ["olivares-b", "Experiment B", "twelve targets"],
  ["olivares-c", "Experiment C", "eighteen targets"],
  ["pyramid-momentum-bias", "Pyramid with bias", "four wheels, stored momentum"],
];

/** The view at "#/new", which may name an example or a plan to start from. */
export function submit({ signal, query }) {
  const check = el("button", { type: "button", onclick: () => send(true) }, "Check");
  const go = el("button", { type: "button", class: "primary", onclick: () => send(false) }, "Plan");
  const field = editor({ id: "scenario", label: "Scenario", actions: [go, check], signal });

  async function send(only) {
    check.disabled = go.disabled = true;
    try {
      const answer = await post(only ? "/v1/plans?validate_only=true" : "/v1/plans", field.text, signal);
      if (only) field.outcome.replaceChildren(success("Valid", answer.warnings ?? [], field.show, field.document));
      else location.hash = `#/plans/${answer.id}`;
    } catch (error) {
      if (!signal.aborted) field.outcome.replaceChildren(failure(error, field.show, field.document));
    }
    check.disabled = go.disabled = false;
  }

  if (query.get("example")) field.loadExample(query.get("example"));
  if (query.get("from")) field.load(`/v1/plans/${encodeURIComponent(query.get("from"))}/scenario`);

  return el(
    "div",
    { class: "view" },
    el("div", { class: "title" }, el("h1", {}, "New plan")),
    el(
      "div",
      { class: "split" },
      field.node,
      el("aside", { "aria-labelledby": "examples-title" }, examples(EXAMPLES, field.loadExample, "plans/create_plan")),
    ),
  );
}
