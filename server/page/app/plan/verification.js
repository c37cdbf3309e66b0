// What the independent flight of a plan showed.

import { ALLOWED, checks, messages, pairs, verdict } from "../checks.js";
import { el, section } from "../dom.js";
import { percent } from "../format.js";
import { clearanceItems, isKeepOut } from "./keep-out.js";
import { checkedPlan, doubtOf } from "./violations.js";

/** The section with the verification, the margins and the warnings of a plan. */
export function verification(plan) {
  const found = plan.verification;
  if (!found) return null;
  const rows = [
    ["attitude error, rad", found.max_attitude_error_rad, ALLOWED.attitude],
    ["rate error, rad/s", found.max_rate_error_rad_s, ALLOWED.rate],
    ["wheel speed excess", found.max_wheel_speed_excess, ALLOWED.excess],
    ["torque excess", found.max_torque_excess, ALLOWED.excess],
    ["body rate excess", found.max_rate_excess, ALLOWED.excess],
  ];
  return section("Verification", { head: verdict(found.passed, doubtOf(checkedPlan(plan))), class: "card" },
    checks(rows),
    margins(plan),
    messages("Warnings", plan.warnings?.filter((warning) => !isKeepOut(warning))),
    el("p", { class: "quiet" }, `Flown again from the start by code that shares nothing with the optimiser. ${found.integrator}.`));
}

function margins(plan) {
  const { margins } = plan;
  if (!margins) return null;
  const items = [
    ["Torque left", percent(margins.torque, 1)],
    ["Wheel speed left", percent(margins.wheel_speed, 1)],
    ["Body rate left", percent(margins.body_rate, 1)],
    ["Zero crossings", (margins.wheel_zero_crossings ?? []).join(", ")],
    ...clearanceItems(plan),
  ];
  return pairs(items);
}
