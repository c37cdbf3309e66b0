// The list of plans, page by page, renewed while it is looked at.

import { read } from "../api.js";
import { el, table } from "../dom.js";
import { failure } from "../failure.js";
import { moment, percent, seconds } from "../format.js";
import { VIOLATED } from "../plan/keep-out.js";
import { chip, isFinal, states } from "../state.js";

const PAGE = 25;
/** After the last letter of a search. */
const PAUSE_MS = 250;
const RENEW_MS = 2000;
const RENEW_IDLE_MS = 10000;

const COLUMNS = [
  { title: "Plan", head: true },
  { title: "State" },
  { title: "Targets", number: true },
  { title: "Time", number: true },
  { title: "Gap", number: true },
  { title: "Submitted", number: true },
  { title: "Solved in", number: true },
];

/** The view at "#/". */
export function list({ signal }) {
  const place = el("div", { "aria-live": "off" });
  const trail = [null];
  let next = null;

  const search = el("input", { id: "filter-search", type: "search", placeholder: "part of a name", autocomplete: "off" });
  const state = el(
    "select",
    { id: "filter-state" },
    el("option", { value: "" }, "any"),
    states.map(([value, text]) => el("option", { value }, text)),
  );
  const newer = el("button", { type: "button", onclick: () => { trail.pop(); renew(); } }, "Newer");
  const older = el("button", { type: "button", onclick: () => { trail.push(next); renew(); } }, "Older");
  const narrow = () => { trail.length = 1; renew(); };
  let typed;
  search.addEventListener("input", () => {
    clearTimeout(typed);
    typed = setTimeout(narrow, PAUSE_MS);
  });
  state.addEventListener("change", narrow);

  let [timer, asked] = [0, 0];
  async function renew() {
    clearTimeout(timer);
    const own = (asked += 1);
    const query = new URLSearchParams({ limit: PAGE });
    if (trail.at(-1)) query.set("cursor", trail.at(-1));
    if (search.value.trim()) query.set("search", search.value.trim());
    if (state.value) query.set("state", state.value);
    let pause = RENEW_IDLE_MS;
    try {
      const page = await read(`/v1/plans?${query}`, signal);
      // What was asked for later is what is shown.
      if (own !== asked) return;
      next = page.next_cursor;
      const focused = place.contains(document.activeElement) ? document.activeElement.getAttribute("href") : null;
      place.replaceChildren(page.plans.length ? rows(page.plans) : empty(search.value || state.value));
      if (focused) place.querySelector(`a[href="${CSS.escape(focused)}"]`)?.focus();
      if (page.plans.some((job) => !isFinal(job.state))) pause = RENEW_MS;
    } catch (error) {
      if (signal.aborted || own !== asked) return;
      place.replaceChildren(failure(error));
      // Without a key the service would ask for one again and again.
      if (error.status === 401) return;
    }
    newer.disabled = trail.length === 1;
    older.disabled = next === null;
    pager.hidden = newer.disabled && older.disabled;
    timer = setTimeout(renew, pause);
  }
  const pager = el("div", { class: "actions pager", hidden: true }, newer, older);
  signal.addEventListener("abort", () => [timer, typed].forEach(clearTimeout));
  renew();

  return el(
    "div",
    { class: "view" },
    el(
      "div",
      { class: "title" },
      el("h1", {}, "Plans"),
      el("a", { class: "button primary", href: "#/new" }, "New plan"),
    ),
    el(
      "div",
      { class: "filters" },
      el("label", { for: "filter-search" }, "Search"),
      search,
      el("label", { for: "filter-state" }, "State"),
      state,
    ),
    place,
    pager,
  );
}

function rows(plans) {
  return table("Plans, the newest first", COLUMNS, plans.map((job) => [
    // Where there is no room for its column the moment stands below the name.
    [el("a", { href: `#/plans/${job.id}` }, job.name ?? "unnamed"),
      el("time", { class: "below", datetime: job.submitted_at }, moment(job.submitted_at))],
    chip(job.state, job.keep_out_violated ? VIOLATED : null),
    String(job.targets),
    seconds(job.incumbent_s),
    percent(job.relative_gap),
    el("time", { datetime: job.submitted_at }, moment(job.submitted_at)),
    seconds(job.solved_s, 1),
  ]));
}

function empty(narrowed) {
  return el(
    "div",
    { class: "empty" },
    el("p", {}, narrowed ? "No plan is like this." : "There is no plan yet."),
    narrowed ? null : el("p", {}, el("a", { href: "#/new?example=olivares-a" }, "Start with an example")),
  );
}
