// One job: its search as it goes on, and its plan.

import { post, read, remove } from "../api.js";
import { el, section } from "../dom.js";
import { failure } from "../failure.js";
import { count, moment, seconds } from "../format.js";
import { notice } from "../notice.js";
import { downloads } from "../plan/downloads.js";
import { standing } from "../plan/facts.js";
import { result } from "../plan/result.js";
import { checkedPlan, doubtOf } from "../plan/violations.js";
import { pictureButtons } from "../picture/save.js";
import { convergence } from "../plots/convergence.js";
import { chip, isFinal, stateText } from "../state.js";
import { follow } from "../stream.js";

const TICK_MS = 200;
/** What is done with a plan at one click: a flight in closed loop, and plans that hold back a share of torque and speed. */
const STUDIES = [["flight", "Fly in closed loop"], ["authority", "What share of torque?"]];
/** What is not sooner by this is the same plan. */
const LEAST_GAIN_S = 1e-4;

/** Whether the best plan of an event is better than the one that is shown: worth more, or as much and sooner. */
function isBetter({ incumbent_s: incumbent, value = null }, shown) {
  if (shown.incumbent === null || (value ?? 0) > (shown.value ?? 0)) return true;
  return (value ?? 0) === (shown.value ?? 0) && incumbent <= shown.incumbent - LEAST_GAIN_S;
}

/** The view at "#/plans/{id}". */
export function plan({ id, signal }) {
  const page = new PlanPage(id, signal);
  page.run().catch((error) => signal.aborted || page.fail(error));
  return page.node;
}

class PlanPage {
  #id;
  #signal;
  #job = null;
  #scenario = null;
  #begun = 0;
  #shown = { incumbent: null, value: null, final: false, doubt: null, isFailed: false, isFlown: false };
  #drawing = new AbortController();

  #title = el("h1", {}, "Plan");
  #state = el("span", { role: "status" });
  #about = el("p", { class: "quiet" });
  #stop = el("button", { type: "button", onclick: () => this.#ask("stop") }, "Stop with best so far");
  #cancel = el("button", { type: "button", onclick: () => this.#ask("cancel") }, "Cancel");
  #compare = el("a", { class: "button" }, "Compare");
  #again = el("a", { class: "button" }, "Edit and plan again");
  #studies = STUDIES.map(([, title]) => el("a", { class: "button", hidden: true }, title));
  #delete = el("button", { type: "button", onclick: () => this.#remove() }, "Delete");
  #standing = el("div", {});
  #notice = notice();
  #news = el("div", { class: "news", "aria-live": "polite" });
  #search;
  #progress;
  #result = el("div", {});

  constructor(id, signal) {
    this.#id = id;
    this.#signal = signal;
    this.#progress = convergence(signal);
    const saves = el("div", { class: "tools" }, pictureButtons("search", () => this.#job.name));
    this.#search = section("Search", { class: "card search", head: saves }, this.#progress.node);
    this.#compare.href = `#/compare/${id}`;
    this.#again.href = `#/new?from=${id}`;
    this.#studies.forEach((link, index) => (link.href = `#/studies/${STUDIES[index][0]}?plan=${id}`));
    signal.addEventListener("abort", () => this.#drawing.abort());
    this.node = el("div", { class: "view" },
      el("div", { class: "title" },
        el("div", {}, el("div", { class: "named" }, this.#title, this.#state), this.#about),
        el("div", { class: "actions" }, this.#stop, this.#cancel, this.#studies, this.#compare, this.#again, this.#delete)),
      this.#standing, this.#notice.node, this.#news, this.#search, this.#result);
  }

  async run() {
    [this.#job, this.#scenario] = await Promise.all([
      read(`/v1/plans/${this.#id}`, this.#signal),
      read(`/v1/plans/${this.#id}/scenario`, this.#signal),
    ]);
    this.#title.textContent = this.#job.name ?? "unnamed";
    document.title = `${this.#title.textContent} – slewplan`;
    this.#about.textContent = `${count(this.#job.targets, "target")}, submitted ${moment(this.#job.submitted_at)}`;
    this.#begun = Date.now();
    this.#renew();
    const clock = setInterval(() => this.#tick(), TICK_MS);
    this.#signal.addEventListener("abort", () => clearInterval(clock));
    const wasOver = isFinal(this.#job.state);
    if (wasOver) await this.#draw();
    await follow(this.#id, (event) => this.#take(event), this.#signal);
    clearInterval(clock);
    if (!this.#signal.aborted) this.#job = await read(`/v1/plans/${this.#id}`, this.#signal);
    this.#renew();
    if (!wasOver && !this.#signal.aborted) this.#tellEnd();
    await this.#draw();
  }

  #tellEnd() {
    const { name, state, incumbent_s: total } = this.#job;
    this.#notice.tell(`${name ?? "Plan"}: ${stateText(state)}`, total === null ? "There is no plan." : `A plan of ${seconds(total)}.`);
  }

  fail(error) {
    this.#result.replaceChildren(failure(error));
  }

  #take(event) {
    this.#progress.add(event);
    // A job that had ended tells again how it came to that.
    if (this.#shown.final) return;
    this.#job = { ...this.#job, ...event };
    if (event.elapsed_s !== null) this.#begun = Date.now() - 1000 * event.elapsed_s;
    this.#renew();
    if (isFinal(event.state) || event.incumbent_s === null) return;
    if (!isBetter(event, this.#shown)) return;
    if (this.#shown.incumbent === null) this.#draw();
    else this.#announce();
  }

  #announce() {
    if (this.#news.childElementCount) return;
    this.#news.append(el("button", { type: "button", onclick: () => this.#draw() }, "A better plan was found: show it"));
  }

  #tick() {
    if (this.#job.state === "running") this.#renew();
  }

  #renew() {
    const { state } = this.#job;
    const ended = isFinal(state);
    const { doubt, isFailed } = this.#shown;
    const key = [state, doubt].join();
    if (this.#state.dataset.shown !== key) this.#state.replaceChildren(chip(state, doubt, isFailed ? "bad" : "waits"));
    this.#state.dataset.shown = key;
    this.#notice.node.hidden = ended || !this.#notice.isPossible;
    this.#stop.hidden = state !== "running";
    this.#cancel.hidden = ended;
    this.#compare.hidden = this.#again.hidden = this.#delete.hidden = !ended;
    for (const link of this.#studies) link.hidden = !ended || !this.#shown.isFlown;
    const elapsed = state === "running" ? (Date.now() - this.#begun) / 1000 : null;
    this.#standing.replaceChildren(ended && this.#shown.final ? "" : standing(this.#job, this.#scenario, elapsed ?? this.#job.solved_s));
  }

  /** Fetches the plan and draws it; each drawing replaces the one before. */
  async #draw() {
    if (this.#shown.final) return;
    const final = isFinal(this.#job.state);
    if (!final) [this.#shown.incumbent, this.#shown.value] = [this.#job.incumbent_s, this.#job.value ?? null];
    let found = null;
    try {
      found = await read(`/v1/plans/${this.#id}/result`, this.#signal);
    } catch (error) {
      if (this.#signal.aborted || (error.status === 409 && !final)) return;
      this.#news.replaceChildren();
      const none = { title: "There is no plan", message: this.#job.detail ?? error.message };
      this.#result.replaceChildren(failure(error.status === 409 ? none : error),
        el("div", { class: "result" }, downloads(this.#id, this.#job.name)));
      return;
    }
    // An earlier plan that arrives late does not replace the last one.
    if (this.#shown.final) return;
    this.#shown = {
      incumbent: found.total_time_s ?? null, value: found.value ?? null, final, doubt: doubtOf(checkedPlan(found)),
      isFailed: found.verification?.passed === false, isFlown: Boolean(found.trajectory?.states?.length),
    };
    this.#news.replaceChildren();
    this.#drawing.abort();
    this.#drawing = new AbortController();
    const drawn = result(this.#job, found, this.#scenario, final ? this.#search : null, this.#drawing.signal);
    this.#result.replaceChildren(drawn);
    this.#renew();
  }

  async #ask(what) {
    try {
      await post(`/v1/plans/${this.#id}/${what}`, undefined, this.#signal);
    } catch (error) {
      if (!this.#signal.aborted) this.#news.replaceChildren(failure(error));
    }
  }

  async #remove() {
    const sure = el("dialog", { "aria-labelledby": "sure" }, el("form", { method: "dialog" },
      el("h2", { id: "sure" }, "Delete this plan?"),
      el("p", {}, "The job, its plan and its events are gone then."),
      el("div", { class: "actions" }, el("button", { value: "yes", class: "danger" }, "Delete"),
        el("button", { value: "" }, "Keep"))));
    document.body.append(sure);
    sure.addEventListener("close", async () => {
      sure.remove();
      if (sure.returnValue !== "yes") return;
      await remove(`/v1/plans/${this.#id}`).then(() => (location.hash = "#/"), (error) => this.fail(error));
    });
    sure.showModal();
  }
}
