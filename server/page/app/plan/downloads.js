// The plan as files.

import { request } from "../api.js";
import { el, section } from "../dom.js";
import { failure } from "../failure.js";

/** Values of `format`, endings of the files, names and what they are for. */
const FORMATS = [
  ["json", "json", "JSON", "the whole plan"],
  ["csv", "csv", "CSV", "sampled trajectory"],
  ["aem-kvn", "aem", "CCSDS AEM", "attitude message, keywords and values"],
  ["aem-xml", "aem.xml", "CCSDS AEM, XML", "the same message"],
  ["basilisk", "waypoints.csv", "Basilisk", "for waypointReference"],
  ["open-mct", "open-mct.json", "Open MCT", "activities of a plan"],
  ["stk", "a", "STK", "attitude file"],
  ["wheel-rpm", "tsv", "Wheel speeds", "commands in rpm"],
];

/** The section with a link for every form of a plan. */
export function downloads(id, name) {
  const stem = (name ?? "plan").replaceAll(/[^\w.-]+/g, "-");
  const links = FORMATS.map(([format, ending, title, note]) =>
    link(`/v1/plans/${id}/result?format=${format}`, `${stem}.${ending}`, title, note));
  links.push(link(`/v1/plans/${id}/scenario`, `${stem}-scenario.json`, "Scenario", "what was asked for"));
  return section("Downloads", { class: "wide" }, el("ul", { class: "downloads" }, links.map((one) => el("li", {}, one))));
}

function link(path, file, title, note) {
  const node = el("a", { class: "download", href: path, download: file }, el("strong", {}, title), el("span", {}, note));
  node.addEventListener("click", async (event) => {
    // A link carries no key, and a browser does not show why a file cannot be written.
    event.preventDefault();
    const list = node.closest(".downloads");
    list.parentNode.querySelector(".failure")?.remove();
    try {
      const content = URL.createObjectURL(await (await request(path)).blob());
      el("a", { href: content, download: file }).click();
      setTimeout(() => URL.revokeObjectURL(content), 60_000);
    } catch (problem) {
      list.after(failure(problem));
    }
  });
  return node;
}
