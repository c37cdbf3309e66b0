// What the parts of a new plan share: the draft, what the service says about it, what is chosen.

import { read } from "../api.js";
import { Checking } from "./checking.js";
import { Draft } from "./draft.js";
import { Grid } from "./grid.js";
import { Selection } from "./selection.js";
import { sunOf } from "./sun.js";

const PAUSE_MS = 300;

/** The draft stays while the page is open, whatever else is looked at. */
const draft = new Draft();

export class Desk {
  draft = draft;
  targets = new Selection();
  #grids = [];
  #stored = { key: "", state: "none", spacecraft: null, version: null };
  #timer = 0;
  #listeners = [];
  #sun = { key: "", direction: null };

  constructor(signal) {
    this.signal = signal;
    this.checking = new Checking(draft, signal);
    draft.listen(() => this.#look(), signal);
    signal.addEventListener("abort", () => clearTimeout(this.#timer));
    this.#look();
  }

  get document() {
    return draft.document;
  }

  /** The spacecraft, also a stored one once it is known; undefined without any. */
  get spacecraft() {
    const { spacecraft } = this.document;
    return spacecraft?.ref === undefined ? spacecraft : this.#stored.spacecraft ?? undefined;
  }

  /** What is known of the stored spacecraft that is named: {state, version}. */
  get stored() {
    return this.#stored;
  }

  /** The direction of the Sun; null where it cannot be told. */
  get sun() {
    const { epoch, time_system: system, reference_frame: frame } = this.document;
    const key = [epoch, system, frame].join();
    if (key !== this.#sun.key) this.#sun = { key, direction: sunOf(this.document) };
    return this.#sun.direction;
  }

  /** A grid of a table, to whose cells the desk can lead. */
  grid(table, options) {
    const grid = new Grid(this, table, options);
    this.#grids.push(grid);
    return grid;
  }

  /** Whether a table has a cell that a pointer means. */
  has(pointer) {
    return this.#grids.some((grid) => grid.has(pointer));
  }

  /** Leads to the cell that a pointer means; false where no table has it. */
  lead(pointer) {
    return this.#grids.some((grid) => grid.lead(pointer));
  }

  /** Calls back when a stored spacecraft has come. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  #look() {
    const { ref, version } = this.document.spacecraft ?? {};
    const key = typeof ref === "string" && ref ? `${encodeURIComponent(ref)}${version ? `?version=${version}` : ""}` : "";
    if (key === this.#stored.key) return;
    this.#stored = { key, state: key ? "asked" : "none", spacecraft: null, version: null };
    clearTimeout(this.#timer);
    if (key) this.#timer = setTimeout(() => this.#fetch(key), PAUSE_MS);
  }

  async #fetch(key) {
    const found = await read(`/v1/spacecraft/${key}`, this.signal).catch(() => null);
    if (key !== this.#stored.key || this.signal.aborted) return;
    this.#stored = { key, state: found ? "known" : "missing", spacecraft: found?.spacecraft ?? null, version: found?.version ?? null };
    for (const listener of this.#listeners) listener();
  }
}
