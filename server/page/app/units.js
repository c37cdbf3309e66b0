// Body rates, wheel speeds and moments in the units that a reader has chosen.

import { el } from "./dom.js";
import { fixed } from "./format.js";
import { CHOICES, settings } from "./settings.js";

/** Factors from SI, and digits that are shown beside a plot and in a table. */
const RATES = {
  "deg/s": { unit: "deg/s", factor: 180 / Math.PI, shown: 3, digits: 4 },
  "rad/s": { unit: "rad/s", factor: 1, shown: 5, digits: 6 },
};
const SPEEDS = {
  "rad/s": { unit: "rad/s", factor: 1, shown: 1, digits: 2 },
  rpm: { unit: "rpm", factor: 30 / Math.PI, shown: 0, digits: 1 },
};

export const rateUnit = () => RATES[settings.get("rate")];
export const speedUnit = () => SPEEDS[settings.get("speed")];

/** A date of a scenario as milliseconds; not a number for any other text. */
const parsed = (date) => Date.parse(`${String(date).replace(/Z$/, "")}Z`);

/** The clock of a scenario: its time system and the day and time of moments; null without an epoch. */
export function clockOf({ epoch, time_system: system }) {
  if (!epoch) return null;
  const begin = parsed(epoch);
  if (Number.isNaN(begin)) return null;
  // A leap second would not be seen; none has been announced.
  const text = (time) => new Date(begin + Math.round(1000 * time)).toISOString();
  return {
    name: system ?? "UTC",
    /** Seconds from the start to a date. */
    seconds: (date) => (parsed(date) - begin) / 1000,
    /** Seconds after a full day at which the flight begins. */
    offset: (begin % 86_400_000) / 1000,
    day: (time) => text(time).slice(0, 10),
    time: (time, digits = 1) => text(time).slice(11, 19 + (digits ? 1 + digits : 0)),
  };
}

/** The clock, where the reader wants it. */
export const shownClock = (clock) => (clock && settings.get("time") === "clock" ? clock : null);

/** A moment as a text, with its time of day where the reader wants it. */
export function momentText(time, clock) {
  const shown = shownClock(clock);
  return [`${fixed(time, 1)} s`, shown ? `${shown.day(time)} ${shown.time(time)} ${shown.name}` : null].filter(Boolean).join(" · ");
}

/** Fields for the units; for the time only where there is a clock. */
export function unitChoices(clock, signal) {
  const shown = Object.entries(CHOICES).filter(([name]) => name !== "time" || clock);
  return el("div", { class: "tools units" }, shown.map(([name, [title, values]]) => {
    const text = (value) => ({ elapsed: "s from the start", clock: clock?.name }[value] ?? value);
    const field = el("select", { id: `unit-${name}` }, values.map((value) => el("option", { value }, text(value))));
    const show = () => (field.value = settings.get(name));
    field.addEventListener("change", () => settings.set(name, field.value));
    settings.listen(show, signal);
    show();
    return [el("label", { for: field.id }, title), field];
  }));
}
