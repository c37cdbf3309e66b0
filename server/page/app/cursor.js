// The moment that all plots show.

/** A moment that several plots show and set; `null` before anybody has set it. */
export class Cursor {
  #time = null;
  #listeners = [];

  get time() {
    return this.#time;
  }

  /** Sets the moment and tells everybody. */
  set(time) {
    if (time === this.#time) return;
    this.#time = time;
    for (const listener of this.#listeners) listener(time);
  }

  /** Calls back with every new moment, while the signal lasts. */
  listen(listener, signal) {
    this.#listeners.push(listener);
    signal?.addEventListener("abort", () => (this.#listeners = this.#listeners.filter((other) => other !== listener)));
  }
}
