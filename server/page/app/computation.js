// A request that takes a while: it says so, and can be given up. The service computes only while
// somebody waits, so whoever gives up also stops it there.

import { el } from "./dom.js";
import { seconds } from "./format.js";

const TICK_MS = 100;

/**
 * A button that begins the work, one that gives it up, and what is said about it. `work` is called
 * with a signal; it deals with all errors but that of having been given up.
 */
export function computation({ title, signal, work }) {
  let given = null;
  const go = el("button", { type: "button", class: "primary", onclick: run }, title);
  const stop = el("button", { type: "button", hidden: true, onclick: () => given.abort() }, "Cancel");
  const said = el("span", { role: "status" });
  // Not for those who listen: it would be said again and again.
  const clock = el("span", { "aria-hidden": "true" });

  const say = (kind, text) => said.replaceChildren(text ? el("span", { class: `chip ${kind}` }, text) : "");

  async function run() {
    if (go.getAttribute("aria-disabled")) return;
    given = new AbortController();
    const either = new AbortController();
    for (const one of [signal, given.signal]) one.addEventListener("abort", () => either.abort());
    const begun = performance.now();
    const elapsed = () => (performance.now() - begun) / 1000;
    const ticking = setInterval(() => (clock.textContent = seconds(elapsed(), 1)), TICK_MS);
    // A button that is really disabled would lose the focus.
    go.setAttribute("aria-disabled", "true");
    stop.hidden = false;
    say("goes", "Computing");
    try {
      await work(either.signal, elapsed);
      say("ended", given.signal.aborted ? "Cancelled" : null);
    } finally {
      clearInterval(ticking);
      clock.textContent = "";
      const focused = document.activeElement === stop;
      go.removeAttribute("aria-disabled");
      stop.hidden = true;
      if (focused) go.focus();
    }
  }
  return { nodes: [go, stop, el("span", { class: "computing" }, said, clock)], run };
}
