// What the independent flight of a plan showed.

import { el, section, table } from "../dom.js";
import { fixed, percent, small } from "../format.js";

/** The tolerances that a verification passes with. */
const ALLOWED = { attitude: 1e-6, rate: 1e-7, excess: 1e-6 };

/** The section with the verification, the margins and the warnings of a plan. */
export function verification(plan, scenario) {
  const found = plan.verification;
  if (!found) return null;
  const verdict = el("span", { class: `chip ${found.passed ? "good" : "bad"}` }, found.passed ? "Passed" : "Not passed");
  const columns = [{ title: "Largest", head: true }, { title: "Found", number: true }, { title: "Allowed", number: true }];
  const rows = [
    ["attitude error, rad", small(found.max_attitude_error_rad), small(ALLOWED.attitude)],
    ["rate error, rad/s", small(found.max_rate_error_rad_s), small(ALLOWED.rate)],
    ["wheel speed excess", small(found.max_wheel_speed_excess), small(ALLOWED.excess)],
    ["torque excess", small(found.max_torque_excess), small(ALLOWED.excess)],
    ["body rate excess", small(found.max_rate_excess), small(ALLOWED.excess)],
  ];
  return section("Verification", { head: verdict, class: "card" },
    table("Errors and excesses of the flight", columns, rows),
    margins(plan.margins, scenario),
    messages("Failures", found.failures),
    messages("Warnings", plan.warnings),
    el("p", { class: "quiet" }, `Flown again from the start by code that shares nothing with the optimiser. ${found.integrator}.`));
}

function margins(margins, scenario) {
  if (!margins) return null;
  const cones = (scenario.keep_out ?? []).map((cone, index) =>
    [`Clearance of ${cone.boresight}`, `${fixed(margins.keep_out_clearance_deg?.[index], 1)}°`]);
  const items = [
    ["Torque left", percent(margins.torque, 1)],
    ["Wheel speed left", percent(margins.wheel_speed, 1)],
    ["Body rate left", percent(margins.body_rate, 1)],
    ["Zero crossings", (margins.wheel_zero_crossings ?? []).join(", ")],
    ...cones,
  ];
  return el("dl", { class: "pairs" }, items.map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))));
}

function messages(title, list) {
  if (!list?.length) return null;
  const text = (entry) => (typeof entry === "string" ? entry : entry.message ?? JSON.stringify(entry));
  return el("div", { class: "messages" }, el("h3", {}, title), el("ul", {}, list.map((entry) => el("li", {}, text(entry)))));
}
