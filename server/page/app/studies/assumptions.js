// What a simulation takes not to be as planned.

import { el } from "../dom.js";
import { significant } from "../format.js";
import { named } from "./names.js";

/** A sentence with the errors of a request; nothing without any. */
export function assumptions({ simulation = {} }) {
  const errors = Object.entries(simulation.errors ?? {}).filter(([, value]) => typeof value === "number" && value !== 0);
  const text = errors.map(([name, value]) => `${named(name)} ${significant(value)}`).join("; ");
  return el("p", { class: "quiet so-far" }, text ? `Not as planned: ${text}.` : "Everything is as planned, but for what the request says of clocks and drives.");
}
