// A notice of the browser's when something ends that nobody looks at. Permission is asked for when
// somebody wants it, never before.

import { el } from "./dom.js";

const KEPT = "slewplan-notices";

const isPossible = () => "Notification" in globalThis && Notification.permission !== "denied";
const isAllowed = () => isPossible() && Notification.permission === "granted";

function isWanted() {
  try {
    return localStorage.getItem(KEPT) === "yes";
  } catch {
    return false;
  }
}

function want(isIt) {
  try {
    localStorage.setItem(KEPT, isIt ? "yes" : "no");
  } catch {
    // A browser that keeps nothing asks again on the next page.
  }
}

/** A choice to be told of the end, where the browser has such notices: {node, isPossible, tell}; `tell` shows a notice where that is wanted and the tab is hidden. */
export function notice() {
  const box = el("input", { type: "checkbox", id: "notice", checked: isAllowed() && isWanted() });
  const said = el("span", { class: "quiet", role: "status" });
  box.addEventListener("change", async () => {
    if (box.checked && !isAllowed()) await Notification.requestPermission();
    if (box.checked && !isAllowed()) said.textContent = "The browser does not allow it.";
    box.checked &&= isAllowed();
    want(box.checked);
  });
  const node = el("p", { class: "notice", hidden: true },
    box, el("label", { for: "notice" }, "Notify me when it is done and this tab is hidden"), said);
  return {
    node,
    isPossible: isPossible(),
    tell(title, body) {
      if (!box.checked || !isAllowed() || !document.hidden) return;
      const shown = new Notification(title, { body, tag: location.hash });
      shown.addEventListener("click", () => {
        globalThis.focus();
        shown.close();
      });
    },
  };
}
