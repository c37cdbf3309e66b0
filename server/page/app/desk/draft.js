// The scenario that is being written: a JSON text with its history. Table, forms, sky and field show it
// and change it; nothing else holds a part of it.

import { treeOf } from "./json-tree.js";

/** Letters of former texts that are kept. */
const MAX_LETTERS = 20_000_000;

export class Draft {
  #past = [];
  #future = [];
  #group = null;
  #listeners = new Set();
  #text = "";
  #tree = null;
  #document = {};

  get text() {
    return this.#text;
  }

  /** The values of the text with their places; null while it is no JSON. */
  get tree() {
    return this.#tree;
  }

  /** The last document that could be read. */
  get document() {
    return this.#document;
  }

  get isBlank() {
    return this.#text.trim() === "";
  }

  /** Whether parts of the text can be changed. */
  get isReadable() {
    return this.isBlank || this.#tree !== null;
  }

  /** What undoing would take back, and redoing would do again; null for nothing. */
  get undoable() {
    return this.#past.at(-1)?.what ?? null;
  }

  get redoable() {
    return this.#future.at(-1)?.what ?? null;
  }

  /** Another text, and what was done in a word. Changes of one group in a row are one step. */
  edit(text, what, group = null) {
    if (text === this.#text) return;
    if (group === null || group !== this.#group) this.#past.push({ text: this.#text, what });
    this.#group = group;
    this.#future = [];
    let letters = this.#past.reduce((sum, step) => sum + step.text.length, 0);
    while (letters > MAX_LETTERS && this.#past.length > 1) letters -= this.#past.shift().text.length;
    this.#set(text);
  }

  /** The next change is a step of its own. */
  settle() {
    this.#group = null;
  }

  undo() {
    this.#step(this.#past, this.#future);
  }

  redo() {
    this.#step(this.#future, this.#past);
  }

  /** Calls back after every change, while the signal lasts. */
  listen(listener, signal) {
    this.#listeners.add(listener);
    signal.addEventListener("abort", () => this.#listeners.delete(listener));
  }

  #step(from, to) {
    const step = from.pop();
    if (!step) return;
    to.push({ text: this.#text, what: step.what });
    this.#group = null;
    this.#set(step.text);
  }

  #set(text) {
    this.#text = text;
    this.#tree = treeOf(text);
    if (this.isBlank) this.#document = {};
    else if (this.#tree) this.#document = JSON.parse(text.replace(/^\ufeff/, "")) ?? {};
    for (const listener of [...this.#listeners]) listener();
  }
}
