// What the service says about the draft, asked again after every change.

import { postForText } from "../api.js";

/** After the last change, so that a word is not checked letter by letter. */
const PAUSE_MS = 350;

export class Checking {
  #draft;
  #listeners = [];
  #timer = 0;
  #asked = new AbortController();
  #signal;
  /** The answer to the newest text that was checked: {text, title, errors, warnings}; null without one. */
  answer = null;
  isPending = false;

  constructor(draft, signal) {
    this.#draft = draft;
    this.#signal = signal;
    draft.listen(() => this.#later(), signal);
    signal.addEventListener("abort", () => {
      clearTimeout(this.#timer);
      this.#asked.abort();
    });
    this.#later();
  }

  /** Calls back with every answer, and when one is waited for. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  get errors() {
    return this.answer?.error?.errors ?? [];
  }

  get warnings() {
    return this.answer?.warnings ?? this.answer?.error?.warnings ?? [];
  }

  /** Asks now; the answer is {warnings} or {error}. */
  async ask() {
    clearTimeout(this.#timer);
    this.#asked.abort();
    this.#asked = new AbortController();
    const { signal } = this.#asked;
    const { text } = this.#draft;
    this.#say(true);
    try {
      const { warnings } = JSON.parse(await postForText("/v1/plans?validate_only=true", text, signal));
      this.#take({ text, warnings: warnings ?? [] });
    } catch (error) {
      if (!signal.aborted && !this.#signal.aborted) this.#take({ text, error });
    }
  }

  #later() {
    clearTimeout(this.#timer);
    this.#asked.abort();
    if (this.#draft.isBlank) return this.#take(null);
    this.#say(true);
    this.#timer = setTimeout(() => this.ask(), PAUSE_MS);
    return undefined;
  }

  #take(answer) {
    this.answer = answer;
    this.#say(false);
  }

  #say(isPending) {
    this.isPending = isPending;
    for (const listener of this.#listeners) listener();
  }
}
