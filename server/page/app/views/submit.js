// A new plan: its targets, spacecraft and conditions as tables and forms, the sky, and the JSON of it all.

import { post } from "../api.js";
import { boresightNames } from "../desk/control.js";
import { conesForm } from "../desk/cones-form.js";
import { optionsForm, statesForm } from "../desk/conditions-form.js";
import { Desk } from "../desk/desk.js";
import { historyButtons, listenToHistory } from "../desk/history.js";
import { spacecraftForm } from "../desk/spacecraft-form.js";
import { skyView } from "../desk/sky-view.js";
import { standing } from "../desk/standing.js";
import { takeFile, targetsPart } from "../desk/targets-part.js";
import { el, section } from "../dom.js";
import { editor, examples } from "../editor.js";
import { failure, success } from "../failure.js";

const EXAMPLES = [
  ["two-targets", "Two targets", "settle, dwell and a keep-out cone"],
  ["stars-and-sun", "Stars with the Sun", "pointings with free roll, cones around the Sun"],
  ["olivares-a", "Experiment A", "six targets, the published case"],
  ["olivares-b", "Experiment B", "twelve targets"],
  ["olivares-c", "Experiment C", "eighteen targets"],
  ["pyramid-momentum-bias", "Pyramid with bias", "four wheels, stored momentum"],
];

/** Letters that one key changes at most: a line break with its indentation is more, and a step. */
const MAX_TYPED = 2;

/** The view at "#/new", which may name an example or a plan to start from. */
export function submit({ signal, query }) {
  const desk = new Desk(signal);
  const { draft, checking } = desk;
  const check = el("button", { type: "button", onclick: () => ask() }, "Check");
  const go = el("button", { type: "button", class: "primary", onclick: () => send() }, "Plan");
  /** Leads to the cell of a problem, or to its place in the text. */
  const lead = (problem) => desk.lead(problem.pointer ?? "") || field.show(problem);

  const field = editor({
    id: "scenario", label: "Scenario", rows: 18, signal,
    // Letters that are typed are one step of the history, what is pasted or loaded is one of its own.
    changed: (text) => draft.edit(text, "JSON", Math.abs(text.length - draft.text.length) <= MAX_TYPED ? "JSON" : null),
    taken: (file) => /\.(csv|tsv|txt)$/i.test(file.name) && (takeFile(desk, file, field.write), true),
  });
  const { outcome } = field;
  draft.listen(() => field.text !== draft.text && field.put(draft.text), signal);
  field.put(draft.text);

  desk.showInText = (pointer) => field.show({ pointer });
  const cellOf = ({ pointer }) => desk.has(pointer ?? "")
    && el("button", { type: "button", class: "small", onclick: () => desk.lead(pointer) }, "Show the cell");
  let shown = null;
  const tell = (isAsked) => {
    const { answer } = checking;
    if (!answer || (answer === shown && !isAsked)) return;
    shown = answer;
    const node = answer.error
      ? failure(answer.error, field.show, field.document, cellOf)
      : success("Valid", answer.warnings, field.show, field.document, cellOf);
    // What nobody asked for does not interrupt.
    if (!isAsked) node.removeAttribute("role");
    outcome.replaceChildren(node);
  };
  outcome.setAttribute("aria-live", "off");
  checking.listen(() => (checking.answer ? tell(false) : draft.isBlank && outcome.replaceChildren()));

  async function ask() {
    check.disabled = go.disabled = true;
    await checking.ask();
    tell(true);
    check.disabled = go.disabled = false;
  }

  async function send() {
    check.disabled = go.disabled = true;
    try {
      const answer = await post("/v1/plans", draft.text, signal);
      location.hash = `#/plans/${answer.id}`;
    } catch (error) {
      if (!signal.aborted) {
        outcome.replaceChildren(failure(error, field.show, field.document, cellOf));
        outcome.scrollIntoView({ block: "nearest" });
      }
    }
    check.disabled = go.disabled = false;
  }

  const node = el("div", { class: "view desk" },
    el("div", { class: "title desk-title" },
      el("h1", {}, "New plan"), el("div", { class: "actions" }, standing(desk, lead), historyButtons(desk), check, go)),
    boresightNames(desk),
    el("div", { class: "desk-parts" },
      el("div", { class: "desk-main" }, targetsPart(desk, field.write), conesForm(desk), spacecraftForm(desk), statesForm(desk), optionsForm(desk)),
      el("div", { class: "desk-side" }, skyView(desk), section("JSON", { class: "desk-part desk-json" }, field.node),
        el("aside", { class: "desk-part", "aria-labelledby": "examples-title" }, examples(EXAMPLES, field.loadExample, "plans/create_plan")))));
  listenToHistory(node, draft);
  if (query.get("example")) field.loadExample(query.get("example"));
  if (query.get("from")) field.load(`/v1/plans/${encodeURIComponent(query.get("from"))}/scenario`);
  return node;
}
