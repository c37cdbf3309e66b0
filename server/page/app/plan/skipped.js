// The targets that a plan leaves out, each with the reason and what it would cost to visit it.

import { el, section, table } from "../dom.js";
import { count, fixed, signed, significant } from "../format.js";

const REASONS = {
  window_unreachable: "no window can be reached",
  value_too_small: "worth less than what it would displace",
  time_is_up: "the schedule would end too late",
  not_tried: "not tried before the search ended",
};

const COLUMNS = [
  { title: "Target", head: true }, { title: "Value", number: true }, { title: "Why" },
  { title: "With it: value", number: true }, { title: "With it: time, s", number: true },
];

/** The section with the targets that are left out; null without any. */
export function skipped(plan, scenario) {
  const list = plan.skipped ?? [];
  if (!list.length) return null;
  const values = new Map(scenario.targets.map((target) => [target.id, target.value]));
  const isKnown = list.some(({ inclusion }) => inclusion);
  const columns = isKnown ? COLUMNS : COLUMNS.slice(0, 3);
  const rows = list.map(({ target, reason, inclusion }) => [
    target, significant(values.get(target)), REASONS[reason] ?? reason,
    ...isKnown ? [change(inclusion?.value_change, significant), change(inclusion?.time_change_s, fixed)] : [],
  ]);
  return section("Left out", { class: "wide left-out" }, table("Targets that are left out", columns, rows),
    el("p", { class: "quiet" }, `${count(list.length, "target")} of ${scenario.targets.length}. `,
      isKnown ? "How much the best plan that is known with a target differs from this one stands beside it, where it was found out." : ""));
}

const change = (value, text) => (typeof value === "number" ? signed(text(value)) : "–");
