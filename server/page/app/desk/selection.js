// Which rows of a table are chosen: one after another, from a first to a last one.

export class Selection {
  #listeners = new Set();
  first = null;
  last = null;

  get isEmpty() {
    return this.first === null;
  }

  /** Chooses rows; the first one is where it began. */
  set(first, last = first) {
    if (first === this.first && last === this.last) return;
    [this.first, this.last] = [first, last];
    for (const listener of this.#listeners) listener();
  }

  clear() {
    this.set(null);
  }

  has(index) {
    const [low, high] = this.range;
    return !this.isEmpty && index >= low && index <= high;
  }

  /** Least and greatest chosen index. */
  get range() {
    return [Math.min(this.first, this.last), Math.max(this.first, this.last)];
  }

  listen(listener, signal) {
    this.#listeners.add(listener);
    signal.addEventListener("abort", () => this.#listeners.delete(listener));
  }
}
