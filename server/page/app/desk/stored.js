// The spacecraft that are stored on the service, by their names.

import { read } from "../api.js";

const PAGE = 200;
/** More than these are not offered; their names can be written in the JSON. */
const MAX_OFFERED = 1000;

export class StoredSpacecraft {
  #signal;
  #listeners = [];
  #asked = null;
  /** {name, version} of each, in the order of their names; null until they are known. */
  list = null;

  constructor(signal) {
    this.#signal = signal;
  }

  /** Calls back when the list has come, or come again. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  /** Looks for them, once until `again`. */
  look() {
    this.#asked ??= this.#read();
  }

  again() {
    this.#asked = this.#read();
  }

  async #read() {
    const found = [];
    try {
      for (let cursor = null; found.length < MAX_OFFERED;) {
        const query = new URLSearchParams({ limit: PAGE, ...cursor && { cursor } });
        const page = await read(`/v1/spacecraft?${query}`, this.#signal);
        found.push(...page.spacecraft);
        cursor = page.next_cursor;
        if (!cursor) break;
      }
    } catch {
      // Without the list the one that is named can still be used.
    }
    if (this.#signal.aborted) return;
    this.list = found;
    for (const listener of this.#listeners) listener();
  }
}

/** What is offered of one in a list. */
export const offered = ({ name, version }) => `${name}, version ${version}`;
