// Units that a reader prefers, kept by the browser from visit to visit.

const KEPT = "slewplan-units";

/** What can be chosen: name, title, and values as [value, text]; the first is usual. */
export const CHOICES = {
  rate: ["Rates", ["deg/s", "rad/s"]],
  speed: ["Wheel speeds", ["rad/s", "rpm"]],
  time: ["Time", ["elapsed", "clock"]],
};

const usual = () => Object.fromEntries(Object.entries(CHOICES).map(([name, [, values]]) => [name, values[0]]));

/** What was kept, as far as it is still known; a browser that keeps nothing has what is usual. */
function kept() {
  const found = usual();
  try {
    const read = JSON.parse(localStorage.getItem(KEPT) ?? "{}");
    for (const name of Object.keys(found)) if (CHOICES[name][1].includes(read?.[name])) found[name] = read[name];
  } catch {
    // Nothing that can be read was kept.
  }
  return found;
}

const chosen = kept();
let listeners = [];

export const settings = {
  get: (name) => chosen[name],
  /** Chooses a value, keeps it and tells everybody. */
  set(name, value) {
    chosen[name] = value;
    try {
      localStorage.setItem(KEPT, JSON.stringify(chosen));
    } catch {
      // A browser that keeps nothing forgets it with the page.
    }
    for (const listener of listeners) listener();
  },
  /** Calls back with every change, while the signal lasts. */
  listen(listener, signal) {
    listeners.push(listener);
    signal.addEventListener("abort", () => (listeners = listeners.filter((other) => other !== listener)));
  },
};
