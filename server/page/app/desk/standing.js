// In a word what the service says about the draft. It leads to the first problem.

import { el } from "../dom.js";
import { count } from "../format.js";

/** The word, which is a button where it leads somewhere; `lead` is called with a problem. */
export function standing(desk, lead) {
  const { draft, checking } = desk;
  const node = el("span", { class: "standing", role: "status" });
  let said = null;
  const say = (kind, text, problem) => {
    if (said === `${kind} ${text}`) {
      target = problem;
      return;
    }
    [said, target] = [`${kind} ${text}`, problem];
    const chip = text && el("span", { class: `chip ${kind}` }, text);
    node.replaceChildren(!text ? "" : problem
      ? el("button", { type: "button", class: "plain", title: "Show the first", onclick: () => lead(target) }, chip) : chip);
  };
  let target = null;
  const render = () => {
    const { errors, warnings, answer, isPending } = checking;
    if (draft.isBlank) return say("", "");
    if (isPending && !answer) return say("waits", "Checking");
    if (!draft.isReadable) return say("bad", "The JSON cannot be read", errors[0] ?? { pointer: "" });
    if (errors.length) return say("bad", count(errors.length, "problem"), errors[0]);
    if (answer?.error) return say("bad", answer.error.title ?? "Not checked");
    if (warnings.length) return say("waits", count(warnings.length, "warning"), warnings[0]);
    return say("good", "No problems");
  };
  checking.listen(render);
  render();
  return node;
}
