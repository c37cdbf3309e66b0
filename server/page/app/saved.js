// What is on the page as files.

import { el, section } from "./dom.js";

/** The section with links to documents, each [text, file, title, note], while the signal lasts. */
export function saved(documents, signal) {
  const links = documents.map(([text, file, title, note]) => {
    const href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
    signal.addEventListener("abort", () => URL.revokeObjectURL(href));
    return el("a", { class: "download", href, download: file }, el("strong", {}, title), el("span", {}, note));
  });
  return section("Downloads", { class: "wide" }, el("ul", { class: "downloads" }, links.map((link) => el("li", {}, link))));
}
